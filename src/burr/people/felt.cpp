#include "burr/people/felt.h"

#include <algorithm>
#include <cmath>

namespace burr::people {
namespace {

using math::Vec3;

constexpr double kSettled = 0.7;    // time left out at the start  [s]
constexpr double kPressing = 0.05;  // smallest force that counts as contact  [N]

std::size_t begin_of(const Felt& felt) {
  return static_cast<std::size_t>(std::ceil(kSettled / felt.dt));
}

}  // namespace

double felt_stiffness(const Felt& felt, const Vec3& outward) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = begin_of(felt); i < felt.at.size(); ++i) {
    const double push = felt.force[i].dot(outward), deep = -felt.at[i].dot(outward);
    if (push < kPressing) continue;
    n += 1;
    x += deep;
    y += push;
    xx += deep * deep;
    xy += deep * push;
  }
  const double spread = n * xx - x * x;
  return spread > 0 ? (n * xy - x * y) / spread : 0;
}

double felt_friction(const Felt& felt, const Vec3& outward) {
  double along = 0, out = 0;
  for (std::size_t i = begin_of(felt); i < felt.at.size(); ++i) {
    const double push = felt.force[i].dot(outward);
    if (push < kPressing) continue;
    along += (felt.force[i] - push * outward).norm();
    out += push;
  }
  return out > 0 ? along / out : 0;
}

double felt_vibration(const Felt& felt, const Vec3& outward) {
  double n = 0, squares = 0;
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = begin_of(felt); i < felt.at.size(); ++i) {
    const Vec3 along = felt.force[i] - felt.force[i].dot(outward) * outward;
    n += 1;
    sum += along;
    squares += along.squaredNorm();
  }
  return n > 0 ? std::sqrt(std::max(0.0, squares / n - (sum / n).squaredNorm())) : 0;
}

}  // namespace burr::people
