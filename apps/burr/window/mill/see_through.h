// apps/burr/window/mill/see_through.h - the key that makes bone see-through, step by step; the same
// while milling and while watching.
#pragma once

#include <string>

#include "burr/render/scene.h"

namespace burr::app {

// The next step, or with `back` the one before; what it is now, in words.
[[nodiscard]] std::string step_see_through(render::Scene& scene, bool back);

}  // namespace burr::app
