// workshop/seen.h - what a picture shows, as a recording keeps it (record/view.h).
//
// Thread: any.
#pragma once

#include <cstdint>

#include "burr/record/view.h"
#include "burr/render/camera.h"

namespace burr::workshop {

// The view of one camera. see_through, colours, slices, panels and two_eyes are the caller's.
[[nodiscard]] record::View view_of(const render::Camera& camera, std::uint64_t tick);
// Of two eyes: from the middle between them.
[[nodiscard]] record::View view_of(const render::Camera& left, const render::Camera& right,
                                   std::uint64_t tick);

}  // namespace burr::workshop
