#include "burr/tool/cutting_places.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "burr/math/sums.h"
#include "burr/tool/shape.h"

namespace burr::tool {
namespace {

using math::Vec3;

constexpr int kMost = 128, kAlong = 11;

// How many places along each side of a box, so that its surface has kMost at most.
std::array<int, 3> sides(const Vec3& extent) {
  std::array<int, 3> count;
  for (double step = extent.maxCoeff() / (kAlong - 1);; step *= 1.1) {
    int all = 1, inside = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      count[axis] =
          std::max(2, 1 + static_cast<int>(std::lround(extent[static_cast<int>(axis)] / step)));
      all *= count[axis];
      inside *= count[axis] - 2;
    }
    if (all - inside <= kMost) return count;
  }
}

}  // namespace

Places places_on_surface(const Tool& tool) {
  constexpr int kRounds = 8;
  Places places;
  double low = 0, high = 0;
  std::array<double, 2> least = {0, 0}, most = {0, 0};
  for (int n = 0; n < tool.count; ++n) {
    const Part& part = tool.parts[static_cast<std::size_t>(n)];
    if (part.role != Role::cuts) continue;
    const math::Aabb box = bounds(part.shape);
    const Vec3 extent = box.extent();
    const std::array<int, 3> count = sides(extent);
    for (int k = 0; k < count[2]; ++k)
      for (int j = 0; j < count[1]; ++j)
        for (int i = 0; i < count[0]; ++i) {
          const bool at_side = i == 0 || j == 0 || k == 0 || i == count[0] - 1 ||
                               j == count[1] - 1 || k == count[2] - 1;
          if (!at_side) continue;
          const Vec3 share(static_cast<double>(i) / (count[0] - 1),
                           static_cast<double>(j) / (count[1] - 1),
                           static_cast<double>(k) / (count[2] - 1));
          Vec3 p = box.lo + share.cwiseProduct(extent);
          for (int round = 0; round < kRounds; ++round) {  // once is enough where it is exact
            const Distance there = distance(part.shape, p);
            p -= there.phi * there.gradient;
          }
          const Vec3 at = part.tool_from_part * p;
          places.on.push_back(at);
          places.reach = std::max(places.reach, math::norm(at));
          for (std::size_t axis = 0; axis < 2; ++axis) {
            least[axis] = std::min(least[axis], at[static_cast<int>(axis)]);
            most[axis] = std::max(most[axis], at[static_cast<int>(axis)]);
          }
        }
  }
  low = std::min(most[0] - least[0], most[1] - least[1]);
  high = std::max(most[0] - least[0], most[1] - least[1]);
  // a round tool is as wide as it is; a blade cuts as wide as it is thick
  places.half_width = 0.5 * (low < 0.5 * high ? low : high);
  return places;
}

}  // namespace burr::tool
