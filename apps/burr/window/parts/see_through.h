// apps/burr/window/parts/see_through.h - the key that changes the transparency of the bone in steps.
// The same while milling and while a recording is played.
#pragma once

#include <string>

#include "burr/render/scene.h"

namespace burr::app {

// Takes the next step, or with `back` the previous one; returns a text about the new state.
[[nodiscard]] std::string step_see_through(render::Scene& scene, bool back);

}  // namespace burr::app
