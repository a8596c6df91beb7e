// apps/burr/school/learner_store.h - what the parts of `burr learner` share: the options, and the store as they open it.
//
// Thread: main. Errors: one sentence.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/scenario/recipe.h"
#include "burr/school/decisions.h"
#include "burr/school/pending.h"
#include "burr/school/store.h"

namespace burr::app {

struct LearnerOptions {
  std::string store;
  bool json = false;
  // add
  school::Learner learner;
  school::Person person;
  std::string retain_until;
  // others
  std::string id, recording, rubric, out, csv, title, language = "en";
  school::Decision decision;
  std::vector<std::string> ids;
  scenario::BoneRecipe volume;
  bool names = false, sessions = false, overdue = false, scrub = false, all = false,
       no_reports = false;
};

// The day here of a time in ms since 1970: "2027-12-31".
[[nodiscard]] std::string day_of(std::int64_t ms);

enum class MakeStore { no, yes };  // where there is none

// Opens the store, takes in the sessions that waited and are scored already, and says what it has to say.
[[nodiscard]] Result<std::unique_ptr<school::Store>> open_store(const LearnerOptions& options,
                                                                MakeStore make = MakeStore::no);
// Says on stderr how many sessions wait for other stores.
void say_others(const school::TakenIn& in);

}  // namespace burr::app
