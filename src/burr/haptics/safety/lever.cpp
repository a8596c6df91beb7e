#include "burr/haptics/safety/lever.h"

#include <algorithm>

#include "burr/math/sums.h"

namespace burr::haptics {
namespace {

constexpr double kTurnShare = 1.0 / 3;  // of what turning allows, left to k_r         [-]
constexpr double kMargin = 0.7;         // of the border that is used                  [-]

// The border of one axis of this damping.
double border_of(double damping, const Wrist& wrist) BURR_RT {
  return damping / (0.5 / wrist.rate_hz + wrist.delay);
}

}  // namespace

double stiffest_at_lever(const Wrist& wrist, double turn_stiffness, double lever) BURR_RT {
  const double moves = border_of(wrist.damping, wrist);
  if (wrist.turn_damping <= 0) return moves;
  const double left = border_of(wrist.turn_damping, wrist) - turn_stiffness;
  return left <= 0 ? 0 : moves * left / (left + moves * lever * lever);
}

LeverSprings springs_at_lever(const Wrist& wrist, double wanted_stiffness,
                              double wanted_turn_stiffness, double lever) {
  LeverSprings springs;
  springs.turn_stiffness =
      wrist.turn_damping <= 0
          ? wanted_turn_stiffness
          : std::min(wanted_turn_stiffness, kTurnShare * border_of(wrist.turn_damping, wrist));
  springs.border = stiffest_at_lever(wrist, springs.turn_stiffness, lever);
  springs.stiffness = std::min(wanted_stiffness, kMargin * springs.border);
  return springs;
}

Wrench moved(const Wrench& wrench, const math::Vec3& by) BURR_RT {
  return {wrench.force, wrench.torque - by.cross(wrench.force)};
}

Wrench limited(const Wrench& wrench, double most_force, double most_torque) BURR_RT {
  if (!wrench.force.allFinite() || !wrench.torque.allFinite()) return {};
  const double force = math::norm(wrench.force), torque = math::norm(wrench.torque);
  double share = 1;
  if (force > most_force) share = most_force / force;
  if (torque > most_torque) share = std::min(share, most_torque / torque);
  return {share * wrench.force, share * wrench.torque};
}

}  // namespace burr::haptics
