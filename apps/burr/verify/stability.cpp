// burr verify stability - how stiff a wall a hand may hold, against theory; with and without the
// energy guard.
#include "burr/haptics/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "verify.h"

namespace burr::app {
namespace {

using haptics::AxisSettings;

constexpr double kT = 1e-3;

haptics::Controller plain(double stiffness, double damping) {
  return haptics::wall({.stiffness = stiffness, .damping = damping});
}

void borders(const Verify& verify, Report::Part& part) {
  struct Case {
    double b, B;
  };
  Plot plot{
      "Border of instability, measured by bisection on a simulated device (dots), and 2 (b + B) "
      "/ T of linear theory (dashed).",
      2,
      {{"damping of device and wall", "b + B [N s/m]", "stiffness [N/m]", {}},
       {"delay", "delay [ms]", "stiffness [N/m]", {}}}};
  Line measured{"measured", {}, {}, false, true}, theory{"2 (b + B) / T", {}, {}, true};
  for (const Case& one : {Case{0.5, 0}, Case{0.5, 1}, Case{1, 2}})
    for (const double mass : {0.045, 0.09}) {
      AxisSettings axis;
      axis.mass = mass;
      axis.damping = one.b;
      const double right = 2 * (one.b + one.B) / kT;
      const double border = haptics::stiffness_border(
          axis, [&](double k) { return plain(k, one.B); }, 0.2 * right, 3 * right);
      part.near(fmt::format("border.b{}.B{}.{:.0f}g", one.b, one.B, 1e3 * mass), right, border,
                0.1 * right, "N/m");
      measured.x.push_back(one.b + one.B);
      measured.y.push_back(border);
      theory.x.push_back(one.b + one.B);
      theory.y.push_back(right);
    }
  plot.axes[0].lines = {measured, theory};
  Line late{"measured", {}, {}, false, true}, bound{"b / (T/2 + t_d)", {}, {}, true};
  for (const double delay : {0.0, 0.5e-3, 1e-3, 2e-3, 4e-3}) {
    AxisSettings axis;
    axis.damping = 1;
    axis.delay = delay;
    const double right = axis.damping / (kT / 2 + delay);
    const double border = haptics::stiffness_border(
        axis, [&](double k) { return plain(k, 0); }, 0.2 * right, 3 * right);
    part.near(fmt::format("delay.{}ms", 1e3 * delay), right, border, 0.1 * right, "N/m");
    late.x.push_back(1e3 * delay);
    late.y.push_back(border);
    bound.x.push_back(1e3 * delay);
    bound.y.push_back(right);
  }
  plot.axes[1].lines = {late, bound};
  part.plot(std::move(plot));

  // twice and four times the border: the plain wall trembles, the guarded one is quiet
  for (const double times : {2.0, 4.0}) {
    AxisSettings axis;
    const double border = 2 * axis.damping / kT, k = times * border;
    haptics::Swing how;
    how.duration = verify.quick ? 10 : 60;
    const haptics::WallSettings wall{.stiffness = k};
    const haptics::Swung bare = haptics::swing(axis, haptics::wall(wall), how);
    const haptics::Swung kept = haptics::swing(axis, haptics::guarded_wall(wall, {}), how);
    const std::string which = fmt::format("guard.{:.0f}x", times);
    part.at_least(which + ".bare_trembles", 1, bare.ran_away ? 1e3 : 1e3 * bare.late, "mm");
    // 4 v_min / omega + v_min T: what goes on below the guard's least speed
    const double slow = 2e-3, omega = std::sqrt(k / axis.mass);
    part.at_most(which + ".guarded_range", 1e3 * (4 * slow / omega + slow * kT), 1e3 * kept.late,
                 "mm");
    part.at_most(which + ".guarded_runs_away", 0, kept.ran_away ? 1 : 0, "");
  }
}

// The devices of algorithms.md 4.1 whose stiffness a public library allows; masses of 0.1 kg and
// b = 0.5 N s/m where nobody tells.
void devices(Report::Part& part) {
  struct Device {
    const char* name;
    double mass, friction, step, stiffness, damping;
  };
  constexpr Device kDevices[] = {
      {"PHANToM Omni / Touch", 0.045, 0.26, 55e-6, 700, 5},
      {"Touch X", 0.1, 0.06, 23e-6, 1000, 5},
      {"Premium 1.5", 0.1, 0.04, 30e-6, 800, 5},
      {"omega.3", 0.1, 0, 10e-6, 5000, 30},
      {"Novint Falcon", 0.1, 0.1, 60e-6, 3000, 20},
      {"Polhem", 0.1, 0, 10e-6, 1000, 8},
  };
  Table table;
  table.caption =
      "Devices at the stiffness k and damping B that CHAI3D allows them, with velocity filtered at "
      "100 Hz as burr does: how far the hand trembles at the end of four seconds without and with "
      "the "
      "guard. Mass 0.1 kg, b 0.5 N s/m and friction are assumed except for the Omni.";
  table.head = {"device", "k [N/m]", "B [N s/m]", "bare [mm]", "guarded [mm]"};
  for (const Device& one : kDevices) {
    AxisSettings axis;
    axis.mass = one.mass;
    axis.dry_friction = one.friction;
    axis.encoder_step = one.step;
    axis.velocity_filter_hz = 100;
    const haptics::WallSettings wall{.stiffness = one.stiffness, .damping = one.damping};
    const haptics::Swung bare = haptics::swing(axis, haptics::wall(wall));
    haptics::EnergyGuardSettings guard;
    guard.encoder_step = one.step;
    const haptics::Swung kept = haptics::swing(axis, haptics::guarded_wall(wall, guard));
    table.rows.push_back({one.name, fmt::format("{:.0f}", one.stiffness),
                          fmt::format("{:.0f}", one.damping),
                          bare.ran_away ? "runs away" : fmt::format("{:.3f}", 1e3 * bare.late),
                          kept.ran_away ? "runs away" : fmt::format("{:.3f}", 1e3 * kept.late)});
  }
  part.table(std::move(table));
}

void stability(const Verify& verify, Report::Part& part) {
  borders(verify, part);
  devices(part);
  part.cannot("a real device: masses, damping and friction of all but one are assumed");
}

const VerifyPart part{
    50, "stability", "Stability",
    "Simulated hands on simulated devices against a sampled wall: the stiffness at "
    "which it begins to tremble, beside linear theory (Colgate and Schenkel 1994), "
    "with delay, and beyond it with the energy guard.",
    stability};

}  // namespace
}  // namespace burr::app
