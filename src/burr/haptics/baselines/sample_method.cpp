#include "burr/haptics/baselines/sample_method.h"

#include <algorithm>
#include <cmath>

#include "burr/haptics/baselines/ball_points.h"
#include "burr/math/sums.h"
#include "burr/volume/sample.h"

namespace burr::haptics {
namespace {

using math::Vec3;

constexpr double kNoVote = 1e-6;  // a shorter sum of normals gives no direction

}  // namespace

SampleProxy::SampleProxy(const volume::Bone& bone, const ProxySettings& settings, const Vec3& hand)
    : bone_(bone), radius_(settings.radius), p_(bone.grid().grid_from_world(hand)), proxy_(hand) {
  spread_on_ball(points_);
}

void SampleProxy::place(const Vec3& p) BURR_RT {
  p_ = bone_.grid().grid_from_world(p);
  proxy_ = p;
  touching_ = false;
}

bool SampleProxy::set_radius(double radius) BURR_RT {
  radius_ = radius;
  return true;
}

int SampleProxy::in_bone(const Vec3& p_grid, Vec3& sum) const BURR_RT {
  const double r = radius_ / bone_.grid().voxel;
  int count = 0;
  sum = Vec3::Zero();
  for (const Vec3& point : points_) {
    const Vec3 at = p_grid + r * point;
    if (volume::sample(bone_, at) < volume::kIsoShare) continue;
    ++count;
    const Vec3 slope = volume::gradient(bone_, at);
    const double steep = math::norm(slope);
    if (steep > kNoVote) sum -= slope / steep;
  }
  return count;
}

Touch SampleProxy::step(const Vec3& hand) BURR_RT {
  const volume::Grid& grid = bone_.grid();
  const Vec3 x = grid.grid_from_world(hand);
  Touch touch;
  Vec3 votes;
  touch.candidates = kSamples;
  const int here = in_bone(p_, votes);
  Vec3 move = x - p_;
  if (here > 0) {
    touching_ = true;
    const double length = math::norm(votes);
    if (length > kNoVote) {
      const Vec3 e0 = votes / length;
      const double out = math::dot(move, e0);
      move += (std::max(out, 0.0) - out) * e0;
    } else {
      move = Vec3::Zero();
    }
  } else {
    // free: straight towards the hand, but no farther than where the first point meets bone
    Vec3 unused;
    double low = 0, high = 1;
    if (in_bone(x, unused) > 0) {
      for (int n = 0; n < 20; ++n) {
        const double middle = 0.5 * (low + high);
        (in_bone(p_ + middle * move, unused) > 0 ? high : low) = middle;
      }
      move *= high;
      touching_ = true;
    } else {
      touching_ = false;
    }
  }
  p_ += move;
  proxy_ = grid.world_from_grid(p_);
  touch.proxy = proxy_;
  const Vec3 stretch = p_ - x;
  const double depth = math::norm(stretch);
  touch.touching = touching_ && depth > 1e-9;
  if (!touch.touching) return touch;
  touch.normal = grid.frame.q * (stretch / depth);
  touch.depth = touch.pressing = depth * grid.voxel;
  touch.active = here;
  return touch;
}

}  // namespace burr::haptics
