#include "burr/render/depth_tiles.h"

#include <algorithm>
#include <cmath>

namespace burr::render {

namespace {

constexpr int kTile = 8;             // samples along a side
constexpr double kRounding = 2e-7;   // of a depth stored in 24 bit, and of our own arithmetic
constexpr double kBeforeEye = 1e-9;  // smallest w that can be divided by

}  // namespace

void DepthTiles::look(const float* depth, const Part& part) {
  part_ = part;
  across_ = (part.width + kTile - 1) / kTile;
  up_ = (part.height + kTile - 1) / kTile;
  farthest_.assign(static_cast<std::size_t>(across_) * static_cast<std::size_t>(up_), 0.0F);
  std::vector<float> row(static_cast<std::size_t>(across_) * kTile);
  for (int v = 0; v < up_; ++v) {
    // first the rows of a tile against each other, which a compiler vectorizes
    std::fill(row.begin(), row.end(), 0.0F);
    const int last = std::min(part.height, (v + 1) * kTile);
    for (int y = v * kTile; y < last; ++y) {
      const float* from = depth + static_cast<std::ptrdiff_t>(y) * part.width;
      for (int x = 0; x < part.width; ++x) {
        float& most = row[static_cast<std::size_t>(x)];
        most = most < from[x] ? from[x] : most;
      }
    }
    float* tile = farthest_.data() + static_cast<std::ptrdiff_t>(v) * across_;
    for (int u = 0; u < across_; ++u)
      tile[u] = *std::max_element(row.begin() + u * kTile, row.begin() + (u + 1) * kTile);
  }
}

bool DepthTiles::hide(const math::Aabb& box, const Eigen::Matrix4d& clip_from_world,
                      int window_width, int window_height) const {
  if (box.empty()) return true;
  double nearest = 1e30;
  Eigen::Vector2d lo(1e30, 1e30), hi(-1e30, -1e30);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector4d c = clip_from_world * box.corner(corner).homogeneous();
    // beside or behind the eye, or cut by the near plane: not known
    if (!(c.w() > kBeforeEye) || c.z() < -c.w()) return false;
    nearest = std::min(nearest, c.z() / c.w());
    lo = lo.cwiseMin(c.head<2>() / c.w());
    hi = hi.cwiseMax(c.head<2>() / c.w());
  }
  const double depth = 0.5 * nearest + 0.5 - kRounding;
  // tiles that it may touch, with a margin of one sample on each side
  const auto tile = [](double clip, int size, int from, double more) {
    const double sample = (0.5 * clip + 0.5) * size - from + more;
    return static_cast<int>(std::floor(std::clamp(sample, -1e6, 1e6) / kTile));
  };
  const int u0 = std::max(0, tile(lo.x(), window_width, part_.x0, -1)),
            u1 = std::min(across_ - 1, tile(hi.x(), window_width, part_.x0, 1)),
            v0 = std::max(0, tile(lo.y(), window_height, part_.y0, -1)),
            v1 = std::min(up_ - 1, tile(hi.y(), window_height, part_.y0, 1));
  for (int v = v0; v <= v1; ++v) {
    const float* row = farthest_.data() + static_cast<std::ptrdiff_t>(v) * across_;
    for (int u = u0; u <= u1; ++u)
      if (depth <= static_cast<double>(row[u])) return false;
  }
  return true;
}

}  // namespace burr::render
