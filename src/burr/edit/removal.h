// edit/removal.h - how much bone a turning burr takes per second: the energy law.
//
//     MRR = min( eta mu_c F_n w r_eff,  P_max ) / u         [m^3/s]
//
// Friction power at the contact, over the energy a volume of this tissue costs to cut (Agus et al.
// 2003; Preston; Archard; algorithms.md 3e level 1). r_eff = r sin(theta), theta between the burr's
// axis and the contact normal: the pole of a burr cuts least. No push, no speed: no cut.
// The other laws are what it is measured against. Thread: servo. Units: SI.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::edit {

enum class RemovalLaw {
  energy,  // the above
  thesis,  // Eriksson 2006: whatever is in the mill loses density with time; no force, no ledger
};
inline constexpr int kLaws = 2;
inline constexpr std::array<std::string_view, kLaws> kLawNames = {"energy", "thesis"};

[[nodiscard]] constexpr std::optional<RemovalLaw> law_named(std::string_view name) {
  for (std::size_t n = 0; n < kLaws; ++n)
    if (kLawNames[n] == name) return static_cast<RemovalLaw>(n);
  return std::nullopt;
}

struct RemovalSettings {
  RemovalLaw law = RemovalLaw::energy;
  double friction = 0.4;    // mu_c of cutting                                            [-]
  double max_power = 60;    // of the motor at the burr                                   [W]
  double pole = 0.15;       // least sin(theta)                                           [-]
  double thesis_rate = 10;  // of a voxel's density, 1 being solid; the thesis names none  [1/s]
  int thesis_frame = 1;     // every so many ticks, then for all of them; its own graphics loop: 33
};

// Power that goes into cutting [W].  normal: unit contact normal; axis: unit, of the burr; force_n
// [N]; speed [rad/s]
[[nodiscard]] inline double cutting_power(double force_n, double speed, double radius,
                                          double efficiency, const math::Vec3& normal,
                                          const math::Vec3& axis,
                                          const RemovalSettings& settings) BURR_RT {
  const double sine = std::max(normal.cross(axis).norm(), settings.pole);
  const double power = efficiency * settings.friction * force_n * speed * radius * sine;
  return std::clamp(power, 0.0, settings.max_power);
}

}  // namespace burr::edit
