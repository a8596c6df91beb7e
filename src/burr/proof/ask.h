// proof/ask.h - asks the score of a known bone what the table knows.
//
//     auto answers = proof::ask(bone, line, progress);      // of one bone: made for this case, voxel size and number
//
// Thread: one for each bone. Errors: a line of the table that cannot be read, or whose item the rubric lacks; interrupted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/proof/known_bone.h"
#include "burr/proof/known_tables.h"

namespace burr::proof {

// One item of one known bone.
struct Answer {
  std::string item;
  // In the unit of Right; none: the verdict alone was asked. `is`: none where the outcome has no value.
  std::optional<double> right, is;
  double tolerance = 0;
  std::string unit;  // "mm", "deg", "mm2", "mm3", ""
  // None: the right value is too near to the threshold for a verdict.
  std::optional<scoring::Verdict> must;
  scoring::Verdict verdict = scoring::Verdict::not_assessable;
  std::string reason;  // the outcome's own, where it gave one

  [[nodiscard]] bool value_holds() const;
  [[nodiscard]] bool verdict_holds() const { return !must || *must == verdict; }
};

[[nodiscard]] Result<std::vector<Answer>> ask(KnownBone& bone, const KnownLine& line,
                                              Progress& progress);

// Items of the rubric that the answers do not show both met and unmet, and that the table does not leave out.
[[nodiscard]] std::vector<std::string> one_sided(const scoring::Rubric& rubric,
                                                 const KnownTable& table,
                                                 const std::vector<Answer>& answers);

}  // namespace burr::proof
