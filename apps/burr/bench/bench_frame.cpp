// burr bench frame - frame times while the servo mills at its rate: the work from near, and the
// whole bone while it turns; as the window draws it, with a governor, and at full quality.
//
// Off-screen, 1280 x 720 unless requested otherwise; a frame ends when it is drawn (glFinish).
//   input to picture: from a movement of the mouse, 125 a second, until a picture that shows it is
//     drawn. A movement that turns the bone is in the next picture; one that moves the hand goes
//     through the servo and is in the picture after that.
//   cut to picture: from the tick that changed a brick until the picture with all the patches it
//     touches is drawn. A watcher looks 1000 times a second. A change counts from the look before
//     the one that found it, so the figure is up to 1 ms too long, never too short.
//   VTK, where it is installed: all triangles of the whole bone, one light, no effects, in a
//     separate program while the servo runs. Loading patches does not slow it, and it has no
//     ambient occlusion.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "bench/bench.h"
#include "bench/bench_vtk_frame.h"
#include "bench/full_load_run.h"
#include "burr/device/simulated_hand.h"
#include "burr/render/renderer.h"
#include "burr/render/soft_scene.h"
#include "burr/sim/session.h"
#include "burr/surface/mesher.h"
#include "burr/surface/worker.h"
#include "burr/surgeon/motion.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/work_view.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"
#include "shared/picture_size.h"
#include "shared/setting_options.h"
#include "shared/volume_words.h"

namespace burr::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPocket = 20;  // [s]

struct Options {
  scenario::BoneRecipe volume;
  PictureSize size;
  double burr_mm = 5, rate_hz = 1000, seconds = 10;
  int turns = 60;
  bool json = false;
};

// Frame times, and what the frames drew.
struct Frames {
  std::vector<double> ms;
  double patches = 0, triangles = 0;  // sums
  double elapsed_s = 0;               // including everything between two pictures

  void add(double took_ms, const render::Renderer::Figures& figures) {
    ms.push_back(took_ms);
    patches += figures.patches_drawn;
    triangles += static_cast<double>(figures.triangles_drawn);
  }
  [[nodiscard]] double quantile(double q) const { return app::quantile(ms, q); }
  [[nodiscard]] double shown_per_s() const { return static_cast<double>(ms.size()) / elapsed_s; }
  [[nodiscard]] double mean(double sum) const { return sum / static_cast<double>(ms.size()); }
  [[nodiscard]] nlohmann::ordered_json json() const {
    return {{"frames", ms.size()},      {"shown_per_s", shown_per_s()},
            {"ms_p50", quantile(0.5)},  {"ms_p95", quantile(0.95)},
            {"ms_max", quantile(1)},    {"fps", 1e3 / quantile(0.5)},
            {"patches", mean(patches)}, {"triangles", mean(triangles)}};
  }
};

// Mouse movements: a thread that makes time stamps of them.
class Inputs {
 public:
  // the movements since the last call
  std::vector<Clock::time_point> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(stamps_, {});
  }

 private:
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(8));
      const std::lock_guard lock(mutex_);
      stamps_.push_back(Clock::now());
    }
  }
  std::mutex mutex_;
  std::vector<Clock::time_point> stamps_;
  std::jthread thread_{[this](const std::stop_token& stop) { run(stop); }};
};

