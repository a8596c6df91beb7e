// io/read/polygon.h - cuts a face with many corners into triangles. For use of this room only.
//
// By cutting off ears (Meisters, Amer. Math. Monthly 82, 1975), seen along the face's own normal; so
// faces that are not convex keep their outline. A face that crosses itself becomes triangles with the
// same edge around. Thread: any.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace burr::io {

// Numbers of corners, in the direction of the face: n - 2 triangles. n >= 3.
[[nodiscard]] std::vector<std::array<std::size_t, 3>> triangles_of(
    std::span<const std::array<float, 3>> corners);

}  // namespace burr::io
