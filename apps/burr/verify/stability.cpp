// burr verify stability - how stiff a wall can be before the hand trembles, compared with theory;
// with and without the energy guard.
#include "burr/haptics/safety/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pressing.h"
#include "verify.h"

namespace burr::app {
namespace {

using haptics::AxisSettings;

constexpr double kT = 1e-3;

haptics::Controller plain(double stiffness, double damping) {
  return haptics::wall({.stiffness = stiffness, .damping = damping});
}

void borders(const Verify& verify, VerifyReport::Part& part) {
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

  // at two and four times the border: the plain wall trembles, the guarded one does not
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
    // 4 v_min / omega + v_min T: the motion that remains below the guard's least speed
    const double slow = 2e-3, omega = std::sqrt(k / axis.mass);
    part.at_most(which + ".guarded_range", 1e3 * (4 * slow / omega + slow * kT), 1e3 * kept.late,
                 "mm");
    part.at_most(which + ".guarded_runs_away", 0, kept.ran_away ? 1 : 0, "");
  }
}

// Devices with the stiffness that a public library allows them
// (docs/understand/safety_stability.md, "Devices and hands"); masses of 0.1 kg and b = 0.5 N s/m
// where no figure is known.
void devices(VerifyReport::Part& part) {
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
      "Devices at the stiffness k and damping B that CHAI3D allows for them, with the velocity "
      "filtered at 100 Hz as in burr: how far the hand trembles at the end of four seconds, "
      "without the guard (bare) and with it. Mass 0.1 kg, damping b 0.5 N s/m and friction are "
      "assumed, except for the Omni.";
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

void lasting(const Verify& verify, VerifyReport::Part& part) {
  using tick::ToolMode;
  const double seconds = verify.quick ? 6 : 30;
  const phantom::Depth flat = phantom::slab(), groove = phantom::groove(M_PI / 4);
  const device::ArmSettings stiff = {.mass = 0.3, .damping = 40, .stiffness = 3000};
  // border 2 b / T = 2 kN/m
  const device::ArmSettings loose = {.mass = 0.06, .damping = 1, .stiffness = 200};
  const Pressing kAll[] = {
      {.name = "touch", .bone = flat},
      {.name = "touch_guarded", .bone = flat, .guarded = true},
      {.name = "removing", .bone = flat, .mode = ToolMode::cut, .drag = 0},
      {.name = "removing_guarded", .bone = flat, .mode = ToolMode::cut, .guarded = true, .drag = 0},
      {.name = "adding", .bone = flat, .mode = ToolMode::add},
      {.name = "groove_small_burr", .bone = groove, .radius = 1e-3},
      {.name = "groove_large_burr", .bone = groove, .radius = 3e-3},
      {.name = "stiff_on_stiff", .bone = flat, .stiffness = 5000, .arm = stiff},
      {.name = "beyond", .bone = flat, .stiffness = 5000, .arm = loose},
      {.name = "beyond_guarded", .bone = flat, .stiffness = 5000, .arm = loose, .guarded = true},
      {.name = "stiff_in_groove", .bone = groove, .stiffness = 5000, .arm = stiff},
  };
  Table table;
  table.caption = fmt::format(
      "A hand presses for {:.0f} s: 60 g on 200 N/m, or a stiff hand of 0.3 kg on 3 kN/m against a "
      "wall of 5 kN/m. The table gives the energy that the hand has given: its least value during "
      "the run and its value at the end; and how much the force varies in the last second.",
      seconds);
  table.head = {"contact", "least energy [mJ]", "at the end [mJ]", "force [N]", "wavers by"};
  for (const Pressing& one : kAll) {
    const Lasting out = last(one, seconds);
    const std::string name = fmt::format("lasting.{}", one.name);
    const bool beyond = name == "lasting.beyond";  // 2.5 times the border: must fail
    // what the guard allows: its slack, and k T v^2 / 2 per second below its least speed
    const tick::ServoSettings usual;
    const double slow = haptics::EnergyGuardSettings{}.least_speed;
    const double allowed =
        one.guarded ? usual.guard_slack + 0.5 * one.stiffness * kT * slow * slow * seconds : 20e-6;
    if (beyond)
      part.at_least(name + ".wavers", 0.1, out.ripple, "of the force");
    else
      part.at_least(name + ".energy", -1e3 * allowed, out.ok ? 1e3 * out.least : -1e3, "mJ");
    if (one.mode == ToolMode::touch && one.arm.damping > 1)
      part.at_most(name + ".wavers", 0.01, out.ripple, "of the force");
    table.rows.push_back({one.name, fmt::format("{:.4f}", 1e3 * out.least),
                          fmt::format("{:.3f}", 1e3 * out.energy), fmt::format("{:.3f}", out.force),
                          fmt::format("{:.2g}", out.ripple)});
  }
  part.table(std::move(table));
}

void stability(const Verify& verify, VerifyReport::Part& part) {
  borders(verify, part);
  devices(part);
  lasting(verify, part);
  part.cannot("a real device; masses, damping and friction of all but one are assumed");
}

const VerifyPart part{
    50, "stability", "Stability",
    "Simulated hands on simulated devices press against a sampled wall. Compared with linear "
    "theory (Colgate and Schenkel 1994): the stiffness at which the wall begins to tremble, also "
    "with delay, and beyond that stiffness with the energy guard.",
    stability};

}  // namespace
}  // namespace burr::app
