#include "burr/sim/session_words.h"

#include <fmt/format.h>

#include "burr/base/printable.h"
#include "burr/record/tool_json.h"

namespace burr::sim {
namespace {

constexpr std::size_t kHashDigits = 64;

// One setting: its name in the file, how to reach it, and its possible range (wider than that of
// the options, because a file may contain anything).
struct Entry {
  const char* name;
  double (*get)(const Recorded&);
  void (*set)(Recorded&, double);
  double least, most;
  bool newer = false;  // recordings of an older burr lack it: it then is as in older()
};

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): the one way to name a member once and use it twice
#define BURR_ENTRY(name, member, ...)                                             \
  Entry {                                                                         \
    name, [](const Recorded& r) { return static_cast<double>(r.member); },        \
        [](Recorded& r, double v) {                                               \
          r.member = static_cast<std::remove_reference_t<decltype(r.member)>>(v); \
        },                                                                        \
        __VA_ARGS__                                                               \
  }

const Entry kEntries[] = {
    BURR_ENTRY("rate_hz", settings.servo.rate_hz, 1, 100000),
    BURR_ENTRY("burr_radius_m", settings.servo.burr.radius, 1e-5, 0.05),
    BURR_ENTRY("touch_method", settings.servo.touch, 0, haptics::kMethods - 1),
    BURR_ENTRY("burr_kind", settings.servo.burr.kind, 0, 1),
    BURR_ENTRY("burr_teeth", settings.servo.burr.teeth, 0, 1000),
    BURR_ENTRY("spindle_rad_s", settings.servo.spindle_rad_s, -1e6, 1e6),
    BURR_ENTRY("motor_torque_nm", settings.servo.motor.torque, 0, 1e3),
    BURR_ENTRY("motor_droop", settings.servo.motor.droop, 0, 1),
    BURR_ENTRY("motor_inertia_kg_m2", settings.servo.motor.inertia, 0, 1),
    BURR_ENTRY("motor_friction_n_m_s", settings.servo.motor.friction, 0, 1),
    BURR_ENTRY("drag_gain", settings.servo.drag_gain, 0, 100),
    BURR_ENTRY("drag_hz", settings.servo.drag_hz, 0, 1e6),
    BURR_ENTRY("stiffness_n_per_m", settings.servo.force.stiffness, 0, 1e6),
    BURR_ENTRY("damping_n_s_per_m", settings.servo.force.damping, 0, 1e4),
    BURR_ENTRY("guarded", settings.servo.guarded, 0, 1),
    BURR_ENTRY("guard_slack_j", settings.servo.guard_slack, 0, 1),
    BURR_ENTRY("vibration_gain", settings.servo.vibration_gain, 0, 100),
    BURR_ENTRY("torque_gain", settings.servo.torque_gain, 0, 100, true),
    BURR_ENTRY("user_force_n", settings.servo.limit.user_force, 0, 1e3),
    BURR_ENTRY("slew_n_per_s", settings.servo.limit.slew, 0, 1e9),
    BURR_ENTRY("ramp_slew_n_per_s", settings.servo.limit.ramp_slew, 0, 1e9),
    BURR_ENTRY("ramp_time_s", settings.servo.limit.ramp_time, 0, 1e6),
    BURR_ENTRY("small_force_n", settings.servo.limit.small_force, 0, 1e3),
    BURR_ENTRY("fade_time_s", settings.servo.limit.fade_time, 0, 1e6),
    BURR_ENTRY("longest_leap_m", settings.servo.limit.largest_jump, 0, 1e3),
    BURR_ENTRY("removal_law", settings.servo.removal.law, 0, edit::kLaws - 1),
    BURR_ENTRY("thesis_rate_per_s", settings.servo.removal.thesis_rate, 0, 1e6),
    BURR_ENTRY("thesis_frame_ticks", settings.servo.removal.thesis_frame_ticks, 1, 1e6),
    BURR_ENTRY("max_power_w", settings.servo.removal.max_power, 0, 1e6),
    BURR_ENTRY("pole_share", settings.servo.removal.pole, 0, 1),
    BURR_ENTRY("carve_advance_m", settings.servo.carve.advance_m, 0, 1e-2),
    BURR_ENTRY("carve_advance_least_voxel", settings.servo.carve.advance_least, 0, 4),
    BURR_ENTRY("carve_margin_m", settings.servo.carve.margin_m, 0, 1e-2),
    BURR_ENTRY("carve_margin_least_voxel", settings.servo.carve.margin_least, 0, 4),
    BURR_ENTRY("carve_margin_most_voxel", settings.servo.carve.margin_most, 0, 4),
    BURR_ENTRY("carve_margin_rise_voxel_per_s", settings.servo.carve.margin_rise, 0, 1e6),
    BURR_ENTRY("carve_margin_fall_voxel_per_s", settings.servo.carve.margin_fall, 0, 1e6),
    BURR_ENTRY("carve_patience_s", settings.servo.carve.debt_timeout, 0, 1e6),
    BURR_ENTRY("deposit_share", settings.servo.carve.deposit_share, 0, 1),
    BURR_ENTRY("deposit_gap_voxel", settings.servo.carve.deposit_gap, 0, 64),
    BURR_ENTRY("tool", settings.servo.tool, -1, record::kMostTools - 1, true),
    BURR_ENTRY("tool_mode", settings.servo.mode, 0, tick::kToolModes - 1),
    BURR_ENTRY("irrigated", settings.servo.irrigated, 0, 1, true),
    BURR_ENTRY("friction_scale", settings.servo.friction_scale, 0, 1e3),
    BURR_ENTRY("friction_turning", settings.servo.friction_turning, 0, 1e3),
    BURR_ENTRY("kinetic_share", settings.servo.kinetic_share, 0, 1),
    BURR_ENTRY("tool_friction", settings.servo.tool_friction, 0, 1, true),
    BURR_ENTRY("tool_planes", settings.servo.tool_planes, 0, 1, true),
    BURR_ENTRY("tool_close_m", settings.servo.tool_close, 0, 1e-3, true),
    BURR_ENTRY("wedge", settings.servo.wedge, 0, 1e6, true),
    BURR_ENTRY("slip_m_per_s", settings.servo.slip_m_s, 0, 1e6, true),
    BURR_ENTRY("velocity_filter_hz", settings.servo.velocity_filter_hz, 0, 1e6),
    BURR_ENTRY("deposit_rate_m3_per_s", settings.servo.deposit_rate, 0, 1),
    BURR_ENTRY("deposit_tissue", settings.servo.deposit_tissue, 0, 255),
    BURR_ENTRY("stroke_pause_s", settings.servo.stroke_pause, 0, 1e6),
    BURR_ENTRY("lift_speed_m_per_s", settings.servo.lift_speed, 0, 1e3),
    BURR_ENTRY("undo_bricks", settings.servo.undo_bricks, 0, 1 << 18),
    BURR_ENTRY("disc_voxel", settings.surface.disc, 0, 2),
    BURR_ENTRY("stale_units", settings.surface.stale_units, 0, 65535),
    BURR_ENTRY("refresh_budget", settings.surface.refresh_budget, 0, 1 << 20),
    BURR_ENTRY("refresh_oldest", settings.surface.refresh_oldest, 0, 1 << 20),
    BURR_ENTRY("reserve_blocks", settings.surface.reserve_blocks, 0, 1 << 22),
    BURR_ENTRY("device_peak_force_n", device.peak_force, 0, 1e3),
    BURR_ENTRY("device_peak_torque_nm", device.peak_torque, 0, 1e3, true),
    BURR_ENTRY("device_continuous_force_n", device.continuous_force, 0, 1e3),
    BURR_ENTRY("device_thermal_budget_n2_s", device.thermal_budget, 0, 1e9),
    BURR_ENTRY("device_max_stiffness_n_per_m", device.max_stiffness, 0, 1e6),
    BURR_ENTRY("device_max_damping_n_s_per_m", device.max_damping, 0, 1e4),
    BURR_ENTRY("device_max_turn_stiffness_nm_per_rad", device.max_turn_stiffness, 0, 1e3, true),
    BURR_ENTRY("device_turn_damping_nm_s_per_rad", device.turn_damping, 0, 1e3, true),
    BURR_ENTRY("device_lever_m", device.lever, 0, 10, true),
    BURR_ENTRY("device_scale", device.scale, 1e-3, 1e3, true),
    BURR_ENTRY("turn_hand", settings.servo.turn_hand, 0, 1, true),
};
#undef BURR_ENTRY

// What older recordings do not name had these values when they were made.
Recorded older() {
  Recorded all;
  all.settings.servo.wedge = 0;     // no limit
  all.settings.servo.slip_m_s = 0;  // no limit
  all.settings.servo.turn_hand = false;
  all.settings.servo.tool_friction = false;
  all.settings.servo.tool_planes = false;
  all.settings.servo.tool_close = 1e-6;
  return all;
}

}  // namespace

