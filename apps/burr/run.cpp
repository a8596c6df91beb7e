// `burr run`: the simulator in a window; or, without a display, a session that mills by itself and
// leaves pictures, a recording and a page of figures.
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "burr/device/simulated_hand.h"
#include "burr/math/turn.h"
#include "burr/render/bone_scene.h"
#include "burr/render/pick.h"
#include "burr/render/picture.h"
#include "burr/render/renderer.h"
#include "burr/scenario/case.h"
#include "burr/sim/motion.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "command.h"
#include "recording.h"
#include "still.h"
#include "summary.h"
#include "volume_options.h"
#include "window/mouse_hand.h"
#include "window/window.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr int kWidth = 1280, kHeight = 720;  // of the pictures
constexpr double kHeadlessSeconds = 20;

struct Options {
  VolumeOptions volume;
  std::string out;
  double seconds = 0;
  double burr_mm = 0, rpm = 0;   // 0: the case's, or 5 mm and 40 000
  std::optional<Vec3> at, into;  // where the case begins
  std::string motion = "pocket";
  tool::BurrKind kind = tool::BurrKind::cutting;
  bool headless = false;
};

// What is milled and where: everything before hand and session.
struct Work {
  io::Imported made;
  std::string what;      // in our words
  VolumeOptions volume;  // with the case's name as a phantom
  sim::WorkPlace place;
};

// A display that SDL could open a window on.
bool display_there() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(name); value != nullptr && *value != '\0') return true;
  return false;
}

// A built-in case or a .toml file says what is milled, where and with what; options given by hand
// win. Anything else is left as it is.
Status take_case(Options& options) {
  VolumeOptions& volume = options.volume;
  if (volume.path.empty()) volume.path = "temporal-bone";
  const auto known = scenario::built_in_cases();
  const bool built_in = std::find(known.begin(), known.end(), volume.path) != known.end();
  std::error_code nobody_asks;
  if ((built_in && !std::filesystem::exists(volume.path, nobody_asks)) ||
      std::filesystem::path(volume.path).extension() == ".toml") {
    const auto read = scenario::read_case(volume.path);
    if (!read) return read.error();
    volume.path = read->phantom.empty() ? read->volume : "phantom:" + read->phantom;
    if (volume.voxel_mm == 0) volume.voxel_mm = 1e3 * read->voxel;
    if (options.burr_mm == 0) options.burr_mm = 2e3 * read->burr.radius;
    if (options.rpm == 0) options.rpm = read->full_speed * 60 / (2 * std::numbers::pi);
    if (options.seconds == 0 && options.headless) options.seconds = read->seconds;
    options.at = read->at;
    options.into = read->into;
    options.motion = read->motion;
    options.kind = read->burr.kind;
    fmt::print(stderr, "{}\n", read->title);
  }
  if (options.burr_mm == 0) options.burr_mm = 5;
  if (options.rpm == 0) options.rpm = 40'000;
  return fine();
}

Result<Work> open_work(Options options) {
  VolumeOptions& volume = options.volume;
  // a phantom's bare name; a file of that name comes first
  std::error_code nobody_asks;
  if (!is_phantom(volume.path) && volume.path.find_first_of("./") == std::string::npos &&
      !std::filesystem::exists(volume.path, nobody_asks))
    volume.path = "phantom:" + volume.path;
  const bool phantom = is_phantom(volume.path);
  auto made = open_volume(volume, progress());
  if (!made) return made.error();

  Work work;
  work.made = std::move(*made);
  work.volume = volume;
  work.what =
      phantom ? volume.path.substr(volume.path.find(':') + 1) : work.made.summary.format + " scan";
  for (const std::string& notice : work.made.summary.notices) fmt::print(stderr, "{}\n", notice);
  auto place =
      sim::find_work_place(*work.made.bone, 0.5e-3 * options.burr_mm, options.at, options.into);
  if (!place) return place.error();
  work.place = *place;
  return work;
}

sim::SessionSettings settings_of(const Options& options, bool realtime) {
  sim::SessionSettings settings;
  settings.servo.burr.radius = 0.5e-3 * options.burr_mm;
  settings.servo.burr.kind = options.kind;
  settings.servo.spindle_rad_s = options.rpm * 2 * std::numbers::pi / 60;
  settings.realtime = realtime;
  return settings;
}

// how much of the surroundings is seen: the pocket large, the anatomy around it still there
double view_height(double burr_radius) { return std::clamp(20 * burr_radius, 20e-3, 70e-3); }

