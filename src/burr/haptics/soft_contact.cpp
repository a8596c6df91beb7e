#include "burr/haptics/soft_contact.h"

#include <cmath>

#include "burr/math/sums.h"

namespace burr::haptics {
namespace {

using math::Vec3;

constexpr int kRounds = 16;
constexpr double kClose = 1e-4;  // a step shorter than this ends the search  [voxel]

SoftSums sums_at(const Candidates& candidates, const Vec3& q, double layer, SoftPush push) BURR_RT {
  const float p[3] = {static_cast<float>(q.x()), static_cast<float>(q.y()),
                      static_cast<float>(q.z())};
  SoftSums sums;
  push(candidates, p, static_cast<float>(layer), sums);
  return sums;
}

Vec3 push_of(const SoftSums& sums) BURR_RT { return {sums.push[0], sums.push[1], sums.push[2]}; }

}  // namespace

double soft_support(const Candidates& candidates, const math::Vec3& at, double layer,
                    SoftPush push) BURR_RT {
  return math::norm(push_of(sums_at(candidates, at, layer, push)));
}

SoftRest soft_rest(const Candidates& candidates, const Vec3& wanted, double layer, double support,
                   SoftPush push) BURR_RT {
  const double kappa = math::norm(wanted) / support;
  SoftRest rest;
  Vec3 q = Vec3::Zero(), step = Vec3::Zero();
  double energy = 0;
  for (int round = 0; round < kRounds; ++round) {
    const SoftSums sums = sums_at(candidates, q, layer, push);
    const double now = math::squared_norm(q - wanted) + kappa * sums.squares;
    if (round > 0 && now > energy) {  // too far: discs came in that were not pressed before
      step *= 0.5;
      q -= step;
      continue;
    }
    energy = now;
    rest.place = q;
    rest.pressing = kappa * sums.total;
    if (round > 0 && math::squared_norm(step) < kClose * kClose) break;
    math::Mat3 slope;
    slope << sums.stiff[0], sums.stiff[1], sums.stiff[2], sums.stiff[1], sums.stiff[3],
        sums.stiff[4], sums.stiff[2], sums.stiff[4], sums.stiff[5];
    slope = math::Mat3::Identity() + kappa * slope;
    step = slope.llt().solve(wanted - q + kappa * push_of(sums));
    q += step;
  }
  return rest;
}

}  // namespace burr::haptics
