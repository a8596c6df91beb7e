#include "burr/metrics/look_directions.h"

#include <array>
#include <cmath>

#include "burr/base/check.h"
#include "burr/math/sums.h"

namespace burr::metrics {
namespace {

using math::Vec3;

struct Ring {
  int count;
  double cosine, sine;            // of the angle to the axis: 50/3, 100/3, 50 degrees
  double step_cosine, step_sine;  // of the angle between neighbours: 60, 30, 20 degrees
};
constexpr std::array<Ring, 3> kRings = {{
    {6, 0.9579895123154889, 0.28680323271109026, 0.5, 0.8660254037844386},
    {12, 0.8354878114129364, 0.5495089780708061, 0.8660254037844386, 0.5},
    {18, 0.6427876096865394, 0.766044443118978, 0.9396926207859084, 0.3420201433256687},
}};

}  // namespace

std::vector<Vec3> cone_about(const Vec3& towards) {
  const Vec3 axis = math::normalized(towards);
  BURR_CHECK(math::squared_norm(axis) > 0.5);
  // two directions across, begun with the world axis that is farthest from this one
  int least = 0;
  for (int a = 1; a < 3; ++a)
    if (std::abs(axis[a]) < std::abs(axis[least])) least = a;
  const Vec3 across = math::normalized(axis.cross(Vec3::Unit(least)));
  const Vec3 aside = axis.cross(across);
  std::vector<Vec3> looks = {axis};
  for (const Ring& ring : kRings) {
    double c = 1, s = 0;
    for (int n = 0; n < ring.count; ++n) {
      looks.push_back(math::normalized(ring.cosine * axis + ring.sine * (c * across + s * aside)));
      const double next = c * ring.step_cosine - s * ring.step_sine;
      s = s * ring.step_cosine + c * ring.step_sine;
      c = next;
    }
  }
  return looks;
}

std::vector<Vec3> cones_about(std::span<const Vec3> towards) {
  std::vector<Vec3> looks;
  for (const Vec3& one : towards) {
    const std::vector<Vec3> cone = cone_about(one);
    looks.insert(looks.end(), cone.begin(), cone.end());
  }
  return looks;
}

}  // namespace burr::metrics
