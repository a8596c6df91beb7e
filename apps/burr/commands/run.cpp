// `burr run`: the simulator in a window; or, without a display, a session that mills by itself and
// writes pictures, a recording and a page of figures.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "burr/lrs/launch.h"
#include "burr/net/guard.h"
#include "burr/record/diary.h"
#include "burr/render/picture.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/spared.h"
#include "burr/workshop/tool_looks.h"
#include "burr/workshop/work_view.h"
#include "commands/run_folder.h"
#include "commands/run_headless.h"
#include "commands/summary.h"
#include "school/xapi.h"
#include "shared/bone_option.h"
#include "shared/front_words.h"
#include "shared/hand_options.h"
#include "shared/identity_options.h"
#include "shared/interrupt.h"
#include "shared/law_options.h"
#include "shared/outputs.h"
#include "shared/recorded_session.h"
#include "shared/setting_options.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"
#include "shared/window_session.h"
#include "shared/word_names.h"
#include "shared/work.h"
#include "window/mill/window.h"
#include "window/review/enter_session.h"
#include "window/review/review.h"
#include "window/shell/pages.h"
#include "window/shell/review_session.h"
#include "window/station/station_link.h"
#include "window/ui/loading.h"

namespace burr::app {
namespace {

using Options = RunOptions;
using run_folder::kHeight;
using run_folder::kWidth;

// True: there is a display on which SDL could open a window.
bool display_there() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(name); value != nullptr && *value != '\0') return true;
  return false;
}

// What a session in the window leaves in the folder that the user named.
Status write_session(const Options& options, const WindowSession& ready,
                     const render::Scene& before, const Status& recorded) {
  const std::filesystem::path folder = options.out;
  sim::Session& session = *ready.session;
  Summary summary = summary_of_run(session, ready.what, session.hand().spec().name);
  if (ready.work_case) summary.task = scenario::task_text(*ready.work_case);
  if (!recorded) fmt::print("{}", summary_text(summary));  // the page may not fit on the disk
  render::Scene after = ready.scene;
  after.burr.visible = false;
  after.markers.clear();
  after.rods.clear();
  for (const auto& [name, one] : {std::pair{"before", &before}, {"after", &std::as_const(after)}}) {
    render::Scene picture = *one;
    picture.look = render::still_look();
    picture.camera = before.camera;
    picture.scale_bar = true;
    const std::string file = std::string(name) + ".png";
    const Status drawn = render::render_png(picture, kWidth, kHeight, folder / file);
    if (!drawn) return recorded ? drawn : recorded;
    summary.pictures.emplace_back(file, name);
  }
  if (recorded) summary.recording = "session.mcap";
  const Status written = write_summary(summary, folder);
  if (!recorded) return recorded;
  if (!written) return written;
  fmt::print("{}{}: before.png after.png session.mcap summary.html\n", summary_text(summary),
             folder.string());
  return fine();
}

// A session whose recording, pictures and figures go into the folder that the user named.
Result<Closed> mill_into_folder(Desk& desk, WindowSession& ready, const Options& options,
                                const WindowOptions& window) {
  const std::string file = (std::filesystem::path(options.out) / "session.mcap").string();
  sim::Session& session = *ready.session;
  const render::Scene before = ready.scene;
  Recording recording;
  recording.remember_scan_in(scan_list_by(desk.settings, desk.places().state));
  recording.belongs_to(options.work.identity);
  const scenario::Case* work = ready.work_case ? &*ready.work_case : nullptr;
  const auto sealer = sealer_for(desk, options.work.identity, work);
  recording.sealed_by(sealer);
  const Status begun =
      recording.start(session, file, ready.volume, ready.import, session.hand().spec().name, false,
                      ready.spared, ready.work_case);
  if (!begun) return begun.error();
  session_begins(desk, file, options.work.identity, work);
  WindowOptions with_recording = window;
  with_recording.warning = [&recording] { return recording.trouble(); };
  with_recording.keep = [] { return true; };  // this run is recorded already
  with_recording.left_as = [&recording] {
    return recording.trouble().empty() ? Word::leave_told_folder : Word::leave_told_lost;
  };
  with_recording.diary = recording.diary();
  with_recording.done_ends = ready.work_case && has_marks(*ready.work_case);
  with_recording.film_of = [&]() -> std::optional<FilmSource> {
    FilmSource source = film_of(session, file, ready.volume);
    source.effects = desk.settings.effects;
    return source;
  };
  const auto left = mill_with_sound(desk, ready, with_recording);
  const bool done = left && *left == Closed::done;
  Result<bool> stays = true;
  if (done) stays = ask_own_marks(desk, ready, *with_recording.diary, window);
  const Status recorded = recording.finish(session);
  tell_of_seal(desk, sealer);
  if (!left) return left.error();
  // one that ended early, on a full disk, counts with what it holds
  std::error_code nobody_asks;
  session_ended(desk, file, options.work.identity, work,
                std::filesystem::exists(file, nobody_asks));
  const Status written = write_session(options, ready, before, recorded);
  if (!written) return written.error();
  if (!stays) return stays.error();
  if (!done || !*stays) return *left;
  return review_session(desk, {.file = file,
                               .title = title_of(ready),
                               .rubric = rubric_for(*ready.work_case),
                               .volume = ready.volume,
                               .marks = ready.allowed.marks,
                               .seconds = window.seconds,
                               .folder = window.folder,
                               .screenshot = window.screenshot});
}

