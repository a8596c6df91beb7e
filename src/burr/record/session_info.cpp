#include "burr/record/session_info.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "burr/record/grid_json.h"
#include "burr/record/private_text.h"
#include "burr/record/tool_json.h"
#include "burr/scenario/case.h"
#include "burr/volume/bone.h"

namespace burr::record {
namespace {

using nlohmann::json;

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

bool get_case(const json& object, CaseInfo& info, std::string& missing) {
  const auto wrong = [&missing](const char* field) {
    missing = std::string("case.") + field;
    return false;
  };
  if (!get_text(object, "name", info.name)) return wrong("name");
  if (!get_hash(object, "text_hash", info.text_hash)) return wrong("text_hash");
  if (!get_text(object, "text", info.text)) return wrong("text");
  const json& spare = part(object, "spare");
  if (!spare.is_array()) return wrong("spare");
  for (const json& name : spare) {
    if (!name.is_string()) return wrong("spare");
    info.spare.push_back(name.get<std::string>());
  }
  const json& targets = part(object, "targets");
  if (!targets.is_array()) return wrong("targets");
  for (const json& one : targets) {
    scenario::Target& target = info.targets.emplace_back();
    std::string goal;
    if (!one.is_object() || !get_text(one, "tissue", target.tissue) ||
        !get_text(one, "goal", goal) || !part(one, "share").is_number())
      return wrong("targets");
    target.share = one["share"].get<double>();
    using scenario::Goal;
    bool known = false;
    for (const Goal each : {Goal::open, Goal::expose, Goal::remove})
      if (goal == scenario::word_of(each)) {
        target.goal = each;
        known = true;
      }
    if (!known) return wrong("targets");
  }
  return true;
}

json json_from_case(const CaseInfo& info) {
  json targets = json::array();
  for (const scenario::Target& target : info.targets)
    targets.push_back({{"tissue", target.tissue},
                       {"goal", scenario::word_of(target.goal)},
                       {"share", target.share}});
  return {{"name", info.name},
          {"text_hash", hex(info.text_hash)},
          {"text", info.text},
          {"targets", std::move(targets)},
          {"spare", info.spare}};
}

json json_from_identity(const Identity& identity) {
  json object = {{"mode", word_of(identity.mode)},
                 {"attempt", identity.attempt},
                 {"case_hash", hex(identity.case_hash)},
                 {"rubric_hash", hex(identity.rubric_hash)},
                 {"labels_hash", hex(identity.labels_hash)}};
  if (!identity.learner.empty()) object["learner"] = identity.learner;
  if (!identity.accepted_labels.empty()) object["accepted_labels"] = identity.accepted_labels;
  return object;
}

bool get_identity(const json& object, Identity& identity, std::string& missing) {
  const auto wrong = [&missing](const char* field) {
    missing = std::string("identity.") + field;
    return false;
  };
  std::string mode;
  std::uint64_t attempt = 0;
  if (!get_text(object, "mode", mode) || !mode_of(mode)) return wrong("mode");
  identity.mode = *mode_of(mode);
  if (!get_count(object, "attempt", attempt) || attempt > UINT32_MAX) return wrong("attempt");
  identity.attempt = static_cast<std::uint32_t>(attempt);
  if (!get_hash(object, "case_hash", identity.case_hash)) return wrong("case_hash");
  if (!get_hash(object, "rubric_hash", identity.rubric_hash)) return wrong("rubric_hash");
  if (!get_hash(object, "labels_hash", identity.labels_hash)) return wrong("labels_hash");
  if (object.contains("learner") &&
      (!get_text(object, "learner", identity.learner) || !check_pseudonym(identity.learner)))
    return wrong("learner");
  if (const json& accepted = part(object, "accepted_labels"); !accepted.is_null()) {
    if (!accepted.is_array()) return wrong("accepted_labels");
    for (const json& name : accepted) {
      if (!name.is_string()) return wrong("accepted_labels");
      identity.accepted_labels.push_back(name.get<std::string>());
    }
  }
  return true;
}

bool get_seal(const json& object, StartSeal& seal) {
  std::uint64_t given = 0;
  if (!get_text(object, "station", seal.station) || !get_text(object, "nonce", seal.nonce) ||
      !get_count(object, "given_ms", given) || given > INT64_MAX ||
      !get_text(object, "signature", seal.signature))
    return false;
  seal.given_ms = static_cast<std::int64_t>(given);
  return true;
}

bool get_shaft(const json& object, Shaft& shaft) {
  const json &radius = part(object, "radius_m"), &length = part(object, "length_m");
  if (!radius.is_number() || !length.is_number()) return false;
  shaft = {radius.get<double>(), length.get<double>()};
  return shaft.radius >= 0 && shaft.radius < 0.1 && shaft.length >= 0 && shaft.length < 1;
}

bool get_second(const json& object, SecondInfo& second) {
  const json& tools = part(object, "tools");
  return object.is_object() && get_number_object(part(object, "numbers"), second.numbers) &&
         get_text(object, "device", second.device) && tools.is_array() && tools.size() <= 1 &&
         (tools.empty() || tools_from_json(tools.dump(), second.tools));
}

Status check_identity(const SessionInfo& info) {
  if (!info.identity) return fine();
  if (!info.identity->learner.empty())
    if (Status good = check_pseudonym(info.identity->learner); !good.ok()) return good;
  for (const std::string& name : info.identity->accepted_labels)
    if (!fit_for_a_note(name))
      return error(
          Trouble::usage,
          "`accepted_labels`: this name is too long or looks like a path, which must not be "
          "recorded; give the name of a structure of the case");
  const std::uint64_t hash = info.work_case ? info.work_case->text_hash : 0;
  if (info.identity->case_hash != hash)
    return error(Trouble::internal, "recording: the case's hash is not that of its text");
  return fine();
}

// As burr wrote it before 2026-11-25: the options of the command line, numbers and texts.
bool get_old_recipe(const json& volume, VolumeInfo& info, std::string& missing) {
  Numbers numbers;
  Words words;
  std::uint64_t reserve = 0;
  const auto wrong = [&missing](const char* field) {
    missing = std::string("volume.") + field;
    return false;
  };
  if (!get_count(volume, "reserve_bricks", reserve)) return wrong("reserve_bricks");
  if (!get_number_object(part(volume, "numbers"), numbers)) return wrong("numbers");
  if (!get_word_object(part(volume, "words"), words)) return wrong("words");
  scenario::BoneRecipe& recipe = info.recipe;
  recipe.margin = false;
  recipe.check_values = false;
  recipe.check_scan = false;
  recipe.bone_law = 1;
  info.format = words["format"];
  if (!words["phantom"].empty()) recipe.source = scenario::phantom_source(words["phantom"]);
  if (numbers.contains("voxel_mm")) recipe.voxel_mm = numbers["voxel_mm"];
  if (numbers.contains("smooth")) recipe.smooth = numbers["smooth"];
  if (numbers["memory_mb"] > 0) recipe.memory_mb = numbers["memory_mb"];
  recipe.reserve_bricks = static_cast<std::size_t>(reserve);
  if (const std::string& series = words["series"]; !series.empty())
    recipe.series = series.front() == '#' ? series : scenario::kOwn;
  if (!words["tissue_table"].empty()) recipe.labels = scenario::kOwn;
  if (!words["materials"].empty()) recipe.materials = scenario::kOwn;
  if (const std::string& text = words["iso"]; !text.empty()) {
    const auto level = scenario::parse_level(text);
    if (!level || !std::isfinite(*level)) return wrong("words.iso");
    recipe.iso = *level;
  }
  if (const std::string& text = words["roi"]; !text.empty()) {
    const auto region = scenario::parse_region(text);
    if (!region) return wrong("words.roi");
    recipe.region = *region;
  }
  if (const std::string& text = words["spacing_mm"]; !text.empty()) {
    const auto spacing = scenario::parse_spacing(text);
    if (!spacing) return wrong("words.spacing_mm");
    recipe.spacing_mm = *spacing;
  }
  return true;
}

bool get_recipe(const json& volume, VolumeInfo& info, const std::string& where,
                std::string& missing) {
  const json& object = part(volume, "recipe");
  if (object.is_null()) return get_old_recipe(volume, info, missing);
  missing = "volume.format";
  if (!get_text(volume, "format", info.format)) return false;
  auto recipe = scenario::recipe_from_json(object.dump(), where);
  missing = "volume.recipe";
  if (!recipe) return false;
  info.recipe = std::move(*recipe);
  return true;
}

bool finite(const volume::CuttingForce& force) {
  return std::isfinite(force.chip_tangential) && std::isfinite(force.chip_radial) &&
         std::isfinite(force.edge_tangential) && std::isfinite(force.edge_radial) &&
         std::isfinite(force.edge_onset);
}

}  // namespace

std::string hex(std::uint64_t value) { return fmt::format("0x{:016x}", value); }

CaseInfo case_info(const scenario::Case& work) {
  return {looks_private(work.name) ? "own" : work.name, scenario::text_hash(work.text), work.text,
          work.targets, work.spare};
}

Result<scenario::Case> case_of(const CaseInfo& info) {
  return scenario::parse_case(info.text, info.name + ".toml");
}

Result<scenario::Case> case_of(const SessionInfo& info) {
  auto read = case_of(*info.work_case);
  if (!read) return read.error();
  const std::string was = scenario::phantom_name(info.volume.recipe.source);
  if (!read->phantom.empty() &&
      scenario::without_variant(was) == scenario::without_variant(read->phantom))
    read->phantom = was;
  return read;
}

bool CaseInfo::unchanged() const {
  if (text_hash != scenario::text_hash(text)) return false;
  const auto read = case_of(*this);
  return read && read->spare == spare &&
         std::equal(targets.begin(), targets.end(), read->targets.begin(), read->targets.end(),
                    [](const scenario::Target& a, const scenario::Target& b) {
                      return a.tissue == b.tissue && a.goal == b.goal && a.share == b.share;
                    });
}

VolumeInfo volume_info(const volume::Bone& bone) {
  VolumeInfo info;
  info.content_hash = bone.content_hash();
  info.grid = bone.grid();
  info.tissues = bone.tissues();
  info.has_intensity = bone.has_intensity();
  info.recipe.reserve_bricks = bone.free_slots();
  return info;
}

Status check(const SessionInfo& info) {
  if (!(info.rate_hz > 0) || !std::isfinite(info.rate_hz))
    return error(Trouble::internal, "recording: the rate must be a positive number of ticks per s");
  if (Status good = check_fields(info.numbers, info.words); !good.ok()) return good;
  if (info.second)
    if (Status good = check_fields(info.second->numbers, {{"device", info.second->device}});
        !good.ok())
      return good;
  const scenario::BoneRecipe& recipe = info.volume.recipe;
  if (Status good = check_fields({{"voxel_mm", recipe.voxel_mm},
                                  {"iso", recipe.iso.value_or(0)},
                                  {"smooth", recipe.smooth},
                                  {"memory_mb", recipe.memory_mb},
                                  {"spacing_mm", recipe.spacing_mm.sum()}},
                                 {{"format", info.volume.format},
                                  {"source", recipe.source},
                                  {"series", recipe.series},
                                  {"tissues", recipe.labels},
                                  {"materials", recipe.materials}});
      !good.ok())
    return good;
  if (Status good = check_identity(info); !good.ok()) return good;
  if (info.work_case) {
    const auto read = case_of(*info.work_case);
    if (!read) return read.error();
    if (looks_private(info.work_case->name) || !scenario::names_no_file(*read))
      return error(Trouble::internal,
                   "recording: the case holds a path, which must not be recorded");
  }
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
                 {"format", info.volume.format},
                 {"recipe", json::parse(scenario::to_json(info.volume.recipe))}};
  json session = {{"burr_version", info.burr_version},
                  {"build", info.build},
                  {"rate_hz", info.rate_hz},
                  {"seed", hex(info.seed)},
                  {"numbers", number_object(info.numbers)},
                  {"words", info.words},
                  {"volume", std::move(volume)},
                  {"embedded", info.embedded}};
  if (info.work_case) session["case"] = json_from_case(*info.work_case);
  if (info.identity) session["identity"] = json_from_identity(*info.identity);
  if (info.shaft)
    session["shaft"] = {{"radius_m", info.shaft->radius}, {"length_m", info.shaft->length}};
  if (!info.tools.empty()) session["tools"] = json::parse(tools_to_json(info.tools));
  if (info.second)
    session["second"] = {{"numbers", number_object(info.second->numbers)},
                         {"device", info.second->device},
                         {"tools", json::parse(tools_to_json(info.second->tools))}};
  if (info.seal)
    session["seal"] = {{"station", info.seal->station},
                       {"nonce", info.seal->nonce},
                       {"given_ms", info.seal->given_ms},
                       {"signature", info.seal->signature}};
  if (info.first_tick > 0)
    session["continued"] = {{"first_tick", info.first_tick}, {"goes_on_with", info.goes_on_with}};
  // names of tissues come from the user's file and may hold anything; broken UTF-8 is replaced
  return session.dump(1, ' ', false, json::error_handler_t::replace);
}

