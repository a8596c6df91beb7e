#include "burr/haptics/baselines/penalty.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "burr/haptics/baselines/ball_points.h"
#include "burr/math/sums.h"
#include "burr/volume/sample.h"

namespace burr::haptics {
namespace {

using math::Mat3;
using math::Vec3;

constexpr int kRounds = 8;
constexpr double kBalanced = 1e-3;  // a smaller correction ends the rounds      [voxel]
constexpr double kFarthest = 1;     // largest correction in a round             [voxel]
// A cap of depth d on a ball of radius r pushes by q pi r d^2. q is such that the ball sinks in by
// kSinks when the hand pulls by one voxel.
constexpr double kSinks = 0.05;  // [voxel]

}  // namespace

PenaltyProxy::PenaltyProxy(const volume::Bone& bone, const ProxySettings& settings,
                           const Vec3& hand)
    : bone_(bone),
      radius_(settings.radius),
      points_(std::make_unique<std::array<Vec3, kPoints>>()),
      c_(bone.grid().grid_from_world(hand)),
      proxy_(hand) {
  spread_on_ball(*points_);
}

void PenaltyProxy::place(const Vec3& p) BURR_RT {
  c_ = bone_.grid().grid_from_world(p);
  proxy_ = p;
}

bool PenaltyProxy::set_radius(double radius) BURR_RT {
  radius_ = radius;
  return true;
}

// Gauss-Newton, starting where the burr was; the slopes of the depths are those of the field.
Touch PenaltyProxy::step(const Vec3& hand) BURR_RT {
  const volume::Grid& grid = bone_.grid();
  const Vec3 x = grid.grid_from_world(hand);
  const double r = radius_ / grid.voxel;
  const double each = 4 * std::numbers::pi * r * r / kPoints,
               q = each / (std::numbers::pi * r * kSinks * kSinks);
  Touch touch;
  touch.candidates = kPoints;
  int pressed = 0;
  for (int round = 0; round < kRounds; ++round) {
    Mat3 stiff = Mat3::Identity();
    Vec3 pull = x - c_;
    pressed = 0;
    for (const Vec3& point : *points_) {
      const Vec3 at = c_ + r * point;
      if (volume::sample(bone_, at) <= volume::kIsoShare) continue;
      const volume::Sample there = volume::sample_with_slope(bone_, at);
      const double depth = 2 * volume::kRamp * (there.value - volume::kIsoShare);
      const Vec3 slope = 2 * volume::kRamp * there.slope;  // into the bone, 1 on a clean ramp
      pull -= q * depth * slope;
      stiff += q * slope * slope.transpose();
      ++pressed;
    }
    Vec3 move = stiff.inverse() * pull;
    const double length = math::norm(move);
    if (length > kFarthest) move *= kFarthest / length;
    c_ += move;
    if (length < kBalanced) break;
  }
  proxy_ = grid.world_from_grid(c_);
  touch.proxy = proxy_;
  const Vec3 stretch = c_ - x;
  const double depth = math::norm(stretch);
  touch.active = pressed;
  touch.touching = pressed > 0 && depth > 1e-9;
  if (!touch.touching) return touch;
  touch.normal = grid.frame.q * (stretch / depth);
  touch.depth = touch.pressing = depth * grid.voxel;
  return touch;
}

}  // namespace burr::haptics
