#include "burr/sim/session_words.h"

#include <fmt/format.h>

namespace burr::sim {
namespace {

// One setting: its name in the file and how to reach it.
struct Entry {
  const char* name;
  double (*get)(const Recorded&);
  void (*set)(Recorded&, double);
};

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): the one way to name a member once and use it twice
#define BURR_ENTRY(name, member)                                                  \
  Entry {                                                                         \
    name, [](const Recorded& r) { return static_cast<double>(r.member); },        \
        [](Recorded& r, double v) {                                               \
          r.member = static_cast<std::remove_reference_t<decltype(r.member)>>(v); \
        }                                                                         \
  }

const Entry kEntries[] = {
    BURR_ENTRY("rate_hz", settings.servo.rate_hz),
    BURR_ENTRY("burr_radius_m", settings.servo.burr.radius),
    BURR_ENTRY("burr_kind", settings.servo.burr.kind),
    BURR_ENTRY("spindle_rad_s", settings.servo.spindle_rad_s),
    BURR_ENTRY("stiffness_n_per_m", settings.servo.force.stiffness),
    BURR_ENTRY("damping_n_s_per_m", settings.servo.force.damping),
    BURR_ENTRY("user_force_n", settings.servo.limit.user_force),
    BURR_ENTRY("slew_n_per_s", settings.servo.limit.slew),
    BURR_ENTRY("ramp_slew_n_per_s", settings.servo.limit.ramp_slew),
    BURR_ENTRY("ramp_time_s", settings.servo.limit.ramp_time),
    BURR_ENTRY("small_force_n", settings.servo.limit.small_force),
    BURR_ENTRY("fade_time_s", settings.servo.limit.fade_time),
    BURR_ENTRY("longest_leap_m", settings.servo.limit.longest_leap),
    BURR_ENTRY("cutting_friction", settings.servo.removal.friction),
    BURR_ENTRY("max_power_w", settings.servo.removal.max_power),
    BURR_ENTRY("pole_share", settings.servo.removal.pole),
    BURR_ENTRY("carve_advance_m", settings.servo.carve.advance_m),
    BURR_ENTRY("carve_advance_least_voxel", settings.servo.carve.advance_least),
    BURR_ENTRY("carve_margin_m", settings.servo.carve.margin_m),
    BURR_ENTRY("carve_margin_least_voxel", settings.servo.carve.margin_least),
    BURR_ENTRY("carve_margin_most_voxel", settings.servo.carve.margin_most),
    BURR_ENTRY("carve_margin_rise_voxel_per_s", settings.servo.carve.margin_rise),
    BURR_ENTRY("carve_margin_fall_voxel_per_s", settings.servo.carve.margin_fall),
    BURR_ENTRY("carve_patience_s", settings.servo.carve.patience),
    BURR_ENTRY("deposit_share", settings.servo.carve.deposit_share),
    BURR_ENTRY("deposit_gap_voxel", settings.servo.carve.deposit_gap),
    BURR_ENTRY("tool_mode", settings.servo.mode),
    BURR_ENTRY("friction_scale", settings.servo.friction_scale),
    BURR_ENTRY("friction_turning", settings.servo.friction_turning),
    BURR_ENTRY("kinetic_share", settings.servo.kinetic_share),
    BURR_ENTRY("velocity_filter_hz", settings.servo.velocity_filter_hz),
    BURR_ENTRY("deposit_rate_m3_per_s", settings.servo.deposit_rate),
    BURR_ENTRY("deposit_tissue", settings.servo.deposit_tissue),
    BURR_ENTRY("stroke_pause_s", settings.servo.stroke_pause),
    BURR_ENTRY("lift_speed_m_per_s", settings.servo.lift_speed),
    BURR_ENTRY("undo_bricks", settings.servo.undo_bricks),
    BURR_ENTRY("disc_voxel", settings.surface.disc),
    BURR_ENTRY("stale_units", settings.surface.stale_units),
    BURR_ENTRY("refresh_budget", settings.surface.refresh_budget),
    BURR_ENTRY("refresh_oldest", settings.surface.refresh_oldest),
    BURR_ENTRY("reserve_blocks", settings.surface.reserve_blocks),
    BURR_ENTRY("device_peak_force_n", device.peak_force),
    BURR_ENTRY("device_continuous_force_n", device.continuous_force),
    BURR_ENTRY("device_thermal_budget_n2_s", device.thermal_budget),
    BURR_ENTRY("device_max_stiffness_n_per_m", device.max_stiffness),
    BURR_ENTRY("device_max_damping_n_s_per_m", device.max_damping),
};
#undef BURR_ENTRY

}  // namespace

void describe(const SessionSettings& settings, const device::DeviceSpec& device,
              record::SessionInfo& info) {
  const Recorded all{settings, device};
  for (const Entry& entry : kEntries) info.numbers[entry.name] = entry.get(all);
  info.rate_hz = settings.servo.rate_hz;
  info.words["device"] = device.name;
}

Result<Recorded> settings_of(const record::SessionInfo& info, const std::string& where) {
  Recorded all;
  for (const Entry& entry : kEntries) {
    const auto found = info.numbers.find(entry.name);
    if (found == info.numbers.end())
      return error(fmt::format(
          "{}: the session's settings lack {}; it was recorded by another version of burr ({})",
          where, entry.name, info.burr_version));
    entry.set(all, found->second);
  }
  const auto name = info.words.find("device");
  if (name != info.words.end()) all.device.name = name->second;
  return all;
}

}  // namespace burr::sim
