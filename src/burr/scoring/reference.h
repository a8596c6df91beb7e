// scoring/reference.h - the bone as the reference result of a case leaves it, made by formula.
//
//     after = before and not (the regions of `remove`, without what is nearer than `mm` to a structure of
//             `leave`), and the regions of `fill` besides
//
// It tests a rubric: work that follows the plan exactly must meet the rubric's product.
// Thread: one. Cost: a pass over all bricks.
#pragma once

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/bone.h"

namespace burr::scoring {

// bone: equal to `before`; becomes the result. lesson: with its landmarks placed and a reference.
// Errors: interrupted; Trouble::data if the bone has no room for what is added.
[[nodiscard]] Status cut_to_reference(volume::Bone& bone, const volume::Bone& before,
                                      const scenario::CaseLesson& lesson, Progress& progress);

}  // namespace burr::scoring
