// edit/laws/removal.h - how much bone a turning burr takes per second, and what that does to the burr:
// the energy law.
//
//     MRR = min( eta mu_c F_n w r_eff,  P_max ) / u         [m^3/s]
//     F_t = P / (w r_eff)                                   [N]      torque = P / w
//
// Friction power at the contact, over the energy a volume of this tissue costs to cut (Agus et al.
// 2003; Preston; Archard; docs/cutting.md, "Energy law"). r_eff = r sin(theta), theta between the
// burr's axis and the contact normal: the pole of a burr cuts least. No push, no speed: no cut. The
// bone drags at the burr against the way its surface slides: F_t makes a burr walk, and walk the
// other way when it turns backwards. Level 2 is chips.h; the thesis' law is what they are measured
// against. Thread: servo. Units: SI. Frame: world.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "burr/math/sums.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::edit {

enum class RemovalLaw {
  energy,  // the above
  thesis,  // Eriksson 2006: whatever is in the mill loses density with time; no force, no ledger
  chips,   // chips.h; a diamond burr, which has no teeth, cuts by the energy law
};
inline constexpr int kLaws = 3;
inline constexpr std::array<std::string_view, kLaws> kLawNames = {"energy", "thesis", "chips"};

[[nodiscard]] constexpr std::optional<RemovalLaw> law_named(std::string_view name) {
  for (std::size_t n = 0; n < kLaws; ++n)
    if (kLawNames[n] == name) return static_cast<RemovalLaw>(n);
  return std::nullopt;
}

struct RemovalSettings {
  RemovalLaw law = RemovalLaw::energy;
  double max_power = 60;    // of the motor at the burr                                   [W]
  double pole = 0.15;       // least sin(theta)                                           [-]
  double thesis_rate = 10;  // of a voxel's density, 1 being solid; the thesis names none  [1/s]
  int thesis_frame = 1;     // every so many ticks, then for all of them; its own graphics loop: 33
};

// What a burr does to the bone in a tick, and the bone to it.
struct Cutting {
  double energy = 0;  // to be paid to the bone for what is taken, by its own price       [J]
  double power = 0;   // that the motor gives to the bone                                 [W]
  double torque = 0;  // of the bone on the burr, 0 or more                               [N m]
  double ripple = 0;  // how far the force along the surface swings as tooth follows tooth [N]
  math::Vec3 drag = math::Vec3::Zero();  // force of the bone on the burr, along the surface [N]
};

// How the burr turns: clockwise seen along the shaft from the hand when speed > 0 (tool/spindle.h).
struct Spin {
  math::Vec3 axis = math::Vec3::UnitZ();  // unit, from the head to the hand
  double speed = 0;                       // [rad/s]
};

// Against the way the burr's surface slides over the bone that lies along `normal` from it; shorter
// than 1 near the pole, where it hardly slides.
[[nodiscard]] inline math::Vec3 drag_way(const math::Vec3& normal, const Spin& spin,
                                         double pole) BURR_RT {
  const math::Vec3 across = normal.cross(spin.axis);
  return across * (std::copysign(1.0, spin.speed) / std::max(math::norm(across), pole));
}

// Power that goes into cutting [W].  normal: unit contact normal; axis: unit, of the burr; force_n
// [N]; speed [rad/s]; friction: mu_c of the tissue (volume::Tissue::cutting_friction) times the
// burr's share of it (tool::cutting_efficiency)
[[nodiscard]] inline double cutting_power(double force_n, double speed, double radius,
                                          double friction, const math::Vec3& normal,
                                          const math::Vec3& axis,
                                          const RemovalSettings& settings) BURR_RT {
  const double sine = std::max(math::norm(normal.cross(axis)), settings.pole);
  const double power = friction * force_n * std::abs(speed) * radius * sine;
  return std::clamp(power, 0.0, settings.max_power);
}

// A tick of it. push: normal force [N]
[[nodiscard]] inline Cutting energy_law(double push, const Spin& spin, double radius,
                                        double friction, const math::Vec3& normal, double dt,
                                        const RemovalSettings& settings) BURR_RT {
  Cutting cutting;
  cutting.power = cutting_power(push, spin.speed, radius, friction, normal, spin.axis, settings);
  if (cutting.power <= 0) return cutting;
  cutting.energy = cutting.power * dt;
  cutting.torque = cutting.power / std::abs(spin.speed);
  const double sine = std::max(math::norm(normal.cross(spin.axis)), settings.pole);
  cutting.drag = cutting.torque / (radius * sine) * drag_way(normal, spin, settings.pole);
  return cutting;
}

}  // namespace burr::edit
