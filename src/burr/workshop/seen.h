// workshop/seen.h - what a picture shows, as a recording keeps it (record/view.h).
//
// Thread: any.
#pragma once

#include <cstdint>
#include <span>

#include "burr/record/view.h"
#include "burr/render/camera.h"

namespace burr::workshop {

// The view of one camera. see_through, colours, slices, panels and two_eyes are the caller's.
[[nodiscard]] record::View view_of(const render::Camera& camera, std::uint64_t tick);
// Of two eyes: from the middle between them.
[[nodiscard]] record::View view_of(const render::Camera& left, const render::Camera& right,
                                   std::uint64_t tick);

// The camera of a view. Of a head that was tilted, as in a headset: with the horizon level.
[[nodiscard]] render::Camera camera_of(const record::View& view);
// The view that holds at a tick: of those in order of time the last one before it, or the first.
// nullptr: there is none.
[[nodiscard]] const record::View* view_at(std::span<const record::View> views, std::uint64_t tick);

}  // namespace burr::workshop
