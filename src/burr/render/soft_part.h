// render/soft_part.h - the mark that separates the two parts of a soft structure.
//
// A structure is in two parts, which meet edge on edge: what bone covers, or covered before it was
// cut, and the rest (of dura, the face towards the brain), which is drawn only where bone is
// transparent or cut open.
// Thread: any.
#pragma once

#include <cstdint>

namespace burr::render {

// In SkinVertex::under of every vertex of the part that bone does not cover.
inline constexpr std::uint32_t kOpen = 1U << 24;

}  // namespace burr::render
