// guidance/suits.h - the tool that suits a step, in the user's language.
//
// Thread: main.
#pragma once

#include <string>

#include "burr/scenario/lesson.h"

namespace burr::guidance {

// "diamond burr, 2 to 4 mm"; "": the step names none.
[[nodiscard]] std::string suits(const scenario::Step& step);

}  // namespace burr::guidance
