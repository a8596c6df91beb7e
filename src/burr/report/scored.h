// report/scored.h - a recording with its bone and its score: what `burr score`, `burr
// report` and `burr compare` begin with.
//
// Thread: any, one at a time for each recording. Cost: seconds. Errors: one sentence that names the file, the option or the field.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/record/player.h"
#include "burr/report/piece_words.h"
#include "burr/scenario/case.h"
#include "burr/scenario/lesson.h"
#include "burr/scenario/recipe.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/score.h"
#include "burr/volume/bone.h"

namespace burr::report {

// The lesson of a case with its landmarks placed; the rubric fits it.
[[nodiscard]] Result<scenario::CaseLesson> lesson_for(const scenario::Case& work,
                                                      const scoring::Rubric& rubric);

// A recording and what it is judged by.
struct Judged {
  std::unique_ptr<record::Player> player;
  scenario::Case work;
  scoring::Rubric rubric;
  scenario::CaseLesson lesson;
};
// Error: the rubric that the case names cannot be read, is for another case, or asks for what the case
// does not have. Fine without such a rubric.
[[nodiscard]] Status rubric_fits(const scenario::Case& work);

// rubric: a name or a file; empty: the built-in one of the recording's case.
[[nodiscard]] Result<Judged> judged_by(const std::string& recording, const std::string& rubric);

// Pieces that were moved (docs/use/pieces.md) are facts beside the items. The items look at the
// bone with these pieces put back where they came free: they judge the cut, not the move.
struct Scored {
  Judged judged;
  std::unique_ptr<volume::Bone> before, after;  // after: as it lies
  scoring::Score score;
  std::vector<MovedPiece> pieces = {};
};
// volume: where the bone is, if burr does not find it.
[[nodiscard]] Result<Scored> scored(Judged judged, const scenario::BoneRecipe& volume,
                                    Progress& progress);

}  // namespace burr::report
