// edit/laws/removal.h - how much bone a turning burr removes per second, and how that acts back on
// the burr: the energy law.
//
//     MRR = min( eta mu_c F_n w r_eff,  P_max ) / u         [m^3/s]
//     F_t = P / (w r_eff)                                   [N]      torque = P / w
//
// The friction power at the contact, divided by the energy that cutting a volume of this tissue
// takes (Agus et al. 2003; Preston; Archard; docs/understand/cutting.md, "Energy law"). r_eff = r
// sin(theta), theta: angle between the burr's axis and the contact normal; the pole of a burr cuts
// least. Without push or speed nothing is cut. The bone drags the burr against the direction in
// which its surface slides: F_t makes a burr walk sideways, and the other way when it turns
// backwards. The law of level 2 is chip_law.h; the law of the thesis is the baseline for both. Thread:
// servo. Units: SI. Frame: world.
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
  energy,  // the law described above
  thesis,  // Eriksson 2006: all bone in the burr loses density with time; no force, no ledger
  chips,   // chip_law.h; a diamond burr, which has no teeth, uses the energy law
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
  double max_power = 60;       // of the motor at the burr                                   [W]
  double pole = 0.15;          // smallest sin(theta)                                        [-]
  double thesis_rate = 10;     // loss of density, solid = 1; not given in the thesis         [1/s]
  int thesis_frame_ticks = 1;  // cuts every so many ticks, for all of them; in the thesis: 33
};

// What the burr does to the bone in one tick, and the bone to the burr.
struct Cutting {
  double energy = 0;  // to spend on removal, at the tissue's own energy per volume       [J]
  double power = 0;   // from the motor into the bone                                     [W]
  double torque = 0;  // of the bone on the burr, >= 0                                    [N m]
  double ripple = 0;  // amplitude of the force along the surface at the tooth frequency [N]
  math::Vec3 drag = math::Vec3::Zero();  // force of the bone on the burr, along the surface [N]
};

// Rotation of the burr: clockwise seen along the shaft from the hand when speed > 0
// (tool/spindle.h).
struct Spin {
  math::Vec3 axis = math::Vec3::UnitZ();  // unit, from the head to the hand
  double speed = 0;                       // [rad/s]
};

// Direction against which the burr's surface slides on bone that lies along `normal`. Shorter than
// 1 near the pole, where the surface hardly slides.
[[nodiscard]] inline math::Vec3 drag_direction(const math::Vec3& normal, const Spin& spin,
                                               double pole) BURR_RT {
  const math::Vec3 across = normal.cross(spin.axis);
  return across * (std::copysign(1.0, spin.speed) / std::max(math::norm(across), pole));
}

// Power that goes into cutting [W]. normal: unit contact normal; axis: unit, of the burr; force_n
// [N]; speed [rad/s]; radius [m]; friction: mu_c of the tissue (volume::Tissue::cutting_friction)
// times the burr's share (tool::cutting_efficiency)
[[nodiscard]] inline double cutting_power(double force_n, double speed, double radius,
                                          double friction, const math::Vec3& normal,
                                          const math::Vec3& axis,
                                          const RemovalSettings& settings) BURR_RT {
  const double sine = std::max(math::norm(normal.cross(axis)), settings.pole);
  const double power = friction * force_n * std::abs(speed) * radius * sine;
  return std::clamp(power, 0.0, settings.max_power);
}

// The energy law for one tick. push: normal force [N]
[[nodiscard]] inline Cutting energy_law(double push, const Spin& spin, double radius,
                                        double friction, const math::Vec3& normal, double dt,
                                        const RemovalSettings& settings) BURR_RT {
  Cutting cutting;
  cutting.power = cutting_power(push, spin.speed, radius, friction, normal, spin.axis, settings);
  if (cutting.power <= 0) return cutting;
  cutting.energy = cutting.power * dt;
  cutting.torque = cutting.power / std::abs(spin.speed);
  const double sine = std::max(math::norm(normal.cross(spin.axis)), settings.pole);
  cutting.drag = cutting.torque / (radius * sine) * drag_direction(normal, spin, settings.pole);
  return cutting;
}

}  // namespace burr::edit
