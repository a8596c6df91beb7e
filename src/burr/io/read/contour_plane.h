// io/read/contour_plane.h - closed curves in a plane as pixels: what is inside by the even-odd rule, and how far each
// pixel is from the edge. Internal to io.
//
// Even-odd: a curve inside another one is a hole, one inside a hole is full again, and a keyhole (out and back along one
// line) encloses what it goes round. A pixel counts where its centre is inside; of two curves with a common edge, each
// pixel belongs to one alone.
// Thread: any; plain data. Memory: 5 bytes a pixel.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace burr::io {

using Curve = std::vector<std::array<double, 2>>;  // closed; u, v [mm]

struct PlaneGrid {
  double u0 = 0, v0 = 0, du = 1, dv = 1;  // centre of the first pixel, distance of the pixels [mm]
  int nu = 0, nv = 0;
};

class PlaneMask {
 public:
  PlaneMask(const PlaneGrid& grid, const std::vector<Curve>& curves);

  [[nodiscard]] bool inside(int u, int v) const {
    return inside_[static_cast<std::size_t>(v) * static_cast<std::size_t>(grid_.nu) +
                   static_cast<std::size_t>(u)] != 0;
  }
  // From the centre of a pixel to the edge, inside above 0; to half a pixel. [mm]
  [[nodiscard]] double depth(int u, int v) const {
    return static_cast<double>(
        depth_[static_cast<std::size_t>(v) * static_cast<std::size_t>(grid_.nu) +
               static_cast<std::size_t>(u)]);
  }
  // The same at any place, between the four pixels around it; beyond the grid it is below 0.
  [[nodiscard]] double depth_at(double u_mm, double v_mm) const;
  void measure_depth();
  [[nodiscard]] bool measured() const { return !depth_.empty(); }

 private:
  PlaneGrid grid_;
  std::vector<std::uint8_t> inside_;
  std::vector<float> depth_;
  std::vector<std::size_t> seeds_;  // the pixels in the middle of the curves
};

}  // namespace burr::io