Status make_folder(const std::filesystem::path& folder) {
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  if (!trouble) return fine();
  return error(Trouble::io, fmt::format("{}: cannot make this folder ({}); choose another --out",
                                        folder.string(), trouble.message()));
}

Summary summary_of(sim::Session& session, const std::string& what, const std::string& hand) {
  const sim::Outcome outcome = session.outcome();
  const sim::SessionSettings& settings = session.settings();
  Summary summary;
  summary.what = what;
  summary.hand = hand;
  summary.size = session.bone().grid().size;
  summary.voxel = session.bone().grid().voxel;
  summary.burr_radius = settings.servo.burr.radius;
  summary.rpm = settings.servo.spindle_rad_s * 60 / (2 * std::numbers::pi);
  summary.seconds = outcome.seconds;
  summary.rate_hz = settings.servo.rate_hz;
  summary.ticks = outcome.ticks;
  summary.realtime = settings.realtime;
  summary.removed = outcome.ledger.removed;
  summary.asked = outcome.ledger.asked;
  summary.not_cut = outcome.ledger.not_cut;
  summary.added = outcome.ledger.added;
  summary.peak_force = outcome.peak_force;
  summary.mean_force = outcome.mean_force;
  summary.p50_us = outcome.timing.p50_us;
  summary.p99_us = outcome.timing.p99_us;
  summary.p999_us = outcome.timing.p999_us;
  summary.max_us = outcome.timing.max_us;
  summary.late = outcome.timing.late;
  summary.missed = outcome.timing.missed;
  summary.flags = flag_words(outcome.flags);
  summary.bone_hash = session.bone().content_hash();
  summary.tissues = losses(*session.bone_before(), session.bone());
  return summary;
}

// the tool as the session last had it
void put_tool_of(render::Scene& scene, sim::Session& session) {
  record::TickRow row;
  if (session.view(row)) put_tool(scene, row, session.settings().servo.burr.radius, true);
}

// Before, at half time with the burr in the bone, and after: the same view.
Status run_headless(const Options& options) {
  const std::filesystem::path folder = options.out.empty() ? "burr-out" : options.out;
  const double seconds = options.seconds > 0 ? options.seconds : kHeadlessSeconds;
  Status made = make_folder(folder);
  if (!made) return made;
  auto opened = open_work(options);
  if (!opened) return opened.error();
  Work& work = *opened;
  const sim::SessionSettings settings = settings_of(options, false);
  auto path = sim::motion(options.motion, work.place, settings.servo.burr.radius, seconds);
  if (!path) return path.error();
  auto hand = std::make_unique<device::SimulatedHand>(std::move(*path), device::ArmSettings{});
  auto started =
      sim::Session::make(std::move(work.made.bone), std::move(hand), settings, progress());
  if (!started) return started.error();
  sim::Session& session = **started;

  auto renderer = render::Renderer::offscreen();
  if (!renderer) return renderer.error();
  render::Scene scene =
      scene_of_work(session.bone(), settings.servo.burr.radius, work.place.at, -work.place.into);
  const auto picture = [&](const char* name) -> Status {
    const Status skinned = render::skin_bone(scene, session.bone(), settings.threads, progress());
    if (!skinned) return skinned;
    const auto image = (*renderer)->image(scene, kWidth, kHeight);
    if (!image) return image.error();
    return render::write_png(*image, folder / name);
  };
  const auto stopped = [] {
    return interrupted() ? Status(error(Trouble::interrupted, "stopped")) : fine();
  };

  Status status = picture("before.png");
  if (!status) return status;
  Recording recording;
  status = recording.start(session, (folder / "session.mcap").string(), work.volume,
                           work.made.summary, options.motion, false);
  if (!status) return status;
  session.run(0.5 * seconds, progress());
  put_tool_of(scene, session);
  status = stopped();
  if (status) status = picture("working.png");
  scene.burr.visible = false;
  scene.markers.clear();
  scene.rods.clear();
  if (status) {
    session.run(0.5 * seconds, progress());
    status = stopped();
  }
  const Status recorded = recording.finish(session);
  if (!status) return status;
  Summary summary = summary_of(session, work.what, "simulated hand, " + options.motion);
  if (!recorded) fmt::print("{}", summary_text(summary));  // a disk that is full takes no picture
  status = picture("after.png");
  if (!status) return recorded ? status : recorded;

  summary.pictures = {
      {"before.png", "before"}, {"working.png", "at half time"}, {"after.png", "after"}};
  if (recorded) summary.recording = "session.mcap";
  status = write_summary(summary, folder);
  if (!recorded) return recorded;
  if (!status) return status;
  fmt::print("{}{}: before.png working.png after.png session.mcap summary.html\n",
             summary_text(summary), folder.string());
  return fine();
}

