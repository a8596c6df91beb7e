// burr devices - lists the haptic devices that burr can drive and their settings, and tries one.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "burr/base/new_file.h"
#include "burr/workshop/device_book.h"
#include "burr/workshop/hand_device.h"
#include "devices/springs_words.h"
#include "devices/trial.h"
#include "shared/front_words.h"
#include "shared/hand_options.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"
#include "shared/outputs.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

struct Options {
  workshop::HandRequest request;
  std::string out;
  std::vector<std::string> assignments;
  TrialSettings trial;
  bool json = false, yes = false;
};

// One possible device: opened and closed, described as JSON and as text.
Status tell(const workshop::HandKind& kind, const std::string& name,
            const workshop::DeviceBook& book, nlohmann::json& all, bool as_json) {
  workshop::HandRequest request;
  request.device = name;
  auto device = workshop::make_hand(request);
  if (!device) return device.error();
  const Status opened = (*device)->open();
  if (!opened) {
    all.push_back({{"name", name},
                   {"kind", kind.name},
                   {"there", false},
                   {"why", in_options(opened.error()).text}});
    if (!as_json)
      fmt::print("{:<16} {}\n                 not found: {}\n", name, kind.makes,
                 in_options(opened.error()).text);
    return fine();
  }
  const device::DeviceSpec spec = (*device)->spec();
  const std::string trouble = in_options((*device)->trouble());
  (*device)->close();
  const workshop::DevicePreferences preferences = book.of(workshop::id_of(spec));
  all.push_back({{"name", name},
                 {"kind", kind.name},
                 {"there", true},
                 {"id", workshop::id_of(spec)},
                 {"sensed", spec.sensed},
                 {"actuated", spec.actuated},
                 {"peak_force_N", spec.peak_force},
                 {"continuous_force_N", spec.continuous_force},
                 {"peak_torque_Nm", spec.peak_torque},
                 {"torque_felt", spec.peak_torque > 0},
                 {"stiffness_N_m", spec.max_stiffness},
                 {"damping_N_s_m", spec.max_damping},
                 {"workspace_mm", 1e3 * spec.workspace_radius},
                 {"rate_hz", spec.native_rate},
                 {"trouble", trouble},
                 {"scale", preferences.mapping.scale},
                 {"max_force_N", preferences.max_force_n}});
  if (as_json) return fine();
  fmt::print("{:<16} {}: senses {} axes, drives {}; {:.1f} N peak ({:.2f} N continuous){}\n", name,
             workshop::id_of(spec), spec.sensed, spec.actuated, spec.peak_force,
             spec.continuous_force,
             spec.peak_torque > 0 ? fmt::format(", {:g} N m", spec.peak_torque) : "");
  fmt::print(
      "                 stiffness up to {:.0f} N/m, damping up to {:g} N s/m, workspace {:.0f} mm "
      "about its middle, {:.0f} Hz; scale {:g}{}\n",
      spec.max_stiffness, spec.max_damping, 1e3 * spec.workspace_radius, spec.native_rate,
      preferences.mapping.scale,
      preferences.max_force_n > 0 ? fmt::format(", your limit {:g} N", preferences.max_force_n)
                                  : "");
  for (const std::string& sentence : springs_words(spec))
    fmt::print("                 {}\n", sentence);
  if (!trouble.empty()) fmt::print("                 {}\n", trouble);
  return fine();
}

// All devices that are there, by the name that a user types; nothing moves and no force is sent.
Status list(const Options& options) {
  nlohmann::json all = nlohmann::json::array();
  const workshop::DeviceBook book = workshop::DeviceBook::read(workshop::users_book());
  print_notices(book.troubles());
  if (!options.json)
    fmt::print("mouse, gamepad, pedal, SpaceMouse  in the window, without force\n");
  for (const workshop::HandKind& kind : workshop::hand_kinds()) {
    const workshop::NamesThere there = workshop::names_there(kind);
    const std::size_t before = all.size();
    for (const std::string& name : there.names) {
      const Status told = tell(kind, name, book, all, options.json);
      if (!told) return told;
    }
    const bool any = std::any_of(all.begin() + static_cast<std::ptrdiff_t>(before), all.end(),
                                 [](const nlohmann::json& one) { return one["there"] == true; });
    if (any && !there.note.empty() && !options.json)
      fmt::print("                 {}\n", there.note);
  }
  if (options.json) fmt::print("{}\n", json_line(all));
  return fine();
}

