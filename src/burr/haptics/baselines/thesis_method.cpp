#include "burr/haptics/baselines/thesis_method.h"

#include <algorithm>

#include "burr/math/elementary.h"
#include "burr/math/sums.h"
#include "burr/volume/sample.h"

namespace burr::haptics {
namespace {

using math::Vec3;

constexpr double kMarch = 0.2;        // a step of the march                     [voxel]
constexpr double kLeastSlope = 1e-3;  // below it the last normal is kept         [1/voxel]
constexpr int kHalvings = 30;

}  // namespace

ThesisProxy::ThesisProxy(const volume::Bone& bone, const ProxySettings& settings, const Vec3& hand,
                         bool literal)
    : bone_(bone),
      settings_(settings),
      literal_(literal),
      last_(bone.grid().grid_from_world(hand)),
      proxy_(hand) {}

void ThesisProxy::place(const Vec3& p) BURR_RT {
  last_ = bone_.grid().grid_from_world(p);
  proxy_ = p;
  touching_ = sliding_ = false;
}

void ThesisProxy::set_friction(double mu_static, double mu_kinetic) BURR_RT {
  settings_.friction_static = mu_static;
  settings_.friction_kinetic = mu_kinetic;
}

bool ThesisProxy::set_radius(double radius) BURR_RT {
  settings_.radius = radius;
  return true;
}

bool ThesisProxy::inside(const Vec3& p_grid) const BURR_RT {
  return volume::sample(bone_, p_grid) >= volume::kIsoShare;
}

// Steps 1, 3 and 6: minus the gradient; if it vanishes, the last normal.
Vec3 ThesisProxy::normal_at(const Vec3& p_grid) const BURR_RT {
  const Vec3 slope = volume::gradient(bone_, p_grid);
  const double steep = math::norm(slope);
  return steep > kLeastSlope ? Vec3(-slope / steep) : n_;
}

Vec3 ThesisProxy::crossing(Vec3 outside, Vec3 inside_at) const BURR_RT {
  for (int n = 0; n < kHalvings; ++n) {
    const Vec3 middle = 0.5 * (outside + inside_at);
    (inside(middle) ? inside_at : outside) = middle;
  }
  return inside_at;
}

// Steps 4 and 5: along the normal there until inside changes to outside or back, then bisection
// between the last two points. False: not found within two radii.
bool ThesisProxy::project(Vec3& p_grid) const BURR_RT {
  const Vec3 n = normal_at(p_grid);
  double value = volume::sample(bone_, p_grid);
  const bool in = value >= volume::kIsoShare;
  const double most = 2 * settings_.radius / bone_.grid().voxel;
  Vec3 at = p_grid;
  for (double gone = 0; gone < most; gone += kMarch) {
    const Vec3 next = at + (in ? kMarch : -kMarch) * n;
    const double there = volume::sample(bone_, next);
    if ((there >= volume::kIsoShare) != in) {
      p_grid = at + (volume::kIsoShare - value) / (there - value) * (next - at);
      return true;
    }
    at = next;
    value = there;
  }
  return false;
}

Touch ThesisProxy::step(const Vec3& hand) BURR_RT {
  const volume::Grid& grid = bone_.grid();
  const Vec3 x = grid.grid_from_world(hand), before = last_;
  last_ = x;
  Touch touch;
  if (!inside(x)) {
    touching_ = sliding_ = false;
    touch.proxy = proxy_ = hand;
    return touch;
  }
  if (!touching_) {
    s_ = inside(before) ? x : crossing(before, x);
    n_ = normal_at(s_);
    touching_ = true;
  }
  const Vec3 was = s_;
  n_ = normal_at(s_);
  Vec3 s = s_ + (x - s_) - math::dot(n_, x - s_) * n_;
  touch.lagging = !project(s);
  if (!touch.lagging) s_ = s;
  n_ = normal_at(s_);

  if (settings_.friction_static > 0) {
    const Vec3 behind = was - s_, trail = behind - math::dot(behind, n_) * n_;
    const double press = math::norm(s_ - x), reach = math::norm(trail);
    if (!sliding_ && reach > settings_.friction_static * press) sliding_ = true;
    if (sliding_ &&
        math::angle_of(reach, press) < 0.6 * math::arctangent(settings_.friction_kinetic))
      sliding_ = false;
    const double allowed = sliding_ ? std::min(reach, settings_.friction_kinetic * press) : reach;
    if (allowed > 1e-9) {
      Vec3 held = s_ + trail * (allowed / reach);
      if (project(held)) s_ = held;
      n_ = normal_at(s_);
    }
    touch.stuck = !sliding_;
  }

  const Vec3 c = s_ + settings_.radius / grid.voxel * n_;
  const Vec3 stretch = (literal_ ? c : s_) - x;
  const double depth = math::norm(stretch);
  proxy_ = grid.world_from_grid(c);
  touch.proxy = proxy_;
  touch.normal = grid.frame.q * (depth > 1e-12 ? Vec3(stretch / depth) : n_);
  touch.depth = touch.pressing = depth * grid.voxel;
  touch.active = 1;
  touch.touching = true;
  return touch;
}

}  // namespace burr::haptics
