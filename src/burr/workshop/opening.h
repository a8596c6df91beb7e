// workshop/opening.h - how far an operation opens the soft tissue: as far as the steps of its case
// need bone.
//
// Thread: any. Frame: world. Units: m.
#pragma once

#include <optional>
#include <string>

#include "burr/render/drape.h"
#include "burr/scenario/case.h"
#include "burr/scenario/lesson.h"

namespace burr::workshop {

// Nothing: the case has no entry, or is work on a bare bone or tooth. lesson: with its landmarks
// placed; nullptr: the opening is 18 mm in radius. The circle holds the entry, and every ball, tube,
// box and point that a step names, with 2 mm to spare.
[[nodiscard]] std::optional<render::Opening> opening_of(const scenario::Case& work,
                                                        const scenario::CaseLesson* lesson);

// The same with the lesson of the case read here; nothing also where it cannot be read.
[[nodiscard]] std::optional<render::Opening> opening_of(const scenario::Case& work);
// Of the first built-in case with the phantom of this source ("phantom:temporal-bone"); nothing:
// there is none.
[[nodiscard]] std::optional<render::Opening> opening_of_phantom(const std::string& source);

}  // namespace burr::workshop