// One session of a person on the case or scan that was named. Closed::again: and one more.
Result<Closed> session_in_window(Desk& desk, const Options& options) {
  WorkOptions work = options.work;
  if (const Status taken = take_case(work); !taken) return taken.error();
  if (desk.settings.shaft_touches) work.touch = haptics::Method::shaft;
  if (work.work_case) fmt::print(stderr, "{}", scenario::task_text(*work.work_case));
  bool closed = false;
  auto loaded = load<WindowSession>(
      desk, say(Word::loading, work.title.empty() ? word(Word::start_scan) : work.title),
      [work](Progress& seen) { return open_ready(work, seen); }, closed);
  if (closed) return Closed::window;
  if (!loaded) return loaded.error();
  print_notices(loaded->import.notices);
  const WindowOptions window = {.seconds = options.seconds,
                                .folder = options.out,
                                .screenshot = options.screenshot,
                                .sound = !options.no_sound};
  return options.out.empty() ? mill_and_keep(desk, *loaded, options.work, nullptr, window)
                             : mill_into_folder(desk, *loaded, options, window);
}

// With --live: this station appears on the instructor's page.
Status show_to_instructor(Desk& desk, const Options& options) {
  if (options.live.empty()) return fine();
  auto token = net::token_from(options.live_token);
  if (!token) return token.error();
  std::string name = options.station;
  if (name.empty()) {
    std::array<char, 256> host = {};
    name = ::gethostname(host.data(), host.size() - 1) == 0 ? host.data() : "burr";
  }
  auto link = StationLink::open({options.live, *token, name});
  if (!link) return link.error();
  desk.station = std::move(*link);
  desk.station_learner = options.work.identity.learner;
  return fine();
}

// What burr reports about the sessions of this run to a learning management system.
struct RunReport {
  double seconds = 0;
  bool done = false;  // of one of them
};

// Runs `work` between what cmi5 wants first and last. A run that failed was not completed.
template <class Work>
Status launched(const Options& options, RunReport& report, Work work) {
  if (options.cmi5.empty()) return work();
  if (options.work.volume.source.empty())
    return error(Trouble::usage, "--cmi5: name the case too, for example: burr run temporal-bone");
  tell_waiting_launches();
  auto launch = lrs::Launch::begin(options.cmi5);
  if (!launch) return launch.error();
  const Status worked = work();
  const auto ended = (*launch)->end(report.seconds, worked.ok() && report.done, launches_folder());
  if (ended && !ended->empty()) fmt::print(stderr, "{}\n", *ended);
  return worked && !ended ? Status(ended.error()) : worked;
}

// The start page, or sessions on what was named.
Status run_in_window(Options options, RunReport& report) {
  const std::filesystem::path folder = options.out;
  if (!folder.empty()) {
    Status made = make_run_folder(folder);
    if (made) made = check_run_folder(options, folder);
    if (!made) return made;
  }
  auto desk = Desk::open(users_places());
  if (!desk) return desk.error();
  (*desk)->store = options.store;
  if (const Status shown = show_to_instructor(**desk, options); !shown) return shown;
  (*desk)->session_over = [&report](double seconds, bool done) {
    report.seconds += seconds;
    report.done = report.done || done;
  };
  enter_waiting(**desk);
  (*desk)->headset_wanted = (*desk)->headset_wanted || options.xr;
  if (options.work.volume.source.empty())
    return run_pages(**desk, {options.seconds, options.out, options.screenshot, !options.no_sound,
                              options.work, options.mode_given});
  for (;;) {
    const auto left = session_in_window(**desk, options);
    if (!left) return left.error();
    if (*left != Closed::again) return (*desk)->lost;
    next_attempt(options.work.identity);
  }
}

