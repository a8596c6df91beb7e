// proof/cheap_marks.h - what cheap ways to a mark earn by a rubric, beside careless, honest work.
//
//     auto marks = proof::cheap_marks(rubric, work, recipe, {}, progress);
//     for (const CheapMark& one : marks->tricks) if (one.beats) ...      // the rubric can be beaten
//
// The tricks are those of proof/tricks.h, and sessions that end before the work does. A trick beats the
// rubric if the product that it leaves has as many points, or as large a share of the items met, as the
// mean of the careless surgeons; of a session with a recording also the process. What has no mark at all
// (scoring/whole_work.h) beats nothing. Points and items are counted here all the same, also those of careless
// surgeons who get no mark.
// Thread: any; minutes. Errors: one sentence; interrupted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/case.h"
#include "burr/scenario/recipe.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/score.h"

namespace burr::proof {

struct PartMark {
  double met = 0, items = 0;     // met of the assessable; of several sessions the mean
  std::optional<double> points;  // none: too little is assessable
  [[nodiscard]] double share() const { return items > 0 ? met / items : 0; }
};

struct CheapMark {
  std::string name, how;
  PartMark product;
  std::optional<PartMark> process;  // none: without a recording
  std::string no_mark;              // why there is no mark at all; empty: there is one
  std::vector<std::string> earned;  // ids of the items that are met
  bool beats = false;
};

struct CheapMarks {
  std::vector<CheapMark> tricks;      // the dearest mark first: that which earns most
  std::optional<CheapMark> careless;  // the mean; none: no scripted surgeon can do the case
  std::string why_none;               // then
  int sessions = 0;                   // careless ones
};

struct CheapSettings {
  int careless = 3;        // sessions, of the seeds from `seed` on
  std::uint64_t seed = 1;  // 1 to 99: to try out
};

// rubric_place: as for scoring::read_rubric(); the sessions are scored by it. lesson: report::lesson_for().
[[nodiscard]] Result<CheapMarks> cheap_marks(const std::string& rubric_place,
                                             const scenario::Case& work,
                                             const scenario::BoneRecipe& recipe,
                                             const CheapSettings& settings, Progress& progress);

}  // namespace burr::proof
