// The settings of the second hand, as named numbers in a recording (session_words.h).
#include <fmt/format.h>

#include "burr/sim/session_words.h"

namespace burr::sim {
namespace {

struct Entry {
  const char* name;
  double& (*at)(RecordedSecond&);
  double least, most;
};

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): the one way to name a member once and use it twice
#define BURR_AT(member) [](RecordedSecond& r) -> double& { return r.member; }
const Entry kEntries[] = {
    {"radius_m", BURR_AT(settings.radius), 1e-5, 0.05},
    {"stiffness_n_per_m", BURR_AT(settings.force.stiffness), 0, 1e6},
    {"damping_n_s_per_m", BURR_AT(settings.force.damping), 0, 1e4},
    {"friction", BURR_AT(settings.friction), 0, 1e3},
    {"slip_m_per_s", BURR_AT(settings.slip_m_s), 0, 1e6},
    {"velocity_filter_hz", BURR_AT(settings.velocity_filter_hz), 0, 1e6},
    {"user_force_n", BURR_AT(settings.limit.user_force), 0, 1e3},
    {"slew_n_per_s", BURR_AT(settings.limit.slew), 0, 1e9},
    {"ramp_slew_n_per_s", BURR_AT(settings.limit.ramp_slew), 0, 1e9},
    {"ramp_time_s", BURR_AT(settings.limit.ramp_time), 0, 1e6},
    {"small_force_n", BURR_AT(settings.limit.small_force), 0, 1e3},
    {"fade_time_s", BURR_AT(settings.limit.fade_time), 0, 1e6},
    {"longest_leap_m", BURR_AT(settings.limit.largest_jump), 0, 1e3},
    {"device_peak_force_n", BURR_AT(device.peak_force), 0, 1e3},
    {"device_peak_torque_nm", BURR_AT(device.peak_torque), 0, 1e3},
    {"device_continuous_force_n", BURR_AT(device.continuous_force), 0, 1e3},
    {"device_thermal_budget_n2_s", BURR_AT(device.thermal_budget), 0, 1e9},
    {"device_max_stiffness_n_per_m", BURR_AT(device.max_stiffness), 0, 1e6},
    {"device_max_damping_n_s_per_m", BURR_AT(device.max_damping), 0, 1e4},
    {"device_max_turn_stiffness_nm_per_rad", BURR_AT(device.max_turn_stiffness), 0, 1e3},
    {"device_turn_damping_nm_s_per_rad", BURR_AT(device.turn_damping), 0, 1e3},
    {"device_lever_m", BURR_AT(device.lever), 0, 10},
    {"device_scale", BURR_AT(device.scale), 1e-3, 1e3},
};
#undef BURR_AT

}  // namespace

void describe(const tick::SecondHandSettings& settings, const device::DeviceSpec& device,
              record::SessionInfo& info) {
  RecordedSecond all{settings, device};
  record::SecondInfo& second = info.second.emplace();
  for (const Entry& entry : kEntries) second.numbers[entry.name] = entry.at(all);
  second.device = device.name;
  if (settings.tool) second.tools.push_back(*settings.tool);
}

Result<RecordedSecond> second_of(const record::SessionInfo& info, const std::string& where) {
  RecordedSecond all;
  const record::SecondInfo& second = *info.second;
  for (const Entry& entry : kEntries) {
    const auto found = second.numbers.find(entry.name);
    if (found == second.numbers.end())
      return error(fmt::format("{}: the setting {} of the second hand is missing in this recording",
                               where, entry.name));
    if (!(found->second >= entry.least && found->second <= entry.most))
      return error(
          fmt::format("{}: the second hand's setting {} is {}, which is out of range "
                      "({:g} to {:g}); the recording is damaged",
                      where, entry.name, found->second, entry.least, entry.most));
    entry.at(all) = found->second;
  }
  all.device.name = second.device;
  if (!second.tools.empty()) all.settings.tool = second.tools.front();
  return all;
}

}  // namespace burr::sim
