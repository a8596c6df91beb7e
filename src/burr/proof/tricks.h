// proof/tricks.h - cheap ways to a mark: bones that are cut without doing the work of the case.
//
//     auto tried = proof::try_tricks(rubric, lesson, recipe, progress);
//     the best of them must stay below what careless, honest work earns (proof/cheap_marks.h)
//
// Each leaves a bone that no surgeon would call good work. They are made for any case with a reference:
// from its plan, its structures and the direction of its surgeon, so also for a rubric that a centre has
// written. What the bones do not decide counts as met here, as somebody would do it who knows the rubric:
// the marks are the most that the trick can earn. Only a soft structure that lies in what was cut away
// counts as entered.
//
// Thread: any. Errors: interrupted, or a bone that cannot be made; one sentence.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/metrics/region.h"
#include "burr/scenario/lesson.h"
#include "burr/scenario/recipe.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/score.h"
#include "burr/volume/bone.h"

namespace burr::proof {

struct Trick {
  std::string name, how;              // how: what is done, a sentence
  std::vector<metrics::Region> cut;   // one after the other; none: nothing is cut
  std::vector<metrics::Region> fill;  // afterwards
  bool leaves_parts = false;  // it is a trick only where another part of the plan stays undone
};

// burr: the diameter that the case gives [m]. seed: of the random strokes. Error: interrupted.
[[nodiscard]] Result<std::vector<Trick>> tricks_of(const volume::Bone& before,
                                                   const scenario::CaseLesson& lesson, double burr,
                                                   std::uint64_t seed, Progress& progress);

struct Tried {
  std::string name, how;
  std::vector<scoring::Outcome> outcomes;  // one for each item, in the order of the rubric
  scoring::Total product;
  scoring::NoMark no_mark;
};

// recipe: of the bone. lesson: placed; it has a reference with regions to remove.
[[nodiscard]] Result<std::vector<Tried>> try_tricks(const scoring::Rubric& rubric,
                                                    const scenario::CaseLesson& lesson,
                                                    const scenario::BoneRecipe& recipe, double burr,
                                                    std::uint64_t seed, Progress& progress);

}  // namespace burr::proof
