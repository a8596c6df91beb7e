// scenes/wall.h - a wall to press, rub and hold a tool against: bone below z = 0.
#pragma once

#include <memory>

#include "burr/volume/bone.h"

namespace burr::scenes {

// 60 x 60 mm around the origin, 8 mm thick. Its one tissue has friction coefficient 1, so that a
// friction scale equals the coefficient.
[[nodiscard]] std::unique_ptr<volume::Bone> wall();

}  // namespace burr::scenes