Result<SessionInfo> session_from_json(std::string_view text, const std::string& where) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object())
    return error(where + ": the session's description is not JSON; the recording is damaged");
  SessionInfo info;
  const auto missing = [&](const char* field) {
    return error(
        fmt::format("{}: session field \"{}\" is missing or has the wrong type; the recording is "
                    "damaged or newer than this burr",
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

  if (const json& work = part(object, "case"); !work.is_null()) {
    std::string field;
    if (!get_case(work, info.work_case.emplace(), field)) return missing(field.c_str());
  }
  if (const json& who = part(object, "identity"); !who.is_null()) {
    std::string field;
    if (!get_identity(who, info.identity.emplace(), field)) return missing(field.c_str());
  }
  if (const json& shaft = part(object, "shaft"); !shaft.is_null())
    if (!get_shaft(shaft, info.shaft.emplace())) return missing("shaft");
  if (const json& tools = part(object, "tools"); !tools.is_null())
    if (!tools_from_json(tools.dump(), info.tools)) return missing("tools");
  if (const json& second = part(object, "second"); !second.is_null())
    if (!get_second(second, info.second.emplace())) return missing("second");
  if (const json& seal = part(object, "seal"); !seal.is_null())
    if (!get_seal(seal, info.seal.emplace())) return missing("seal");
  if (const json& part_of = part(object, "continued"); !part_of.is_null())
    if (!get_count(part_of, "first_tick", info.first_tick) ||
        !get_text(part_of, "goes_on_with", info.goes_on_with))
      return missing("continued");
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
  std::string field;
  if (!get_recipe(volume, info.volume, where, field)) return missing(field.c_str());
  return info;
}

}  // namespace burr::record
