#include "burr/record/session_info.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "burr/record/grid_json.h"

namespace burr::record {
namespace {

using nlohmann::json;

// A text with a separator is a path; one of digits with three dots or more is a UID.
bool looks_private(const std::string& text) {
  if (text.find('/') != std::string::npos || text.find('\\') != std::string::npos) return true;
  return std::count(text.begin(), text.end(), '.') >= 3 &&
         text.find_first_not_of("0123456789.") == std::string::npos;
}

Status check_fields(const Numbers& numbers, const Words& words) {
  for (const auto& [name, value] : numbers)
    if (!std::isfinite(value))
      return error(Trouble::internal,
                   fmt::format("recording: the setting \"{}\" is not a finite number", name));
  for (const auto& [name, value] : words)
    if (looks_private(name) || looks_private(value))
      return error(Trouble::internal,
                   fmt::format("recording: the setting \"{}\" looks like a path or a UID, which "
                               "must not be recorded; store a hash of it",
                               name));
  return fine();
}

json number_object(const Numbers& numbers) {
  json object = json::object();
  for (const auto& [name, value] : numbers) object[name] = value;
  return object;
}

bool get_number_object(const json& object, Numbers& numbers) {
  if (!object.is_object()) return false;
  for (const auto& [name, value] : object.items()) {
    if (!value.is_number()) return false;
    numbers[name] = value.get<double>();
  }
  return true;
}

bool get_word_object(const json& object, Words& words) {
  if (!object.is_object()) return false;
  for (const auto& [name, value] : object.items()) {
    if (!value.is_string()) return false;
    words[name] = value.get<std::string>();
  }
  return true;
}

bool get_text(const json& object, const char* name, std::string& text) {
  const auto at = object.find(name);
  if (at == object.end() || !at->is_string()) return false;
  text = at->get<std::string>();
  return true;
}

bool get_hash(const json& object, const char* name, std::uint64_t& hash) {
  std::string text;
  if (!get_text(object, name, text) || text.substr(0, 2) != "0x") return false;
  const auto done = std::from_chars(text.data() + 2, text.data() + text.size(), hash, 16);
  return done.ec == std::errc() && done.ptr == text.data() + text.size();
}

bool get_count(const json& object, const char* name, std::uint64_t& count) {
  const auto at = object.find(name);
  if (at == object.end() || !at->is_number_unsigned()) return false;
  count = at->get<std::uint64_t>();
  return true;
}

bool get_flag(const json& object, const char* name, bool& flag) {
  const auto at = object.find(name);
  if (at == object.end() || !at->is_boolean()) return false;
  flag = at->get<bool>();
  return true;
}

const json& part(const json& object, const char* name) {
  static const json nothing;
  const auto at = object.find(name);
  return at == object.end() ? nothing : *at;
}

bool finite(const volume::CuttingForce& force) {
  return std::isfinite(force.chip_tangential) && std::isfinite(force.chip_radial) &&
         std::isfinite(force.edge_tangential) && std::isfinite(force.edge_radial) &&
         std::isfinite(force.edge_onset);
}

}  // namespace

std::string hex(std::uint64_t value) { return fmt::format("0x{:016x}", value); }

Status check(const SessionInfo& info) {
  if (!(info.rate_hz > 0) || !std::isfinite(info.rate_hz))
    return error(Trouble::internal, "recording: the rate must be a positive number of ticks per s");
  if (Status good = check_fields(info.numbers, info.words); !good.ok()) return good;
  if (Status good = check_fields(info.volume.numbers, info.volume.words); !good.ok()) return good;
  for (const volume::Tissue& tissue : info.volume.tissues.tissues)
    if (!std::isfinite(tissue.cutting_energy) || !std::isfinite(tissue.friction) ||
        !std::isfinite(tissue.cutting_friction) || !std::isfinite(tissue.bleeds) ||
        !finite(tissue.force))
      return error(
          Trouble::internal,
          fmt::format("recording: the tissue \"{}\" has a cutting energy, force, friction or "
                      "bleeding that is not a finite number",
                      tissue.name));
  return fine();
}

std::string to_json(const SessionInfo& info) {
  json volume = {{"content_hash", hex(info.volume.content_hash)},
                 {"source_fingerprint", hex(info.volume.source_fingerprint)},
                 {"grid", json_from_grid(info.volume.grid)},
                 {"tissues", json_from_tissues(info.volume.tissues)},
                 {"has_intensity", info.volume.has_intensity},
                 {"reserve_bricks", info.volume.reserve_bricks},
                 {"numbers", number_object(info.volume.numbers)},
                 {"words", info.volume.words}};
  const json session = {{"burr_version", info.burr_version},
                        {"build", info.build},
                        {"rate_hz", info.rate_hz},
                        {"seed", hex(info.seed)},
                        {"numbers", number_object(info.numbers)},
                        {"words", info.words},
                        {"volume", std::move(volume)},
                        {"embedded", info.embedded}};
  // tissue names come from the user's file and may contain anything; invalid UTF-8 is replaced
  return session.dump(1, ' ', false, json::error_handler_t::replace);
}

Result<SessionInfo> session_from_json(std::string_view text, const std::string& where) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object())
    return error(where + ": the session's description is not JSON; the recording is damaged");
  SessionInfo info;
  const auto missing = [&](const char* field) {
    return error(
        fmt::format("{}: session field \"{}\" is missing or of the wrong kind; the "
                    "recording is damaged or newer than this burr",
                    where, field));
  };
  if (!get_text(object, "burr_version", info.burr_version)) return missing("burr_version");
  if (!get_text(object, "build", info.build)) return missing("build");
  const json& rate = part(object, "rate_hz");
  if (!rate.is_number()) return missing("rate_hz");
  info.rate_hz = rate.get<double>();
  if (!(info.rate_hz >= 1e-3 && info.rate_hz <= 1e9)) return missing("rate_hz");
  if (!get_hash(object, "seed", info.seed)) return missing("seed");
  if (!get_number_object(part(object, "numbers"), info.numbers)) return missing("numbers");
  if (!get_word_object(part(object, "words"), info.words)) return missing("words");
  if (!get_flag(object, "embedded", info.embedded)) return missing("embedded");

  const json& volume = part(object, "volume");
  if (!volume.is_object()) return missing("volume");
  if (!get_hash(volume, "content_hash", info.volume.content_hash))
    return missing("volume.content_hash");
  if (!get_hash(volume, "source_fingerprint", info.volume.source_fingerprint))
    return missing("volume.source_fingerprint");
  if (!grid_from_json(part(volume, "grid"), info.volume.grid)) return missing("volume.grid");
  if (!tissues_from_json(part(volume, "tissues"), info.volume.tissues))
    return missing("volume.tissues");
  if (!get_flag(volume, "has_intensity", info.volume.has_intensity))
    return missing("volume.has_intensity");
  if (!get_count(volume, "reserve_bricks", info.volume.reserve_bricks))
    return missing("volume.reserve_bricks");
  if (!get_number_object(part(volume, "numbers"), info.volume.numbers))
    return missing("volume.numbers");
  if (!get_word_object(part(volume, "words"), info.volume.words)) return missing("volume.words");
  return info;
}

}  // namespace burr::record
