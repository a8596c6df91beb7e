// `burr station`: the stations whose seals a centre's store believes: enrol, list, revoke.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "burr/base/places.h"
#include "burr/base/printable.h"
#include "burr/school/enrolled.h"
#include "burr/school/signing_key.h"
#include "school/learner_store.h"
#include "school/store_command.h"
#include "shared/key_file.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

using Json = nlohmann::ordered_json;

struct StationOptions {
  std::string store, name;
  bool decides = false, json = false;
};

// The key of this user, made where there is none.
Result<school::SigningKey> key_for(const std::string& file, const std::string& name) {
  if (file.empty())
    return error(Trouble::usage, "no folder for the key; set HOME or XDG_DATA_HOME");
  std::error_code nobody_asks;
  if (!std::filesystem::exists(file, nobody_asks)) return school::SigningKey::make(file, name);
  auto key = school::SigningKey::read(file);
  if (key && key->name() != name)
    return error(
        Trouble::usage,
        fmt::format("{}: this key is of {}, not of {}; enrol it under its name, or move the "
                    "file away",
                    base::printable(file), key->name(), base::printable(name)));
  return key;
}

Status run_enrol(const StationOptions& options) {
  if (const Status good = school::check_key_name(options.name); !good) return good;
  auto store = store_that_is_there(options.store);
  if (!store) return store.error();
  const std::string file =
      key_file(users_places(), options.decides ? KeyOf::decider : KeyOf::station);
  const auto key = key_for(file, options.name);
  if (!key) return key.error();
  const std::string kind = options.decides ? "decider" : "station";
  if (const Status done = school::enrol(**store, {options.name, key->public_key(), kind}); !done)
    return done;
  fmt::print("{} {} is enrolled; its key is in {}, for you alone: it never leaves this computer\n",
             kind, options.name, base::printable(file, 300));
  print_json(options.json,
             {{"name", options.name}, {"kind", kind}, {"public_key", key->public_key()}});
  return fine();
}

Status run_list(const StationOptions& options) {
  auto store = store_that_is_there(options.store);
  if (!store) return store.error();
  const auto all = school::enrolled(**store);
  if (!all) return all.error();
  Json rows = Json::array();
  for (const school::Enrolled& one : *all) {
    fmt::print("{:<24}{:<10}enrolled {} by {}{}\n", one.name, one.kind, day_of(one.enrolled_ms),
               base::printable(one.enrolled_by),
               one.revoked_ms ? fmt::format(", revoked {} by {}", day_of(*one.revoked_ms),
                                            base::printable(one.revoked_by))
                              : "");
    rows.push_back({{"name", one.name},
                    {"kind", one.kind},
                    {"public_key", one.key},
                    {"enrolled_ms", one.enrolled_ms},
                    {"enrolled_by", one.enrolled_by},
                    {"revoked_ms", one.revoked_ms ? Json(*one.revoked_ms) : Json(nullptr)}});
  }
  if (all->empty()) fmt::print("no station is enrolled, so no session of this store is sealed\n");
  print_json(options.json, {{"enrolled", rows}});
  return fine();
}

Status run_revoke(const StationOptions& options) {
  auto store = store_that_is_there(options.store);
  if (!store) return store.error();
  if (const Status done = school::revoke(**store, options.name); !done) return done;
  fmt::print("{} is revoked; what it sealed before stays sealed\n", base::printable(options.name));
  print_json(options.json, {{"revoked", options.name}});
  return fine();
}

CLI::App* sub(CLI::App& command, const char* name, const char* says,
              const std::shared_ptr<StationOptions>& options, Todo& todo,
              Status (*run)(const StationOptions&)) {
  auto* made = store_command<StationOptions>(command, name, says, options, todo, run);
  made->add_flag("--json", options->json, "print a JSON object as the last line");
  return made;
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand("station", "stations whose seals a centre's store believes");
  command->require_subcommand(1);
  auto options = std::make_shared<StationOptions>();
  auto* enrol = sub(*command, "enrol", "make this computer's key, and let the store know it",
                    options, todo, run_enrol);
  enrol->add_option("name", options->name, "of the station, for example station-3")->required();
  enrol->add_flag("--decides", options->decides,
                  "a key of yours for `burr learner decide`, in place of the station's");
  options = std::make_shared<StationOptions>();
  sub(*command, "list", "what is enrolled, and what is revoked", options, todo, run_list);
  options = std::make_shared<StationOptions>();
  auto* gone =
      sub(*command, "revoke", "believe no new seal of a station", options, todo, run_revoke);
  gone->add_option("name", options->name, "of the station")->required();
}

const Command command{70, add};

}  // namespace
}  // namespace burr::app
