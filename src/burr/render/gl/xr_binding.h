// render/gl/xr_binding.h - what OpenXR needs to know about the current OpenGL context: through GLX
// (X11) or EGL. In a file of its own, because X11's headers define names such as Status as macros.
// For use of this room only.
//
// Thread: main, with the context current.
#pragma once

#include <array>
#include <cstddef>

namespace burr::render::gl {

struct XrBinding {
  // the structure for XrSessionCreateInfo::next; nullptr: no context that OpenXR supports
  [[nodiscard]] const void* next() const { return there ? bytes.data() : nullptr; }
  const char* extension = nullptr;  // needed besides XR_KHR_opengl_enable; nullptr: none
  bool there = false;
  alignas(std::max_align_t) std::array<std::byte, 96> bytes{};
};

// Of the current context.
[[nodiscard]] XrBinding xr_binding();

}  // namespace burr::render::gl