Result<std::unique_ptr<device::MappedHand>> take(const Options& options) {
  workshop::HandRequest request = options.request;
  request.scale = 1;  // tried without scaling
  auto laid = workshop::open_hand(request, {}, math::Quat::Identity());
  if (!laid) return laid.error();
  return std::move(laid->hand);
}

Status set(const Options& options) {
  auto device = workshop::make_hand(options.request);
  if (!device) return device.error();
  const Status opened = (*device)->open();
  if (!opened) return opened.error();
  const std::string id = workshop::id_of((*device)->spec());
  (*device)->close();
  workshop::DeviceBook book = workshop::DeviceBook::read(workshop::users_book());
  print_notices(book.troubles());
  for (const std::string& assignment : options.assignments) {
    const Status taken = book.set(id, assignment);
    if (!taken) return taken;
  }
  const Status kept = book.write(workshop::users_book());
  if (!kept) return kept;
  fmt::print("{}: saved in {}\n", id, workshop::users_book().string());
  return fine();
}

Status test(const Options& options) {
  if (const Status possible = check_outputs({}, {{"--out", options.out, {".html"}}}); !possible)
    return possible;
  auto hand = take(options);
  if (!hand) return hand.error();
  fmt::print(stderr, "{}: at most {:.1f} N. Ctrl-C ends the test and releases the force.\n",
             workshop::id_of((*hand)->spec()),
             std::min(options.trial.most_force, (*hand)->spec().peak_force));
  const TrialMeasurements seen = try_device(
      **hand, options.trial, [](const std::string& words) { fmt::print(stderr, "{}\n", words); },
      [] { return interrupted(); });
  (*hand)->close();
  if (options.json)
    fmt::print("{}\n", trial_json(seen));
  else
    fmt::print("{}", trial_text(seen));
  if (!options.out.empty()) {
    auto file = base::NewFile::create(options.out, base::kForAll);
    if (!file) return file.error();
    file->write(trial_page(seen));
    const Status put = file->put_in_place();
    if (!put) return put;
    fmt::print(stderr, "{}: the same result as a page\n", options.out);
  }
  if (seen.stopped) return error(Trouble::interrupted, "stopped; the results so far are above");
  if (!seen.left_out.empty())
    return error(Trouble::failed,
                 "not everything was tested; the lines above name what was left out");
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("devices", "list haptic devices, change their settings, test them");
  command->require_subcommand(0, 1);
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &todo, command] {
    if (command->get_subcommands().empty()) todo.work = [options] { return list(*options); };
  });

  auto* setting = command->add_subcommand(
      "set", "change the settings of a device; they are kept by its serial number");
  setting
      ->add_option("name", options->request.device,
                   workshop::kinds_known() + "; NAME:WHICH where there are several")
      ->required();
  setting->add_option("settings", options->assignments, "scale=0.5 max_force_n=2 dead_man=true ...")
      ->required();
  setting->callback([options, &todo] { todo.work = [options] { return set(*options); }; });

  auto* trial = command->add_subcommand("test",
                                        "test a device: first at rest, then a guided touch; "
                                        "measures rate, response, noise, axes and a wall");
  trial
      ->add_option("name", options->request.device,
                   workshop::kinds_known() + "; NAME:WHICH where there are several")
      ->required();
  add_homing_options(*trial, options->request);
  trial->add_option("--out", options->out, "F.html: write the result as a page");
  trial->add_option("--most-force", options->trial.most_force, "largest force of the wall [N]")
      ->check(CLI::Range(0.1, 5.0))
      ->capture_default_str();
  trial->add_option("--wait", options->trial.longest_s, "time limit of each step [s]")
      ->check(CLI::Range(0.5, 600.0))
      ->capture_default_str();
  trial->add_flag("--json", options->json, "one JSON object");
  trial->callback([options, &todo] { todo.work = [options] { return test(*options); }; });
}

const Command command{85, add};

}  // namespace
}  // namespace burr::app
