// render/unseen.h - the colour of soft tissue that is not to be seen through bone.
//
//     scene.tissue_colours[nerve] = kUnseen;
//
// Neither does it shine through thin bone then, nor is it drawn behind see-through bone: what lies
// behind it is. For tissues that are soft; solid ones are always drawn. Thread: any.
#pragma once

#include "burr/render/look.h"

namespace burr::render {

inline constexpr Colour kUnseen = {-1, -1, -1};
[[nodiscard]] inline bool is_unseen(const Colour& colour) { return colour[0] < 0; }

}  // namespace burr::render