void describe(const SessionSettings& settings, const device::DeviceSpec& device,
              record::SessionInfo& info) {
  const Recorded all{settings, device};
  for (const Entry& entry : kEntries) info.numbers[entry.name] = entry.get(all);
  info.rate_hz = settings.servo.rate_hz;
  info.words["device"] = device.name;
  info.tools = settings.servo.tools;
  if (settings.law) describe(settings.law->about(), info);
}

void describe(const tick::LawAbout& law, record::SessionInfo& info) {
  for (const auto& [name, text] : {std::pair{"law", law.kind},
                                   {"law_name", law.name},
                                   {"law_sha256", law.sha256},
                                   {"law_settings_sha256", law.settings_sha256}})
    if (!text.empty()) info.words[name] = text;
}

tick::LawAbout law_of(const record::SessionInfo& info) {
  const auto word = [&info](const char* name) {
    const auto found = info.words.find(name);
    return found == info.words.end() ? std::string() : found->second;
  };
  return {word("law"), word("law_name"), word("law_sha256"), word("law_settings_sha256")};
}

Status check_law(const record::SessionInfo& info, const tick::OwnLaw* given,
                 const std::string& where) {
  const tick::LawAbout was = law_of(info),
                       is = given != nullptr ? given->about() : tick::LawAbout();
  const std::string name = base::printable(was.name);
  if (was.kind != "compiled") {
    if (given == nullptr) return fine();
    return error(
        Trouble::usage,
        was.kind.empty()
            ? fmt::format("{}: was made without a law of one's own; leave out --law", where)
            : fmt::format("{}: its law was a function of Python, whose answers are in the "
                          "recording; leave out --law",
                          where));
  }
  if (given == nullptr)
    return error(Trouble::usage,
                 fmt::format("{}: was made with the law {} (SHA-256 {}); give that file with --law",
                             where, name, base::printable(was.sha256, kHashDigits)));
  if (is.sha256 != was.sha256)
    return error(
        Trouble::usage,
        fmt::format("{}: was made with another law: the SHA-256 of {} was {}, that of --law "
                    "{} is {}; give the file that it was made with",
                    where, name, base::printable(was.sha256, kHashDigits), base::printable(is.name),
                    is.sha256));
  if (is.settings_sha256 != was.settings_sha256)
    return error(
        Trouble::usage,
        was.settings_sha256.empty()
            ? fmt::format("{}: its law {} had no settings; leave out --law-settings", where, name)
            : fmt::format("{}: its law {} had other settings (SHA-256 {}); give their file with "
                          "--law-settings",
                          where, name, base::printable(was.settings_sha256, kHashDigits)));
  return fine();
}

Result<Recorded> settings_of(const record::SessionInfo& info, const std::string& where) {
  Recorded all = older();
  for (const Entry& entry : kEntries) {
    const auto found = info.numbers.find(entry.name);
    if (found == info.numbers.end() && entry.newer) continue;
    if (found == info.numbers.end())
      return error(
          fmt::format("{}: the setting {} is missing in this recording; it was recorded by another "
                      "version of burr ({})",
                      where, entry.name, base::printable(info.burr_version)));
    if (!(found->second >= entry.least && found->second <= entry.most))
      return error(
          fmt::format("{}: the session's setting {} is {}, which is out of range ({:g} to {:g}); "
                      "the recording is damaged",
                      where, entry.name, found->second, entry.least, entry.most));
    entry.set(all, found->second);
  }
  all.settings.servo.tools = info.tools;
  if (all.settings.servo.tool >= static_cast<int>(info.tools.size()))
    return error(
        fmt::format("{}: the session's tool has number {}, but the recording holds {} tools; "
                    "the recording is damaged",
                    where, all.settings.servo.tool, info.tools.size()));
  const auto name = info.words.find("device");
  if (name != info.words.end()) all.device.name = name->second;
  return all;
}

}  // namespace burr::sim
