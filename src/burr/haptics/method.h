// haptics/method.h - the methods of touch by their names (touch_method.h): burr's own, and those of the
// literature beside which it is measured.
//
// Thread: any. Memory: none.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace burr::haptics {

enum class Method {
  constraint,      // proxy.h
  thesis,          // Eriksson 2006: two steps along the iso-surface; the spring ends on it
  thesis_literal,  // the same, but the spring ends a radius above it, as in the text
  voxel_springs,   // a spring for every voxel of bone in the burr, no proxy
  samples,         // Vidholm & Agmund 2004: points on the burr in bone give the direction
  triangles,       // a god object on the triangles of the picture
  penalty,         // springs at points on the burr, in balance with the hand's spring
  shaft,           // six/shaft_touch.h: as constraint, and the shaft touches too
};
inline constexpr int kMethods = 8;

inline constexpr std::array<std::string_view, kMethods> kMethodNames = {
    "constraint", "thesis",    "thesis-literal", "voxel-springs",
    "samples",    "triangles", "penalty",        "shaft"};
[[nodiscard]] constexpr std::string_view name(Method method) {
  return kMethodNames[static_cast<std::size_t>(method)];
}
[[nodiscard]] std::optional<Method> method_named(std::string_view name);
// Methods whose burr is never in bone, so that they can begin only where it is free.
[[nodiscard]] constexpr bool begins_free(Method method) {
  return method == Method::constraint || method == Method::shaft;
}

}  // namespace burr::haptics
