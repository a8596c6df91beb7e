#include "burr/device/haply/message.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "burr/device/haply/pipeline.h"

namespace burr::device::haply {
namespace {

using math::Quat;
using math::Vec3;
using nlohmann::json;

const json* at(const json& in, const char* key) {
  if (!in.is_object()) return nullptr;
  const auto found = in.find(key);
  return found != in.end() ? &*found : nullptr;
}

std::string text_at(const json& in, const char* key) {
  const json* value = at(in, key);
  return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

// False only if the value is there but is not a finite number.
bool take(const json& in, const char* key, double& number) {
  const json* value = at(in, key);
  if (value == nullptr) return true;
  if (!value->is_number()) return false;
  const double is = value->get<double>();
  if (!std::isfinite(is)) return false;
  number = is;
  return true;
}

bool take(const json& in, const char* key, bool& yes) {
  const json* value = at(in, key);
  if (value == nullptr) return true;
  if (!value->is_boolean()) return false;
  yes = value->get<bool>();
  return true;
}

bool take(const json& in, const char* key, Vec3& vector) {
  const json* value = at(in, key);
  if (value == nullptr) return true;
  return value->is_object() && take(*value, "x", vector.x()) && take(*value, "y", vector.y()) &&
         take(*value, "z", vector.z());
}

bool take(const json& in, const char* key, Quat& turn) {
  const json* value = at(in, key);
  if (value == nullptr) return true;
  Quat is = turn;
  if (!value->is_object() || !take(*value, "w", is.w()) || !take(*value, "x", is.x()) ||
      !take(*value, "y", is.y()) || !take(*value, "z", is.z()))
    return false;
  if (!(is.norm() > 0.5 && is.norm() < 2)) return false;
  turn = is.normalized();
  return true;
}

bool take_buttons(const json& state, unsigned& buttons) {
  const json* value = at(state, "buttons");
  if (value == nullptr) return true;
  if (!value->is_object()) return false;
  // "a", "b", "c" in the maker's pages; "button_0" ... in other clients
  static constexpr const char* kNames[][2] = {
      {"a", "button_0"}, {"b", "button_1"}, {"c", "button_2"}};
  for (unsigned n = 0; n < std::size(kNames); ++n)
    for (const char* name : kNames[n]) {
      bool down = (buttons >> n & 1U) != 0;
      if (!take(*value, name, down)) return false;
      buttons = down ? buttons | 1U << n : buttons & ~(1U << n);
    }
  return true;
}

const json* entry_of(const json& all, const std::string& id) {
  const json* arms = at(all, "inverse3");
  if (arms == nullptr || !arms->is_array()) return nullptr;
  for (const json& arm : *arms)
    if (text_at(arm, "device_id") == id) return &arm;
  return nullptr;
}

constexpr const char* kGrips[] = {"verse_grip", "wireless_verse_grip", "custom_verse_grip"};

// told: set to true if the message contains any grips.
const json* grip_of(const json& all, const std::string& wanted, bool& told) {
  const json* away = nullptr;
  for (const char* kind : kGrips) {
    const json* grips = at(all, kind);
    if (grips == nullptr || !grips->is_array()) continue;
    told = true;
    for (const json& grip : *grips) {
      if (!wanted.empty() && text_at(grip, "device_id") != wanted) continue;
      const json* status = at(grip, "status");
      bool connected = true;
      if (status == nullptr || !take(*status, "connected", connected) || connected) return &grip;
      if (away == nullptr) away = &grip;
    }
  }
  return away;
}

bool take_grip(const json& grip, State& state) {
  state.grip_there = true;
  state.grip_id = text_at(grip, "device_id");
  if (const json* now = at(grip, "state"))
    if (!take(*now, "orientation", state.grip) || !take_buttons(*now, state.buttons) ||
        !take(*now, "battery_level", state.battery))
      return false;
  const json* status = at(grip, "status");
  bool connected = true;
  if (status != nullptr &&
      (!take(*status, "connected", connected) || !take(*status, "awake", state.grip_awake)))
    return false;
  if (!connected) state.grip_there = false;
  if (!state.grip_there) state.buttons = 0;
  return true;
}

}  // namespace

bool read_found(std::string_view text, std::vector<Found>& found) {
  const json all = json::parse(text, nullptr, false);
  if (!all.is_object()) return false;
  found.clear();
  const json* arms = at(all, "inverse3");
  if (arms == nullptr) return at(all, "session_id") != nullptr;
  if (!arms->is_array()) return false;
  for (const json& arm : *arms) {
    Found one;
    one.id = text_at(arm, "device_id");
    if (one.id.empty()) continue;
    one.type = "inverse3";
    if (const json* config = at(arm, "config")) {
      if (std::string type = text_at(*config, "type"); !type.empty()) one.type = type;
      one.left_handed = text_at(*config, "handedness") == "left";
      if (const json* info = at(*config, "device_info")) {
        double major = -1, minor = 0;
        if (take(*info, "major_version", major) && take(*info, "minor_version", minor) &&
            major >= 0)
          one.firmware = fmt::format("{:.0f}.{:.0f}", major, minor);
      }
    }
    found.push_back(std::move(one));
  }
  return true;
}

std::vector<std::string> grips_in(std::string_view text) {
  std::vector<std::string> ids;
  const json all = json::parse(text, nullptr, false);
  for (const char* kind : kGrips)
    if (const json* grips = at(all, kind); grips != nullptr && grips->is_array())
      for (const json& grip : *grips)
        if (std::string id = text_at(grip, "device_id"); !id.empty()) ids.push_back(std::move(id));
  return ids;
}

Read read_state(std::string_view text, const std::string& id, const std::string& grip,
                State& known) {
  const json all = json::parse(text, nullptr, false);
  if (!all.is_object()) return Read::nonsense;
  const json* arms = at(all, "inverse3");
  if (arms != nullptr && !arms->is_array()) return Read::nonsense;
  const json* arm = entry_of(all, id);
  if (arm == nullptr) return Read::gone;
  State state = known;
  if (const json* now = at(*arm, "state"))
    if (!take(*now, "cursor_position", state.place) ||
        !take(*now, "cursor_velocity", state.velocity) ||
        !take(*now, "current_cursor_force", state.force))
      return Read::nonsense;
  if (const json* status = at(*arm, "status"))
    if (!take(*status, "calibrated", state.calibrated) || !take(*status, "ready", state.ready) ||
        !take(*status, "power_supply", state.powered) || !take(*status, "in_use", state.in_use))
      return Read::nonsense;
  bool told = false;
  if (const json* held = grip_of(all, grip, told)) {
    if (!take_grip(*held, state)) return Read::nonsense;
  } else if (told) {  // it was there and is no longer: none of its buttons stays pressed
    state.grip_there = false;
    state.buttons = 0;
  }
  known = std::move(state);
  return Read::state;
}

bool read_event(std::string_view text, Event& event) {
  static constexpr std::pair<const char*, EventKind> kNames[] = {
      {"device-connected", EventKind::connected},
      {"device-disconnected", EventKind::disconnected},
      {"device-battery-low", EventKind::battery_low},
      {"device-battery-critical", EventKind::battery_critical},
      {"device-sleep", EventKind::sleeps},
      {"device-busy", EventKind::busy},
      {"device-connection-loop", EventKind::connection_loop},
      {"device-calibration-failed", EventKind::calibration_failed},
  };
  static constexpr std::pair<const char*, EventKind> kSafety[] = {
      {"ebrake_triggered", EventKind::brake},     {"ebrake_released", EventKind::brake_released},
      {"fod_stage_changed", EventKind::stage},    {"stall_detected", EventKind::stalled},
      {"stability_ceiling", EventKind::unstable},
  };
  const json all = json::parse(text, nullptr, false);
  const std::string name = text_at(all, "name"), level = text_at(all, "level");
  if (name.empty()) return false;
  event = {};
  if (level == "critical" || level == "panic") event.what = EventKind::trouble;
  const json* data = at(all, "data");
  if (data != nullptr) event.device = text_at(*data, "device_id");
  for (const auto& [known, what] : kNames)
    if (name == known) event.what = what;
  if (name == "device-safety-triggered" && data != nullptr) {
    const std::string type = text_at(*data, "safety_type");
    for (const auto& [known, what] : kSafety)
      if (type == known) event.what = what;
  }
  return true;
}

int read_version(std::string_view text) {
  const json all = json::parse(text, nullptr, false);
  if (!all.is_object()) return 0;
  const json* data = at(all, "data");
  for (const json* in : {&all, data})
    for (const char* key : {"project_version", "git_tag", "version"}) {
      if (in == nullptr) continue;
      std::string said = text_at(*in, key);
      if (!said.empty() && said[0] == 'v') said.erase(0, 1);
      unsigned major = 0, minor = 0;
      if (std::sscanf(said.c_str(), "%3u.%3u", &major, &minor) == 2)
        return static_cast<int>(100 * major + minor);
    }
  return 0;
}

std::string as_json(const std::string& id) {
  return json(id).dump(-1, ' ', false, json::error_handler_t::replace);
}

void write_force(const std::string& json_id, const char* key, const Vec3& force,
                 std::string& text) {
  text.clear();
  fmt::format_to(std::back_inserter(text),
                 R"({{"inverse3":[{{"device_id":{},"commands":{{"set_cursor_force":)"
                 R"({{"{}":{{"x":{:.5f},"y":{:.5f},"z":{:.5f}}}}}}}}}]}})",
                 json_id, key, force.x(), force.y(), force.z());
}

std::string greeting(const std::string& json_id, const char* key, bool configure) {
  return fmt::format(
      R"({{"session":{{"configure":{{"profile":{{"name":"org.burr:milling"}}{}}},"force_render_full_state":{{}}}},)"
      R"("inverse3":[{{"device_id":{},{}"commands":{{"set_cursor_force":{{"{}":{{"x":0,"y":0,"z":0}}}}}}}}]}})",
      configure ? "," + ask_of_session() : "", json_id,
      configure ? fmt::format(R"("configure":{{{}}},)", ask_of_arm()) : "", key);
}

}  // namespace burr::device::haply