Status run(Options options) {
  const Status possible =
      check_outputs({options.work.volume.source}, {{"--screenshot", options.screenshot, {".png"}}});
  if (!possible) return possible;
  const bool windowless = options.headless || !display_there();
  // before the window opens
  if (const auto law = own_law(options.work.law, !windowless); !law) return law.error();
  RunReport report;
  if (!windowless) return launched(options, report, [&] { return run_in_window(options, report); });
  for (const auto& [option, given] : {std::pair{"--device", &options.work.hand.device},
                                      {"--suction", &options.work.suction},
                                      {"--publish-as", &options.work.publish_as}})
    if (!given->empty())
      return error(Trouble::usage,
                   fmt::format("{0} {1}: this needs a window. Use the computer's own display, or "
                               "leave out {0}; burr then mills by itself",
                               option, *given));
  if (!options.headless)
    fmt::print(stderr, "no display found: burr mills by itself, as with --headless\n");
  options.work.seconds = options.seconds;
  if (Status taken = take_case(options.work); !taken) return taken;
  // nobody is there to declare the work done: it is, where nothing stopped it
  return launched(options, report, [&] {
    report.seconds = options.seconds > 0 ? options.seconds : kHeadlessSeconds;
    report.done = true;
    return run_headless(options);
  });
}

void add(CLI::App& app, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("run", "mill a bone in a window");
  command->add_option("volume", options->work.volume.source,
                      "a case (temporal-bone, jaw, ... or a .toml file), or a scan: file or DICOM "
                      "folder (default: the start page; with --headless: temporal-bone)");
  command->add_flag(
      "--headless", options->headless,
      "no window: burr mills by itself and writes pictures, a recording and a page of figures");
  command
      ->add_option(
          "--seconds", options->seconds,
          "close the window after this many seconds; with --headless: simulated time (default: 20)")
      ->check(CLI::Range(0.1, 36'000.0));
  command->add_option("--out", options->out,
                      "folder for pictures, recording and summary (default with --headless: "
                      "burr-out; in a window: none of these is written)");
  command->add_option("--screenshot", options->screenshot,
                      "PNG of the window when it closed, with panels");
  add_setting_option(*command, "burr_mm", options->work.burr_mm,
                     "diameter of the burr (default: that of the case, otherwise 5)");
  add_tool_options(*command, options->work.tool);
  auto* touch = command->add_option_function<std::string>(
      "--touch",
      [options](const std::string& name) { options->work.touch = *haptics::method_named(name); },
      "shaft: the burr's shaft touches the bone too (default: constraint, the head alone; with "
      "--second-tool shaft)");
  touch->check(CLI::IsMember({"constraint", "shaft"}));
  add_law_options(*command, options->work.law);
  command->add_flag("--no-sound", options->no_sound, "the window makes no sound");
  command->add_flag("--xr", options->xr, "use a headset through OpenXR")->excludes("--headless");
  add_setting_option(*command, "rpm", options->work.rpm,
                     "speed of the spindle (default: that of the case, otherwise 40000)");
  add_force(*command, options->force);
  add_hand_options(*command, options->work.hand);
  auto* second = command->add_option(
      "--suction,--second-device", options->work.suction,
      "a second haptic device for the other hand: a suction tube that feels the bone, or another "
      "tool with --second-tool");
  second->excludes("--headless");
  add_second_tool_option(*command, options->work.tool)->needs(second);
  command
      ->add_option("--publish-as", options->work.publish_as,
                   "/NAME: publish the session as a CRTK arm of this name, so that other programs "
                   "can watch and record it (ROS 2)")
      ->excludes("--headless");
  add_identity_options(*command, options->work.identity);
  command
      ->add_option(
          "--store", options->store,
          "the store of learners for sessions with --learner (docs/teach/school.md; default: "
          "BURR_STORE, or the one in burr's data folder if it is there)")
      ->excludes("--headless");
  auto* live = command->add_option("--live", options->live,
                                   "https://SERVER:PORT of a `burr serve --live`: the instructor "
                                   "sees this window and can send a "
                                   "word or a mark; a line in the window says when it is watched");
  live->excludes("--headless");
  command
      ->add_option("--live-token-file", options->live_token,
                   "the file with the token of the stations, readable by you alone")
      ->needs(live);
  command
      ->add_option("--station", options->station,
                   "the name of this station there (default: the computer's)")
      ->needs(live);
  live->needs("--live-token-file");
  command->add_option("--cmi5", options->cmi5,
                      "the address with which a learning management system starts a unit "
                      "(cmi5), in quotes; docs/teach/xapi.md lists what burr reports to it");
  add_bone_option(*command, options->work.bone);
  add_volume_options(*command, options->work.volume);
  const auto* mode = command->get_option("--mode");
  command->callback([options, touch, mode, &todo] {
    options->mode_given = !mode->empty();
    // two tools feel each other where all their parts do
    if (!options->work.tool.second.empty() && touch->empty())
      options->work.touch = haptics::Method::shaft;
    todo.work = [options] { return run(*options); };
  });
}

const Command command{10, add};

}  // namespace
}  // namespace burr::app