// Times at which the servo changed what the patches show.
class Cuts {
 public:
  // adds a watcher; before the session starts
  explicit Cuts(volume::Bone& bone) : mesher_(bone), changed_(bone.add_watcher()) {
    first_.resize(static_cast<std::size_t>(mesher_.patch_count()));
  }
  void start() {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  // These patches, with everything known when their surface was made, are in a picture now. Appends
  // how long each of them waited [ms].
  void shown(const std::vector<surface::Skin>& skins, std::vector<double>& ms) {
    const auto now = Clock::now();
    const std::lock_guard lock(mutex_);
    for (const surface::Skin& skin : skins) {
      auto& first = first_[static_cast<std::size_t>(skin.patch)];
      if (!first || *first > skin.seen) continue;
      ms.push_back(std::chrono::duration<double, std::milli>(now - *first).count());
      first.reset();
    }
  }

 private:
  void run(const std::stop_token& stop) {
    std::vector<int> patches;
    auto looked = Clock::now();
    while (!stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      patches.clear();
      const auto before = std::exchange(looked, Clock::now());
      changed_.take_all([&](std::size_t brick) {
        mesher_.patches_of_brick(static_cast<volume::BrickIndex>(brick), patches);
      });
      const std::lock_guard lock(mutex_);
      for (const int patch : patches)
        if (auto& first = first_[static_cast<std::size_t>(patch)]; !first) first = before;
    }
  }
  surface::Mesher mesher_;
  rt::ChangedBits& changed_;
  std::mutex mutex_;
  std::vector<std::optional<Clock::time_point>> first_;  // by patch: a change that is not yet in a
                                                         // picture
  std::jthread thread_;
};

struct Outcome {
  std::string gpu;
  double first_ms = 0;  // the first frame: all patches sent
  double coarse_s = 0;  // until all coarser levels existed
  // as a window draws; at full quality; at full quality including hidden bone
  Frames work, whole, work_full, whole_full, whole_all;
  std::vector<double> input_ms, cut_ms;
  std::array<std::uint64_t, render::FrameGovernor::kSteps> steps = {};
  std::optional<double> vtk_ms;  // VTK with the whole bone turning, while the servo mills
  sim::Outcome session;
};

// A session's bone with everything that keeps its picture up to date.
class Desk {
 public:
  Desk(const Options& options, sim::Session& session, const surgeon::WorkPlace& place,
       std::unique_ptr<render::Renderer> renderer)
      : options_(options),
        session_(session),
        renderer_(std::move(renderer)),
        worker_(session.bone(), 1),
        live_(session, worker_, scene_, renderer_->software()),
        cuts_(session.bone()) {
    scene_ = workshop::scene_of_work(session.bone(), session.settings().servo.burr.radius, place.at,
                                     -place.into);
    scene_.look = {};
    scene_.tissue_colours = render::colours_of(session.bone().tissues());
  }

  Status run(Outcome& out);

 private:
  enum class Draw { governed, full, all };
  Status settle(Outcome& out);
  Status frame(Draw how, Frames& frames);
  Status work(Draw how, double seconds, Frames& frames, Outcome* out);
  Status turn(Draw how, double seconds, int most, Frames& frames, Outcome* out);

