// apps/burr/commands/study_standards.h - `burr study standard` and `standards`: where a centre may set its standard, by
// contrasting groups, Angoff or Hofstee; and those that it has set.
//
// Thread: main. Errors: one sentence.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "burr/base/result.h"
#include "burr/school/study/interval.h"
#include "school/study_source.h"

namespace burr::app {

// Of all parts of `burr study`.
struct StudyOptions {
  StudySource source;
  std::string method = "contrasting", marks, set_by, note;
  int occasions = 5;
  unsigned long seed = 1;
  bool bones = false, json = false;
};

// As [low, high].
[[nodiscard]] nlohmann::ordered_json interval(const school::study::Interval& of);

[[nodiscard]] Status propose_standard(const StudyOptions& options);
[[nodiscard]] Status list_standards(const StudyOptions& options);

}  // namespace burr::app
