#include "burr/tick/setting_table.h"

#include <numbers>
#include <type_traits>

#include "burr/tick/second_hand.h"
#include "burr/tool/limits.h"

namespace burr::tick {
namespace {

using Kind = About::Kind;

// ---- a row: what it is, then in which range

constexpr About number(const char* name, const char* unit, Range range, const char* help) {
  return {name, unit, Kind::number, range, range, help};
}
constexpr About whole(const char* name, Range range, const char* help) {
  return {name, "", Kind::whole, range, range, help};
}
constexpr About flag(const char* name, const char* help) {
  return {name, "", Kind::flag, {0, 1}, {0, 1}, help};
}
constexpr About choice(const char* name, std::span<const std::string_view> names,
                       const char* help) {
  const Range all = {0, static_cast<double>(names.size()) - 1};
  return {name, "", Kind::choice, all, all, help, names};
}

// ---- what persons type. The bits of a session depend on how a number becomes SI.

constexpr double same(double value) { return value; }
constexpr double from_diameter_mm(double mm) { return 0.5e-3 * mm; }
constexpr double to_diameter_mm(double radius) { return 2e3 * radius; }
constexpr double from_milli(double milli) { return 1e-3 * milli; }
constexpr double to_milli(double value) { return 1e3 * value; }
constexpr double from_rpm(double rpm) { return rpm * 2 * std::numbers::pi / 60; }
constexpr double to_rpm(double rad_s) { return rad_s * 60 / (2 * std::numbers::pi); }

constexpr Typed typed(const char* word, const char* unit, double (*to_si)(double),
                      double (*from_si)(double)) {
  return {word, unit, to_si, from_si};
}
constexpr Typed typed(const char* word, const char* unit = "") { return {word, unit, same, same}; }
constexpr Typed in_session(Typed by_persons) {
  by_persons.place = Typed::Place::session;
  return by_persons;
}
constexpr Typed said(Typed by_persons, const char* help) {
  by_persons.help = help;
  return by_persons;
}
// The command line and Python call it otherwise.
constexpr Typed called(Typed by_persons, const char* option, const char* property) {
  by_persons.option = option;
  by_persons.property = property;
  return by_persons;
}
constexpr Typed in_burr(Typed by_persons) {
  by_persons.place = Typed::Place::burr;
  return by_persons;
}

// ---- ranges

// a diameter in mm at a limit is inside, however it was rounded
constexpr Range kRadius = {0.5 * tool::kSmallestDiameter - 1e-12,
                           0.5 * tool::kLargestDiameter + 1e-12};
constexpr double kFastest = from_rpm(tool::kFastestRpm);
constexpr double kLargestUndo = 1 << 18;
constexpr Range kOften = {0, 1e6};
constexpr Range kShare = {0, 1};

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): the one way to name a member once and use it twice
#define BURR_AT(member)                                                                      \
  [](const Of& all) { return static_cast<double>(all.member); }, [](Of& all, double value) { \
    all.member = static_cast<std::remove_reference_t<decltype(all.member)>>(value);          \
  }

struct OfServo {
  using Of = ServoSettings;
  static constexpr Setting<Of> kAll[] = {
      {number("rate_hz", "Hz", {500, 10'000}, "ticks a second")
           .read_from(1, 100'000)
           .as(in_session(called(typed("rate_hz", "Hz"), "rate", nullptr))),
       BURR_AT(rate_hz)},
      // the tool
      {number("burr_radius_m", "m", kRadius, "radius of the burr's head")
           .read_from(1e-5, 0.05)
           .as(in_burr(said(typed("burr_mm", "mm", from_diameter_mm, to_diameter_mm),
                            "diameter of the burr's head"))),
       BURR_AT(burr.radius)},
      {flag("burr_kind",
            "1: a diamond burr, which removes a quarter as fast; 0: a cutting burr with teeth")
           .as(in_burr(said(typed("diamond"), "diamond burr: a quarter of the removal rate"))),
       BURR_AT(burr.kind)},
      {whole("burr_teeth", {1, 64}, "cutting edges of a cutting burr, for the law chips")
           .read_from(0, 1000)
           .as(in_session(typed("teeth"))),
       BURR_AT(burr.teeth)},
      {whole("tool", {-1, static_cast<double>(tool::kMostTools) - 1},
             "number of the tool in the hand, of the session's list; -1: the round burr")
           .from_day("2026-11-27", -1),
       BURR_AT(tool)},
      {whole("tool_mode", {0, kToolModes - 1},
             "what the tool does: 0 cuts, 1 adds, 2 touches, 3 brings the bone back, 4 smooths"),
       BURR_AT(mode)},
      {flag("irrigated", "coolant runs over the burr from the start")
           .from_day("2026-11-23", 0)
           .as(in_session(called(typed("irrigation"), nullptr, "irrigated"))),
       BURR_AT(irrigated)},
      // the spindle
      {number("spindle_rad_s", "rad/s", {-kFastest, kFastest},
              "speed of the spindle with the pedal down; below 0 it turns backwards")
           .read_from(-1e6, 1e6)
           .as(in_burr(said(typed("rpm", "1/min", from_rpm, to_rpm),
                            "speed of the spindle; below 0 it turns backwards"))),
       BURR_AT(spindle_rad_s)},
      {number("motor_torque_nm", "N m", {0, 1}, "largest torque of the spindle; 0: unlimited")
           .read_from(0, 1e3)
           .as(in_session(typed("torque_mnm", "mN m", from_milli, to_milli))),
       BURR_AT(motor.torque)},
      {number("motor_droop", "", kShare, "share of the speed that is lost at the largest torque"),
       BURR_AT(motor.droop)},
      {number("motor_inertia_kg_m2", "kg m^2", kShare, "inertia of rotor, chuck and burr"),
       BURR_AT(motor.inertia)},
      {number("motor_friction_n_m_s", "N m s", kShare, "friction of the motor's bearings"),
       BURR_AT(motor.friction)},
      // touch
      {choice("touch_method", haptics::kMethodNames,
              "method of touch: constraint (burr's own), shaft (the burr's shaft touches too), or "
              "another for comparison")
           .as(in_session(typed("touch"))),
       BURR_AT(touch)},
      {number("stiffness_n_per_m", "N/m", {1, 1e6},
              "stiffness of the spring to the hand, limited by the device")
           .read_from(0, 1e6)
           .as(in_session(called(typed("stiffness_n_per_m", "N/m"), "stiffness", nullptr))),
       BURR_AT(force.stiffness)},
      {number("damping_n_s_per_m", "N s/m", {0, 1e4}, "damping of a burr that comes closer"),
       BURR_AT(force.damping)},
      {flag("guarded", "energy guard: the hand never gets back more energy than it gave")
           .as(in_session(called(typed("guard"), nullptr, "guarded"))),
       BURR_AT(guarded)},
      {number("guard_slack_j", "J", kShare, "energy that the guard lets pass"),
       BURR_AT(guard_slack)},
      {number(
           "drag_gain", "", {0, 10},
           "gain of the force with which the bone pulls a turning burr along its surface; 0: none")
           .read_from(0, 100)
           .as(in_session(typed("drag"))),
       BURR_AT(drag_gain)},
      {number("drag_hz", "Hz", kOften, "that force follows no faster"), BURR_AT(drag_hz)},
      {number("vibration_gain", "", {0, 100},
              "gain of the spindle's vibration in the hand; 0: none, 1: as designed")
           .as(in_session(typed("vibration"))),
       BURR_AT(vibration_gain)},
      {number("torque_gain", "", {0, 100},
              "gain of the motor's torque on a hand that a device can turn; 0: no torque at all")
           .from_day("2026-11-24", 1),
       BURR_AT(torque_gain)},
      {flag("turn_hand", "the torque of a contact turns the hand, where the device can")
           .from_day("2026-11-27", 0),
       BURR_AT(turn_hand)},
      {number("friction_scale", "", {0, 1e3}, "factor on the friction of the tissues"),
       BURR_AT(friction_scale)},
      {number("friction_turning", "", {0, 1e3}, "factor on friction while the spindle turns"),
       BURR_AT(friction_turning)},
      {number("kinetic_share", "", kShare, "sliding friction over sticking friction"),
       BURR_AT(kinetic_share)},
      {flag("tool_friction", "friction holds tools of several parts too").from_day("2026-11-27", 0),
       BURR_AT(tool_friction)},
      {flag("tool_planes", "tools of several parts rest on planes of the bone")
           .from_day("2026-11-28", 0),
       BURR_AT(tool_planes)},
      {number("tool_close_m", "m", {0, 1e-3},
              "a move of a tool of several parts that is shorter ends the search of a tick")
           .from_day("2026-11-28", 1e-6),
       BURR_AT(tool_close)},
      {number("wedge", "", kOften, "friction counts at most so many times the push; 0: no limit")
           .from_day("2026-11-25", 0),
       BURR_AT(wedge)},
      {number("slip_m_per_s", "m/s", kOften,
              "the stretch of the spring changes by the hand's move and so much more; 0: no limit")
           .from_day("2026-11-25", 0),
       BURR_AT(slip_m_s)},
      {number("velocity_filter_hz", "Hz", kOften, "filter of the hand's velocity, first order"),
       BURR_AT(velocity_filter_hz)},
      // removal
      {choice("removal_law", edit::kLawNames, "law of removal").as(in_session(typed("removal"))),
       BURR_AT(removal.law)},
      {number("thesis_rate_per_s", "1/s", kOften,
              "the law thesis: loss of a voxel's density, of which 1 is solid")
           .as(typed("thesis_rate", "1/s")),
       BURR_AT(removal.thesis_rate)},
      {whole(
           "thesis_frame_ticks", {1, 1e6},
           "the law thesis: bone is removed every so many ticks; the thesis' own picture loop: 33")
           .as(typed("thesis_frame")),
       BURR_AT(removal.thesis_frame_ticks)},
      {number("max_power_w", "W", kOften, "largest power of the motor at the burr"),
       BURR_AT(removal.max_power)},
      {number("pole_share", "", kShare,
              "smallest sine of the angle between shaft and contact that counts"),
       BURR_AT(removal.pole)},
      {number("carve_advance_m", "m", {0, 1e-2}, "how far the teeth reach ahead along the push"),
       BURR_AT(carve.advance_m)},
      {number("carve_advance_least_voxel", "voxel", {0, 4}, "the same, at the least"),
       BURR_AT(carve.advance_least)},
      {number("carve_margin_m", "m", {0, 1e-2}, "how far the teeth reach out of the burr"),
       BURR_AT(carve.margin_m)},
      {number("carve_margin_least_voxel", "voxel", {0, 4}, "the same, at the least"),
       BURR_AT(carve.margin_least)},
      {number("carve_margin_most_voxel", "voxel", {0, 4}, "the same, while the burr is blocked"),
       BURR_AT(carve.margin_most)},
      {number("carve_margin_rise_voxel_per_s", "voxel/s", kOften,
              "how fast it grows while the burr is blocked"),
       BURR_AT(carve.margin_rise)},
      {number("carve_margin_fall_voxel_per_s", "voxel/s", kOften,
              "how fast it shrinks while the burr cuts freely"),
       BURR_AT(carve.margin_fall)},
      {number("carve_patience_s", "s", kOften, "bone that is due to go is given up after so long"),
       BURR_AT(carve.debt_timeout)},
      {number("deposit_share", "", kShare, "radius of added material over that of the burr"),
       BURR_AT(carve.deposit_share)},
      {number("deposit_gap_voxel", "voxel", {0, 64}, "gap between the burr and added material"),
       BURR_AT(carve.deposit_gap)},
      {number("deposit_rate_m3_per_s", "m^3/s", kShare, "material added with the pedal down"),
       BURR_AT(deposit_rate)},
      {whole("deposit_tissue", {0, 255}, "number of the tissue that is added"),
       BURR_AT(deposit_tissue)},
      // strokes
      {number("stroke_pause_s", "s", kOften, "a stroke ends after so long without contact"),
       BURR_AT(stroke_pause)},
      {number("lift_speed_m_per_s", "m/s", {0, 1e3},
              "speed of the burr out of the bone before an undo"),
       BURR_AT(lift_speed)},
      {whole("undo_bricks", {0, kLargestUndo}, "memory for undo: bricks of 8^3 voxels")
           .as(in_session(typed("undo_bricks"))),
       BURR_AT(undo_bricks)},
  };
};

struct OfLimit {
  using Of = haptics::LimitSettings;
  static constexpr Setting<Of> kAll[] = {
      {number("user_force_n", "N", {0, 1e3}, "largest force, the user's own limit"),
       BURR_AT(user_force)},
      {number("slew_n_per_s", "N/s", {0, 1e9}, "fastest growth of the force"), BURR_AT(slew)},
      {number("ramp_slew_n_per_s", "N/s", {0, 1e9}, "the same at the start"), BURR_AT(ramp_slew)},
      {number("ramp_time_s", "s", kOften, "how long the start lasts"), BURR_AT(ramp_time)},
      {number("small_force_n", "N", {0, 1e3}, "the force begins only after it was this small"),
       BURR_AT(small_force)},
      {number("fade_time_s", "s", kOften, "time to zero force when the hand is lost"),
       BURR_AT(fade_time)},
      {number("longest_leap_m", "m", {0, 1e3},
              "a longer move of the hand in one tick is not believed"),
       BURR_AT(largest_jump)},
  };
};

struct OfSurface {
  using Of = volume::IsoSettings;
  static constexpr Setting<Of> kAll[] = {
      {number("disc_voxel", "voxel", {0, 2},
              "radius of the discs of which the felt surface is made"),
       BURR_AT(disc)},
      {whole("stale_units", {0, 65'535}, "a brick that lost less may wait"), BURR_AT(stale_units)},
      {whole("refresh_budget", {0, 1 << 20}, "bricks whose surface is made anew in a tick"),
       BURR_AT(refresh_budget)},
      {whole("refresh_oldest", {0, 1 << 20}, "how many of these go by their age"),
       BURR_AT(refresh_oldest)},
      {whole("reserve_blocks", {0, 1 << 22},
             "memory for surface that cutting lays bare: blocks of 16 points"),
       BURR_AT(reserve_blocks)},
  };
};

struct OfSecond {
  using Of = SecondHandSettings;
  static constexpr Setting<Of> kAll[] = {
      {number("radius_m", "m", {1e-5, 0.05}, "radius of the ball at its tip"), BURR_AT(radius)},
      {number("stiffness_n_per_m", "N/m", {1, 1e6}, "stiffness of the spring to the hand")
           .read_from(0, 1e6),
       BURR_AT(force.stiffness)},
      {number("damping_n_s_per_m", "N s/m", {0, 1e4}, "damping of a tip that comes closer"),
       BURR_AT(force.damping)},
      {number("friction", "", {0, 1e3}, "friction of its ball"), BURR_AT(friction)},
      {number("slip_m_per_s", "m/s", kOften, "as that of the first hand"), BURR_AT(slip_m_s)},
      {number("velocity_filter_hz", "Hz", kOften, "as that of the first hand"),
       BURR_AT(velocity_filter_hz)},
  };
};

struct OfDevice {
  using Of = device::DeviceSpec;
  static constexpr const char* kTorque = "2026-11-24";  // the days of what was added
  static constexpr const char* kTurn = "2026-11-27";
  static constexpr Setting<Of> kAll[] = {
      {number("device_peak_force_n", "N", {0, 1e3}, "largest force"), BURR_AT(peak_force)},
      {number("device_peak_torque_nm", "N m", {0, 1e3}, "largest torque about the tip; 0: none")
           .from_day(kTorque, 0),
       BURR_AT(peak_torque)},
      {number("device_continuous_force_n", "N", {0, 1e3}, "force that may last for ever"),
       BURR_AT(continuous_force)},
      {number("device_thermal_budget_n2_s", "N^2 s", {0, 1e9}, "limit on the heat of its motors"),
       BURR_AT(thermal_budget)},
      {number("device_max_stiffness_n_per_m", "N/m", {0, 1e6}, "stiffest wall that it can show"),
       BURR_AT(max_stiffness)},
      {number("device_max_damping_n_s_per_m", "N s/m", {0, 1e4},
              "largest damping that it can show"),
       BURR_AT(max_damping)},
      {number("device_max_turn_stiffness_nm_per_rad", "N m/rad", {0, 1e3},
              "stiffest spring of turning that it can show; 0: not known")
           .from_day(kTurn, 0),
       BURR_AT(max_turn_stiffness)},
      {number("device_turn_damping_nm_s_per_rad", "N m s/rad", {0, 1e3},
              "its own damping when it is turned; 0: not known")
           .from_day(kTurn, 0),
       BURR_AT(turn_damping)},
      {number("device_lever_m", "m", {0, 10}, "from where it pushes to the tip").from_day(kTurn, 0),
       BURR_AT(lever)},
      {number("device_scale", "", {1e-3, 1e3}, "movement of the tip over that of the hand")
           .from_day(kTurn, 1),
       BURR_AT(scale)},
  };
};
#undef BURR_AT

}  // namespace

std::span<const Setting<ServoSettings>> servo_settings() { return OfServo::kAll; }
std::span<const Setting<haptics::LimitSettings>> limit_settings() { return OfLimit::kAll; }
std::span<const Setting<volume::IsoSettings>> surface_settings() { return OfSurface::kAll; }
std::span<const Setting<SecondHandSettings>> second_hand_settings() { return OfSecond::kAll; }
std::span<const Setting<device::DeviceSpec>> device_settings() { return OfDevice::kAll; }

const Setting<ServoSettings>* setting_of_word(std::string_view word) {
  for (const Setting<ServoSettings>& one : servo_settings())
    if (one.about.typed.word != nullptr && word == one.about.typed.word) return &one;
  return nullptr;
}

}  // namespace burr::tick