  const Options& options_;
  sim::Session& session_;
  std::unique_ptr<render::Renderer> renderer_;
  surface::Worker worker_;
  render::Scene scene_;
  workshop::LiveSurface live_;
  Cuts cuts_;
};

Status Desk::run(Outcome& out) {
  out.gpu = renderer_->gpu();
  const Status settled = settle(out);
  if (!settled) return settled;
  const render::Camera near = scene_.camera;
  const render::Camera far = render::whole_view(
      scene_, 0, 0.3, static_cast<double>(options_.size.width) / options_.size.height);

  cuts_.start();
  session_.start();
  Status done = work(Draw::governed, options_.seconds, out.work, &out);
  scene_.camera = far;
  if (done) done = turn(Draw::governed, options_.seconds, 1 << 30, out.whole, &out);
  out.steps = live_.governor().frames();
  if (done) done = turn(Draw::full, options_.seconds, options_.turns, out.whole_full, nullptr);
  if (done) done = turn(Draw::all, options_.seconds, options_.turns, out.whole_all, nullptr);
  if (done) out.vtk_ms = vtk_frame_ms(scene_, options_.size.width, options_.size.height, 20);
  scene_.camera = near;
  if (done) done = work(Draw::full, options_.seconds, out.work_full, nullptr);
  session_.stop();
  out.session = session_.outcome();
  return done;
}

// Draws the first picture and makes all coarser levels.
Status Desk::settle(Outcome& out) {
  const Status skinned = worker_.first(
      progress(), [&](const surface::Skin& skin) { workshop::put_skin(scene_, skin); });
  if (!skinned) return skinned;
  if (const Status soft = render::add_soft(scene_, session_.bone(), progress()); !soft) return soft;
  auto start = Clock::now();
  const Status first = renderer_->show(scene_);
  if (!first) return first;
  out.first_ms = ms_since(start);
  start = Clock::now();
  do {
    live_.coarsening().update(scene_, live_.now());
    progress().report(0, "making coarser levels");
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (interrupted()) return error(Trouble::interrupted, "stopped");
  } while (live_.coarsening().waiting() > 0);
  out.coarse_s = 1e-3 * ms_since(start);
  return fine();
}

// Draws one frame as the window does.
Status Desk::frame(Draw how, Frames& frames) {
  if (interrupted()) return error(Trouble::interrupted, "stopped");
  live_.update();
  if (how != Draw::governed) scene_.quality = {};
  tick::TickRow row;
  if (session_.view(row)) workshop::put_tool(scene_, row, true);
  const auto start = Clock::now();
  renderer_->skip_hidden(how != Draw::all);
  const Status drawn = renderer_->show(scene_);
  if (!drawn) return drawn;
  const double ms = ms_since(start);
  if (how == Draw::governed) live_.drawn(1e-3 * ms, renderer_->figures().redrawn);
  frames.add(ms, renderer_->figures());
  return fine();
}

// From near; the hand's inputs are in the picture after the next one.
Status Desk::work(Draw how, double seconds, Frames& frames, Outcome* out) {
  Inputs inputs;
  std::vector<Clock::time_point> handled;
  const auto start = Clock::now();
  std::vector<double> nowhere;
  while (session_.running() && ms_since(start) < 1e3 * seconds) {
    progress().report(ms_since(start) / (1e3 * seconds), "milling");
    std::vector<Clock::time_point> fresh = inputs.take();
    const Status drawn = frame(how, frames);
    if (!drawn) return drawn;
    cuts_.shown(live_.skins(), out != nullptr ? out->cut_ms : nowhere);
    for (const Clock::time_point& input : handled)
      if (out != nullptr) out->input_ms.push_back(ms_since(input));
    handled = std::move(fresh);
  }
  frames.elapsed_s = 1e-3 * ms_since(start);
  return fine();
}

// The whole bone, one turn in twelve seconds; at most `most` pictures.
Status Desk::turn(Draw how, double seconds, int most, Frames& frames, Outcome* out) {
  Inputs inputs;
  const auto start = Clock::now();
  double turned = 0;
  for (int n = 0; n < most && session_.running() && ms_since(start) < 1e3 * seconds; ++n) {
    progress().report(ms_since(start) / (1e3 * seconds), "turning the bone");
    const std::vector<Clock::time_point> fresh = inputs.take();
    // always in one direction and by at least a small step, so that nothing drawn before can be
    // kept
    const double to = std::max(2 * M_PI / 12 * 1e-3 * ms_since(start), turned + 1e-3);
    render::orbit(scene_.camera, to - turned, 0);
    turned = to;
    const Status drawn = frame(how, frames);
    if (!drawn) return drawn;
    for (const Clock::time_point& input : fresh)
      if (out != nullptr) out->input_ms.push_back(ms_since(input));
  }
  frames.elapsed_s = 1e-3 * ms_since(start);
  return fine();
}

nlohmann::ordered_json shares(const Outcome& out) {
  const double all =
      static_cast<double>(std::accumulate(out.steps.begin(), out.steps.end(), std::uint64_t{0}));
  nlohmann::ordered_json json;
  for (int step = 0; step < render::FrameGovernor::kSteps; ++step)
    json[render::FrameGovernor::name(step)] =
        static_cast<double>(out.steps[static_cast<std::size_t>(step)]) / std::max(1.0, all);
  return json;
}

void print(const Options& options, const Outcome& out) {
  const rt::TickSummary& tick = out.session.timing;
  if (options.json) {
    nlohmann::ordered_json json;
    json["gpu"] = out.gpu;
    json["size"] = {options.size.width, options.size.height};
    json["working_fps"] = out.work.shown_per_s();
    json["whole_fps"] = out.whole.shown_per_s();
    json["input_to_picture_ms_p95"] = quantile(out.input_ms, 0.95);
    json["cut_to_picture_ms_p95"] = quantile(out.cut_ms, 0.95);
    json["governor_share_per_step"] = shares(out);
    json["vtk_whole_fps"] =
        out.vtk_ms ? nlohmann::ordered_json(1e3 / *out.vtk_ms) : nlohmann::ordered_json(nullptr);
    json["first_frame_ms"] = out.first_ms;
    json["coarse_s"] = out.coarse_s;
    json["work"] = out.work.json();
    json["whole"] = out.whole.json();
    json["work_full"] = out.work_full.json();
    json["whole_full"] = out.whole_full.json();
    json["whole_with_hidden"] = out.whole_all.json();
    json["tick_us"] = {
        {"p50", tick.p50_us}, {"p99", tick.p99_us}, {"p999", tick.p999_us}, {"max", tick.max_us}};
    json["ticks"] = tick.ticks;
    json["missed_ticks"] = tick.missed;
    json["removed_mm3"] = 1e9 * out.session.ledger.removed;
    fmt::print("{}\n", json_line(json));
    return;
  }
  fmt::print("{} x {} on {}\n", options.size.width, options.size.height, out.gpu);
  const auto line = [](const char* what, const Frames& frames) {
    fmt::print(
        "{:<28} {:5.1f} shown/s; {:6.1f} ms p50, {:6.1f} p95; {:5.0f} parts, {:.0f} k "
        "triangles\n",
        what, frames.shown_per_s(), frames.quantile(0.5), frames.quantile(0.95),
        frames.mean(frames.patches), 1e-3 * frames.mean(frames.triangles));
  };
  line("the work, milled", out.work);
  line("the whole bone, turning", out.whole);
  line("the work at full quality", out.work_full);
  line("the whole at full quality", out.whole_full);
  line("... with hidden bone", out.whole_all);
  if (out.vtk_ms)
    fmt::print("{:<28} {:5.1f} frames/s; {:6.1f} ms p50\n", "VTK, the whole bone, turning",
               1e3 / *out.vtk_ms, *out.vtk_ms);
  else
    fmt::print("VTK not compared: burr_vtk_frame needs VTK 9 when burr is built, and a display\n");
  fmt::print(
      "input to picture {:.0f} ms p50, {:.0f} p95; cut to picture {:.0f} ms p50, {:.0f} p95\n",
      quantile(out.input_ms, 0.5), quantile(out.input_ms, 0.95), quantile(out.cut_ms, 0.5),
      quantile(out.cut_ms, 0.95));
  std::string steps;
  const nlohmann::ordered_json all = shares(out);
  for (const auto& [name, share] : all.items())
    if (share.get<double>() > 0)
      steps +=
          fmt::format("{}{:.0f} % {}", steps.empty() ? "" : ", ", 1e2 * share.get<double>(), name);
  fmt::print("left out: {}\n", steps);
  fmt::print(
      "first frame {:.0f} ms; tick p50 {:.0f}, p99 {:.0f}, p99.9 {:.0f} us, {} of {} left out; "
      "removed {:.1f} mm^3\n",
      out.first_ms, tick.p50_us, tick.p99_us, tick.p999_us, tick.missed, tick.ticks,
      1e9 * out.session.ledger.removed);
}

Status run(Options options) {
  if (options.volume.source.empty()) options.volume.source = "phantom:temporal-bone";
  auto opened = workshop::open_bone(options.volume, progress());
  if (!opened) return opened.error();
  const double radius = 0.5e-3 * options.burr_mm;
  auto place = surgeon::find_work_place(*opened->bone, radius, {}, {});
  if (!place) return place.error();
  auto pockets = pockets_again(*place, radius, kPocket, 5 * options.seconds + 2 * kPocket);
  if (!pockets) return pockets.error();
  sim::SessionSettings settings;
  settings.realtime = true;
  settings.servo.rate_hz = options.rate_hz;
  settings.servo.burr.radius = radius;
  auto session = workshop::begin_by_itself(std::move(opened->bone), std::move(pockets->path),
                                           settings, progress());
  if (!session) return session.error();
  auto renderer = render::Renderer::offscreen();
  if (!renderer) return renderer.error();
  (*renderer)->resize_offscreen(options.size.width, options.size.height);

  Outcome out;
  const Status drawn = Desk(options, **session, *place, std::move(*renderer)).run(out);
  if (!drawn) return drawn;
  print(options, out);
  return fine();
}

void add(CLI::App& bench, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command = bench.add_subcommand(
      "frame", "measure how fast the bone is drawn, at rest and while milling");
  command->add_option("volume", options->volume.source,
                      "file, DICOM folder, or phantom:NAME (default: phantom:temporal-bone)");
  command->add_option("--seconds", options->seconds, "length of each part")
      ->check(CLI::Range(1.0, 36'000.0))
      ->capture_default_str();
  command->add_option("--turns", options->turns, "largest number of frames at full quality")
      ->check(CLI::Range(2, 10'000))
      ->capture_default_str();
  add_setting_option(*command, "burr_mm", options->burr_mm);
  add_setting_option(*command, "rate_hz", options->rate_hz);
  command->add_flag("--json", options->json, "one JSON object on the last line");
  add_picture_size(*command, options->size);
  add_volume_options(*command, options->volume);
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const BenchCommand command{60, add};

}  // namespace
}  // namespace burr::app
