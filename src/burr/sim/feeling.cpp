#include "burr/sim/feeling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace burr::sim {
namespace {

using math::Vec3;
using people::Stimulus;

constexpr double kAbove = 3e-3;   // height from which it comes [m]
constexpr double kDown = 0.4;     // time until it presses [s]
constexpr double kDeep = 2.5e-3;  // how far it aims below the wall; its arm gives way for most of
                                  // this
constexpr double kRound = 4e-3;   // radius of the circles it rubs [m]
constexpr double kEach = 2e-3;    // time between two points of the path [s]

}  // namespace

device::HandPath gesture_for(Stimulus stimulus, int gesture, const WallSettings& wall,
                             double seconds) {
  const double more = gesture / (kGestures - 1.0);  // 0 .. 1
  const double deep = kDeep * (0.8 + 0.4 * more), turns = 2 * std::numbers::pi * (0.8 + 0.5 * more);
  device::HandPath path;
  for (double t = 0; t <= seconds + kEach; t += kEach) {
    const double come = std::min(1.0, t / kDown), on = std::max(0.0, t - kDown);
    Vec3 at(0, 0, wall.burr_radius + kAbove - come * (kAbove + deep));
    if (stimulus == Stimulus::stiffness) at.z() += 0.5 * deep * std::sin(turns * on);
    if (stimulus == Stimulus::friction) {
      at.x() = kRound * (1 - std::cos(turns * on));
      at.y() = kRound * std::sin(turns * on);
    }
    device::PathPoint point;
    point.t = t;
    point.world_from_tool.p = at;
    path.points.push_back(point);
  }
  return path;
}

double sensed(Stimulus stimulus, const people::Felt& felt) {
  const Vec3 outward = Vec3::UnitZ();
  switch (stimulus) {
    case Stimulus::stiffness:
      return people::felt_stiffness(felt, outward);
    case Stimulus::friction:
      return people::felt_friction(felt, outward);
    case Stimulus::vibration:
      return people::felt_vibration(felt, outward);
  }
  return 0;
}

Result<double> feel(Wall& wall, Stimulus stimulus, double value, int gesture, double seconds) {
  device::SimulatedHand hand(gesture_for(stimulus, gesture, wall.settings(), seconds), {});
  if (Status opened = hand.open(); !opened) return opened.error();
  auto felt = wall.show(hand, wall.of(stimulus, value), seconds, {});
  if (!felt) return felt.error();
  return sensed(stimulus, *felt);
}

}  // namespace burr::sim
