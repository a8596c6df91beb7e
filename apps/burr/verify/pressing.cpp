#include "pressing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/base/progress.h"
#include "burr/sim/session.h"
#include "burr/tick/servo.h"

namespace burr::app {

Lasting last(const Pressing& one, double seconds) {
  using math::Vec3;
  constexpr double kMm = 1e-3;
  device::HandPath path;
  for (const auto& [t, z] : {std::pair{0.0, 2 * kMm}, std::pair{0.7, 2 * kMm},
                             std::pair{1.2, -3 * kMm}, std::pair{seconds, -3 * kMm}}) {
    device::PathPoint point;
    point.t = t;
    point.world_from_tool.q = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY());
    point.world_from_tool.p = {0, 0, 1.5 * one.radius + z};
    path.points.push_back(point);
  }
  sim::SessionSettings settings;
  settings.servo.burr.radius = one.radius;
  settings.servo.mode = one.mode;
  settings.servo.force.stiffness = one.stiffness;
  settings.servo.guarded = one.guarded;
  settings.servo.drag_gain = one.drag;
  settings.law = one.law;
  device::DeviceSpec strong;
  strong.max_stiffness = 1e5;
  NoProgress quiet;
  auto made = sim::Session::make(
      phantom::bone_from_distance(
          phantom::box_grid(Vec3::Constant(-9 * kMm), Vec3::Constant(9 * kMm), 0.25 * kMm), {},
          one.bone, 4096),
      std::make_unique<device::SimulatedHand>(path, one.arm, strong), settings, quiet);
  Lasting out;
  if (!made) return out;
  const int ticks = static_cast<int>(1000 * (seconds - 0.1));
  Vec3 held = Vec3::Zero(), at = Vec3::Zero();
  double sum = 0, squares = 0;
  for (int n = 0; n < ticks; ++n) {
    const tick::TickRow& row = (*made)->servo().tick(false);
    (*made)->servo().publish();
    const Vec3 now = row.hand.world_from_tool.p;
    if (n > 0) out.energy -= held.dot(now - at);
    out.least = std::min(out.least, out.energy);
    at = now;
    held = row.contact.force;
    out.law_off = out.law_off || row.law.state == tick::LawRow::kOff;
    if (n < ticks - 1000) continue;
    const double force = held.norm();
    sum += force;
    squares += force * force;
  }
  out.force = sum / 1000;
  out.ripple =
      std::sqrt(std::max(0.0, squares / 1000 - out.force * out.force)) / std::max(out.force, 1e-9);
  out.ok = true;
  return out;
}

}  // namespace burr::app
