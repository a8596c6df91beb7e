// render/gl/xr_binding.h - what OpenXR must know of the OpenGL context that is current: through GLX
// (X11) or EGL. Apart from all else, because X11's headers take words such as Status for
// themselves. A header of this room only.
#pragma once

#include <array>
#include <cstddef>

namespace burr::render::gl {

struct XrBinding {
  // the structure for XrSessionCreateInfo::next; nullptr: no context that OpenXR knows
  [[nodiscard]] const void* next() const { return there ? bytes.data() : nullptr; }
  const char* extension = nullptr;  // asked for besides XR_KHR_opengl_enable; nullptr: none
  bool there = false;
  alignas(std::max_align_t) std::array<std::byte, 96> bytes{};
};

// Of the current context.
[[nodiscard]] XrBinding xr_binding();

}  // namespace burr::render::gl