// A person's session: the window, and what it leaves if a folder was named.
Status run_in_window(const Options& options) {
  const std::filesystem::path folder = options.out;
  if (!folder.empty()) {
    Status made = make_folder(folder);
    if (!made) return made;
  }
  auto opened = open_work(options);
  if (!opened) return opened.error();
  Work& work = *opened;
  const sim::SessionSettings settings = settings_of(options, true);

  // the hand begins two centimetres above the work
  math::Pose above;
  above.p = work.place.at - 20e-3 * work.place.into;
  above.q = math::shortest_turn(Vec3::UnitZ(), -work.place.into);
  auto hand = std::make_unique<MouseHand>(above);
  MouseHand& mouse = *hand;
  auto started =
      sim::Session::make(std::move(work.made.bone), std::move(hand), settings, progress());
  if (!started) return started.error();
  sim::Session& session = **started;

  render::Scene scene;
  scene.tissue_colours = render::colours_of(session.bone().tissues());
  surface::Worker worker(session.bone(), 1);
  Status status =
      worker.first(progress(), [&scene](const surface::Skin& skin) { put_skin(scene, skin); });
  if (!status) return status;
  scene.camera = render::view_of_work(work.place.at, -work.place.into,
                                      2 * view_height(settings.servo.burr.radius));
  const render::Camera first_view = scene.camera;
  const render::Scene before = scene;

  Recording recording;
  if (!folder.empty()) {
    status = recording.start(session, (folder / "session.mcap").string(), work.volume,
                             work.made.summary, "mouse", false);
    if (!status) return status;
  }
  status = run_window(session, mouse, worker, scene,
                      {options.seconds, options.out, [&recording] { return recording.trouble(); }});
  if (folder.empty()) return status;
  const Status recorded = recording.finish(session);
  if (!status) return status;

  Summary summary = summary_of(session, work.what, "mouse");
  if (!recorded) fmt::print("{}", summary_text(summary));  // a disk that is full takes no picture
  scene.burr.visible = false;
  scene.markers.clear();
  scene.rods.clear();
  for (const auto& [name, one] : {std::pair{"before", &before}, {"after", &std::as_const(scene)}}) {
    render::Scene picture = *one;
    picture.look = render::still_look();
    picture.camera = first_view;
    picture.scale_bar = true;
    const std::string file = std::string(name) + ".png";
    status = render::render_png(picture, kWidth, kHeight, folder / file);
    if (!status) return recorded ? status : recorded;
    summary.pictures.emplace_back(file, name);
  }
  if (recorded) summary.recording = "session.mcap";
  status = write_summary(summary, folder);
  if (!recorded) return recorded;
  if (!status) return status;
  fmt::print("{}{}: before.png after.png session.mcap summary.html\n", summary_text(summary),
             folder.string());
  return fine();
}

Status run(Options options) {
  if (!display_there() && !options.headless) {
    fmt::print(stderr, "no display here: milling by itself, as with --headless\n");
    options.headless = true;
  }
  if (Status taken = take_case(options); !taken) return taken;
  if (options.headless) return run_headless(options);
  return run_in_window(options);
}

void add(CLI::App& app, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("run", "mill a bone in a window");
  command->add_option(
      "bone", options->volume.path,
      "a case (temporal-bone, jaw, ... or a .toml file), or a scan: file or DICOM folder; default: "
      "temporal-bone");
  command->add_flag("--headless", options->headless,
                    "no window: mill by itself, leave pictures, a recording and a page of figures");
  command
      ->add_option("--seconds", options->seconds,
                   "close the window after so long; headless: simulated time (default: 20)")
      ->check(CLI::Range(0.1, 36'000.0));
  command->add_option("--out", options->out,
                      "folder for pictures, recording and summary (headless: burr-out; window: "
                      "nothing is kept without it)");
  command->add_option("--burr-mm", options->burr_mm,
                      "diameter of the burr; default: the case's, else 5");
  command->add_option("--rpm", options->rpm, "of the spindle; default: the case's, else 40000");
  add_volume_options(*command, options->volume);
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{10, add};

}  // namespace
}  // namespace burr::app
