#include "burr/fit/recorded_log.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "burr/base/printable.h"
#include "burr/math/vec3.h"

namespace burr::fit {
namespace {

// The session's settings that the law of removal needs.
struct Law {
  double pole = 0, max_power = 0;
  double friction = 0;  // 0: from the tissues; then power is recorded
};

Result<Law> law_of(const record::SessionInfo& info, const std::string& file) {
  const auto number = [&info](const char* name) -> std::optional<double> {
    const auto found = info.numbers.find(name);
    return found == info.numbers.end() ? std::nullopt : std::optional(found->second);
  };
  Law law;
  for (const auto& [name, place] :
       {std::pair{"pole_share", &law.pole}, std::pair{"max_power_w", &law.max_power}}) {
    const auto value = number(name);
    if (!value || !(*value >= 0))
      return error(
          fmt::format("{}: the setting {} is missing in this recording; it was recorded by another "
                      "version of burr ({})",
                      file, name, base::printable(info.burr_version)));
    *place = *value;
  }
  law.friction = number("cutting_friction").value_or(0);
  if (number("removal_law").value_or(0) == 1)
    return error(
        fmt::format("{}: was milled with the removal law of the thesis, which does not depend on "
                    "force; record with the law energy",
                    file));
  return law;
}

Result<std::string> only_solid(const volume::TissueTable& tissues, const std::string& file) {
  std::string name;
  int solid = 0;
  for (std::size_t id = 1; id < tissues.tissues.size(); ++id) {
    if (tissues.tissues[id].kind != volume::TissueKind::solid) continue;
    name = tissues.tissues[id].name;
    ++solid;
  }
  if (solid == 1) return name;
  return error(Trouble::usage,
               fmt::format("{}: the bone has {} solid tissues, and a recording does not say which "
                           "one was cut; name it as `material`",
                           file, solid));
}

// Sums over one window.
struct Window {
  int ticks = 0;
  bool whole = true;  // cut in every tick, none missing
  double normal = 0, speed = 0, radius = 0, friction_power = 0, power = 0, torque = 0;
  double removed_at_start = 0;
};

// Refuses a tick from which no constant can be fitted. kind: of the burr in the ticks before.
Status check_step(const record::Step& step, tool::BurrKind kind, const record::SessionInfo& info,
                  const std::string& file) {
  for (const tick::Command& command : step.commands)
    if (command.kind == tick::CommandKind::removal_law && command.value == 1)
      return error(
          fmt::format("{}: was partly milled with the removal law of the thesis, which does not "
                      "depend on force; record with the law energy",
                      file));
  if (!(step.row.tool.radius > 0))
    return error(
        fmt::format("{}: the size of the burr is missing in this recording; it was recorded by "
                    "another version of burr ({})",
                    file, base::printable(info.burr_version)));
  if (step.row.tool.kind != kind)
    return error(
        fmt::format("{}: the burr was changed between cutting and diamond during the session; "
                    "record one session for each",
                    file));
  return fine();
}

}  // namespace

Result<ForceLog> log_of_recording(record::Player& player, double window,
                                  std::string_view material) {
  const record::SessionInfo& info = player.info();
  const std::string file = std::filesystem::path(player.path()).filename().string();
  auto law = law_of(info, file);
  if (!law) return law.error();
  std::string name(material);
  if (name.empty()) {
    auto only = only_solid(info.volume.tissues, file);
    if (!only) return only.error();
    name = *only;
  }
  const int per_window = std::max(1, static_cast<int>(std::lround(window * info.rate_hz)));

  ForceLog log;
  const std::size_t place = log.material(name);
  struct Both {
    ForceRow row;
    double power, torque_force;
  };
  std::vector<Both> rows;
  bool any_power = false, any_torque = false, any_removal = false;
  record::Step step;
  record::StepCursor steps = player.steps();
  Window now;
  double removed = 0;
  std::optional<tool::BurrKind> kind;  // of the whole session
  std::uint64_t removing = 0;
  while (steps.next(step)) {
    const tick::TickRow& tick = step.row;
    const Status usable = check_step(step, kind.value_or(tick.tool.kind), info, file);
    if (!usable) return usable.error();
    kind = tick.tool.kind;
    if (now.ticks == 0) {
      now = {};
      now.removed_at_start = removed;
    }
    const math::Vec3& normal = tick.contact.normal;
    const math::Vec3 axis = tick.hand.world_from_tool.q * math::Vec3::UnitZ();
    const double push = std::max(0.0, tick.contact.force.dot(normal));
    const double effective = tick.tool.radius * std::max(normal.cross(axis).norm(), law->pole);
    const bool cuts = tick.contact.touching && push > 0 && tick.spindle_rad_s > 0;
    now.whole = now.whole && cuts && !step.gap && tick.ledger.removed >= removed;
    removed = tick.ledger.removed;
    ++now.ticks;
    now.normal += push;
    now.speed += tick.spindle_rad_s;
    now.radius += effective;
    now.friction_power +=
        std::min(law->friction * push * tick.spindle_rad_s * effective, law->max_power);
    now.power += tick.cutting_w;
    now.torque += tick.cutting_nm;
    if (now.ticks < per_window) continue;
    const double n = now.ticks;
    ForceRow row;
    row.time = (static_cast<double>(tick.tick + 1) - 0.5 * n) / info.rate_hz;
    row.normal = now.normal / n;
    row.speed = now.speed / n;
    row.radius = now.radius / n;
    row.removal = (removed - now.removed_at_start) * info.rate_hz / n;
    row.material = place;
    if (now.whole) {
      row.power = now.friction_power / n;
      rows.push_back({row, now.power / n, now.torque / n / row.radius});
      any_power = any_power || now.power != 0;
      any_torque = any_torque || now.torque != 0;
    }
    removing += row.removal > 0 ? 1U : 0U;
    any_removal = any_removal || row.removal > 0;
    now.ticks = 0;
  }
  for (const std::string& notice : player.notices()) log.notices.push_back(notice);
  if (!any_removal)
    return error(fmt::format(
        "{}: nothing was removed in this session; record one in which the burr cuts", file));
  const bool fluted = kind == tool::BurrKind::cutting;
  if (!any_power && !(fluted && law->friction > 0))
    return error(fmt::format(
        "{}: the cutting power is missing, and the session {}; record it again with this version "
        "of burr",
        file,
        fluted ? "does not state its coefficient of friction" : "was made with a diamond burr"));
  if (!any_power)
    log.notices.push_back(
        fmt::format("{}: the cutting power is missing; it is computed with the friction law of the "
                    "session (mu_c {:g})",
                    file, law->friction));
  if (removing > rows.size())
    log.notices.push_back(
        fmt::format("{}: {} windows in which the burr did not cut all the time are left out", file,
                    removing - rows.size()));
  for (Both& one : rows) {
    if (any_power) one.row.power = one.power;
    if (any_torque) one.row.tangential = one.torque_force;
    log.rows.push_back(one.row);
  }
  return log;
}

}  // namespace burr::fit
