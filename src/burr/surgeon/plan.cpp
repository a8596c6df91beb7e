#include "burr/surgeon/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "burr/math/sums.h"

namespace burr::surgeon {
namespace {

using math::Ijk;
using math::Vec3;

constexpr double kCoarsest = 0.5e-3;  // between two nodes [m]
// the way in gets wider by this much per length, per side, outside the region [-]
constexpr double kOpening = 0.1;
constexpr float kNowhere = -1;  // [m]

std::size_t index_of(const Ijk& size, const Ijk& at) {
  return static_cast<std::size_t>(at.x()) +
         static_cast<std::size_t>(size.x()) *
             (static_cast<std::size_t>(at.y()) +
              static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(at.z()));
}

// Visits the planes of a grid one after the other in the direction `to` (grid axes, unit); at each
// node, put(index of the node, its value, value one plane back along `to`, distance between the two).
template <class Put>
void sweep(FieldGrid& field, const Vec3& to, const Put& put) {
  const Ijk& size = field.size();
  int main = 0;
  to.cwiseAbs().maxCoeff(&main);
  const int a = (main + 1) % 3, b = (main + 2) % 3;
  const double steep = std::abs(to[main]);
  const double back_a = -to[a] / steep, back_b = -to[b] / steep;
  const double step = field.spacing() / steep;
  const bool up = to[main] > 0;
  Ijk at, from;
  for (int plane = 1; plane < size[main]; ++plane) {
    at[main] = up ? plane : size[main] - 1 - plane;
    from[main] = up ? at[main] - 1 : at[main] + 1;
    for (at[b] = 0; at[b] < size[b]; ++at[b])
      for (at[a] = 0; at[a] < size[a]; ++at[a]) {
        const double u = std::clamp(at[a] + back_a, 0.0, size[a] - 1.0);
        const double v = std::clamp(at[b] + back_b, 0.0, size[b] - 1.0);
        const int iu = std::min(static_cast<int>(u), size[a] - 2);
        const int iv = std::min(static_cast<int>(v), size[b] - 2);
        const double du = u - iu, dv = v - iv;
        const auto value = [&](int one, int two) {
          from[a] = iu + one;
          from[b] = iv + two;
          return static_cast<double>(field.value[index_of(size, from)]);
        };
        const double back = (1 - dv) * ((1 - du) * value(0, 0) + du * value(1, 0)) +
                            dv * ((1 - du) * value(0, 1) + du * value(1, 1));
        const std::size_t n = index_of(size, at);
        float& here = field.value[n];
        here = static_cast<float>(put(n, static_cast<double>(here), back, step));
      }
  }
}

}  // namespace

FieldGrid::FieldGrid(const volume::Grid& bone) : frame_(bone.frame) {
  spacing_ = std::min(2 * bone.voxel, std::max(kCoarsest, bone.voxel));
  for (int axis = 0; axis < 3; ++axis)
    size_[axis] =
        2 + static_cast<int>(std::ceil((bone.size[axis] - 1) * bone.voxel / spacing_ - 1e-9));
  value.assign(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                   static_cast<std::size_t>(size_.z()),
               kNowhere);
}

double FieldGrid::at(const Vec3& p) const BURR_RT {
  const Vec3 last = (size_ - Ijk::Ones()).cast<double>();
  const Vec3 inside =
      ((frame_.q.conjugate() * (p - frame_.p)) / spacing_).cwiseMax(0).cwiseMin(last);
  const Ijk low = inside.cast<int>().cwiseMin(size_ - 2 * Ijk::Ones()).cwiseMax(0);
  const Vec3 part = inside - low.cast<double>();
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Ijk bit(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
    const double weight = (bit.x() != 0 ? part.x() : 1 - part.x()) *
                          (bit.y() != 0 ? part.y() : 1 - part.y()) *
                          (bit.z() != 0 ? part.z() : 1 - part.z());
    sum += weight * static_cast<double>(value[index_of(size_, low + bit)]);
  }
  return sum;
}

Vec3 FieldGrid::slope(const Vec3& p) const BURR_RT {
  const double e = 0.5 * spacing_;
  return Vec3(at(p + e * Vec3::UnitX()) - at(p - e * Vec3::UnitX()),
              at(p + e * Vec3::UnitY()) - at(p - e * Vec3::UnitY()),
              at(p + e * Vec3::UnitZ()) - at(p - e * Vec3::UnitZ())) /
         (2 * e);
}

Vec3 FieldGrid::node(std::size_t n) const {
  const auto x = static_cast<std::size_t>(size_.x()), y = static_cast<std::size_t>(size_.y());
  const std::size_t i = n % x, j = n / x % y, k = n / (x * y);
  const Vec3 ijk(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
  return frame_ * (spacing_ * ijk);
}

FieldGrid behind(const FieldGrid& field, const Vec3& out) {
  FieldGrid result = field;
  sweep(result, -(field.axes().conjugate() * out),
        [](std::size_t, double here, double back, double) { return std::max(here, back); });
  return result;
}

std::vector<Vec3> approach_of(const scenario::CaseLesson& lesson) {
  return lesson.approach.empty() ? std::vector<Vec3>{Vec3::UnitZ()} : lesson.approach;
}

Spare spare_of(const volume::Grid& bone, const scenario::CaseLesson& lesson,
               const Believed& believed, double margin_less) {
  Spare out{FieldGrid(bone), FieldGrid(bone), FieldGrid(bone)};
  constexpr float kFar = 1;  // [m]
  for (FieldGrid* one : {&out.free, &out.outside, &out.near})
    std::fill(one->value.begin(), one->value.end(), kFar);
  for (const scenario::Structure* one : spared_of(lesson)) {
    if (!believed.known(one->name)) continue;
    double margin = kUsualMargin;
    if (lesson.reference)
      for (const auto& [name, thickness] : lesson.reference->leave)
        if (name == one->name) margin = thickness;
    margin -= margin_less;
    const bool critical =
        std::any_of(lesson.steps.begin(), lesson.steps.end(), [one](const scenario::Step& step) {
          return std::find(step.spare.begin(), step.spare.end(), one->name) != step.spare.end();
        });
    for (std::size_t n = 0; n < out.free.nodes(); ++n) {
      const double distance = std::min(1.0, believed.distance(one->name, out.free.node(n)));
      out.outside.value[n] = std::min(out.outside.value[n], static_cast<float>(distance));
      if (critical) out.near.value[n] = std::min(out.near.value[n], static_cast<float>(distance));
      out.free.value[n] = std::min(out.free.value[n], static_cast<float>(distance - margin));
    }
  }
  return out;
}

std::vector<Vec3> approach_of(const scenario::CaseLesson& lesson, const scenario::Step& step) {
  return step.approach.empty() ? approach_of(lesson) : step.approach;
}

FieldGrid goal_of(const scenario::CaseRegion& region, const std::vector<Vec3>& approach,
                  const Believed& believed, const Spare& spare) {
  FieldGrid start = spare.free;
  const Believed::Depth depth = believed.region(region);
  for (std::size_t n = 0; n < start.nodes(); ++n)
    start.value[n] = static_cast<float>(std::max(-1.0, depth(start.node(n))));
  FieldGrid goal = start;
  std::fill(goal.value.begin(), goal.value.end(), kNowhere);
  for (const Vec3& towards : approach) {
    const Vec3 to = start.axes().conjugate() * towards;
    FieldGrid one = start;
    // All that lies between the region and the surgeon. Above the region's top it may be a little
    // wider; a corridor that reaches the surface has straight walls.
    double top = -std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < start.nodes(); ++n)
      if (start.value[n] > 0) top = std::max(top, start.node(n).dot(towards));
    sweep(one, to, [&](std::size_t n, double here, double back, double step) {
      return std::max(here, back + (start.node(n).dot(towards) > top ? kOpening * step : 0));
    });
    for (std::size_t n = 0; n < one.nodes(); ++n)
      one.value[n] = std::min(one.value[n], spare.free.value[n]);
    // and what is reached straight from outside
    sweep(one, -to,
          [](std::size_t, double here, double back, double) { return std::min(here, back); });
    for (std::size_t n = 0; n < one.nodes(); ++n)
      goal.value[n] = std::max(goal.value[n], one.value[n]);
  }
  return goal;
}

}  // namespace burr::surgeon
