// burr bench frame - how fast it is drawn, at full quality: the whole bone while it turns, and the
// work while the servo mills it at its rate.
//
// Off-screen, 1280 x 720 unless asked otherwise; a frame ends when it is drawn (glFinish). Each
// frame of the orbit is drawn twice in a row, with and without the bone that other bone hides, so
// that the machine's bad moments hit both.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "bench.h"
#include "burr/device/simulated_hand.h"
#include "burr/render/renderer.h"
#include "burr/sim/motion.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "still.h"
#include "volume_options.h"
#include "whole_session.h"
#include "window/window.h"

namespace burr::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kPatchesPerFrame = 256;  // as the window does
constexpr double kPocket = 20;         // [s]

struct Options {
  VolumeOptions volume;
  PictureSize size;
  double burr_mm = 5, rate_hz = 1000, seconds = 10;
  int turns = 60;
  bool json = false;
};

// How long frames took, and what they drew.
struct Frames {
  std::vector<double> ms;
  double patches = 0, triangles = 0;  // sums

  void add(double took_ms, const render::Renderer::Figures& figures) {
    ms.push_back(took_ms);
    patches += figures.patches_drawn;
    triangles += static_cast<double>(figures.triangles_drawn);
  }
  [[nodiscard]] double quantile(double q) const { return app::quantile(ms, q); }
  [[nodiscard]] double mean(double sum) const { return sum / static_cast<double>(ms.size()); }
  [[nodiscard]] nlohmann::ordered_json json() const {
    return {{"frames", ms.size()},         {"ms_p50", quantile(0.5)},    {"ms_p95", quantile(0.95)},
            {"ms_max", quantile(1)},       {"fps", 1e3 / quantile(0.5)}, {"patches", mean(patches)},
            {"triangles", mean(triangles)}};
  }
};

Status draw(render::Renderer& renderer, const render::Scene& scene, Frames& frames) {
  const auto start = Clock::now();
  const Status shown = renderer.show(scene);
  if (!shown) return shown;
  frames.add(ms_since(start), renderer.figures());
  return fine();
}

struct Outcome {
  std::string gpu;
  double first_ms = 0;       // the first frame: all patches sent
  Frames orbit, everything;  // without and with hidden bone
  Frames work;
  sim::Outcome session;
};

// All of the bone, turning once around; the servo does not run.
Status orbit(const Options& options, render::Renderer& renderer, render::Scene& scene,
             Outcome& out) {
  const render::Camera before = scene.camera;
  scene.camera = render::whole_view(scene, 0, 0.3,
                                    static_cast<double>(options.size.width) / options.size.height);
  const auto start = Clock::now();
  const Status first = renderer.show(scene);
  if (!first) return first;
  out.first_ms = ms_since(start);
  for (int n = 0; n < options.turns; ++n) {
    if (interrupted()) return error(Trouble::interrupted, "stopped");
    progress().report(static_cast<double>(n) / options.turns, "turning the bone");
    for (const bool skip : {true, false}) {
      // as small a step as a hand makes, either time, so that nothing drawn before is kept
      render::orbit(scene.camera, M_PI / options.turns, 0);
      renderer.skip_hidden(skip);
      const Status drawn = draw(renderer, scene, skip ? out.orbit : out.everything);
      if (!drawn) return drawn;
    }
  }
  renderer.skip_hidden(true);
  scene.camera = before;
  return fine();
}

// The work from near while it is milled by the clock; frames one after the other.
Status work(const Options& options, sim::Session& session, surface::Worker& worker,
            render::Renderer& renderer, render::Scene& scene, Outcome& out) {
  session.start();
  const auto start = Clock::now();
  record::TickRow row;
  Status drawn = fine();
  while (drawn && session.running() && ms_since(start) < 1e3 * options.seconds && !interrupted()) {
    progress().report(ms_since(start) / (1e3 * options.seconds), "milling");
    static_cast<void>(session.view(row));
    surface::Skin skin;
    for (int i = 0; i < kPatchesPerFrame && worker.take(skin); ++i) {
      put_skin(scene, skin);
      worker.give_back(skin);
    }
    put_tool(scene, row, session.settings().servo.burr.radius, true);
    drawn = draw(renderer, scene, out.work);
  }
  session.stop();
  out.session = session.outcome();
  if (interrupted()) return error(Trouble::interrupted, "stopped");
  return drawn;
}

void print(const Options& options, const Outcome& out) {
  const rt::TickSummary& tick = out.session.timing;
  if (options.json) {
    nlohmann::ordered_json json;
    json["gpu"] = out.gpu;
    json["size"] = {options.size.width, options.size.height};
    json["working_fps"] = 1e3 / out.work.quantile(0.5);
    json["whole_fps"] = 1e3 / out.orbit.quantile(0.5);
    json["first_frame_ms"] = out.first_ms;
    json["work"] = out.work.json();
    json["whole"] = out.orbit.json();
    json["whole_with_hidden"] = out.everything.json();
    json["tick_us"] = {
        {"p50", tick.p50_us}, {"p99", tick.p99_us}, {"p999", tick.p999_us}, {"max", tick.max_us}};
    json["missed_ticks"] = tick.missed;
    json["removed_mm3"] = 1e9 * out.session.ledger.removed;
    fmt::print("{}\n", json.dump());
    return;
  }
  fmt::print("{} x {} on {}, full quality\n", options.size.width, options.size.height, out.gpu);
  const auto line = [](const char* what, const Frames& frames) {
    fmt::print(
        "{:<28} {:5.1f} frames/s; {:6.1f} ms p50, {:6.1f} p95; {:5.0f} patches, {:.0f} k "
        "triangles\n",
        what, 1e3 / frames.quantile(0.5), frames.quantile(0.5), frames.quantile(0.95),
        frames.mean(frames.patches), 1e-3 * frames.mean(frames.triangles));
  };
  line("the work while it is milled", out.work);
  line("the whole bone, turning", out.orbit);
  line("the same with hidden bone", out.everything);
  fmt::print(
      "first frame {:.0f} ms; tick p50 {:.0f}, p99 {:.0f}, p99.9 {:.0f} us, {} of {} left out\n",
      out.first_ms, tick.p50_us, tick.p99_us, tick.p999_us, tick.missed, tick.ticks);
}

Status run(Options options) {
  if (options.volume.path.empty()) options.volume.path = "phantom:temporal-bone";
  auto opened = open_volume(options.volume, progress());
  if (!opened) return opened.error();
  const double radius = 0.5e-3 * options.burr_mm;
  auto place = sim::find_work_place(*opened->bone, radius, {}, {});
  if (!place) return place.error();
  auto pockets = pockets_again(*place, radius, kPocket, options.seconds + kPocket);
  if (!pockets) return pockets.error();
  sim::SessionSettings settings;
  settings.realtime = true;
  settings.servo.rate_hz = options.rate_hz;
  settings.servo.burr.radius = radius;
  auto session = sim::Session::make(
      std::move(opened->bone),
      std::make_unique<device::SimulatedHand>(std::move(pockets->path), device::ArmSettings{}),
      settings, progress());
  if (!session) return session.error();
  auto renderer = render::Renderer::offscreen();
  if (!renderer) return renderer.error();
  (*renderer)->resize_offscreen(options.size.width, options.size.height);

  Outcome out;
  out.gpu = (*renderer)->gpu();
  surface::Worker worker((*session)->bone(), 1);
  render::Scene scene = scene_of_work((*session)->bone(), radius, place->at, -place->into);
  scene.look = {};
  scene.tissue_colours = render::colours_of((*session)->bone().tissues());
  const Status skinned =
      worker.first(progress(), [&](const surface::Skin& skin) { put_skin(scene, skin); });
  if (!skinned) return skinned;
  const Status turned = orbit(options, **renderer, scene, out);
  if (!turned) return turned;
  const Status worked = work(options, **session, worker, **renderer, scene, out);
  if (!worked) return worked;
  print(options, out);
  return fine();
}

void add(CLI::App& bench, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command =
      bench.add_subcommand("frame", "how fast the bone is drawn, at rest and while it is milled");
  command->add_option("volume", options->volume.path,
                      "file, DICOM folder, or phantom:NAME (default: phantom:temporal-bone)");
  command->add_option("--seconds", options->seconds, "of milling")
      ->check(CLI::Range(1.0, 36'000.0))
      ->capture_default_str();
  command->add_option("--turns", options->turns, "frames of the orbit")
      ->check(CLI::Range(2, 10'000))
      ->capture_default_str();
  command->add_option("--burr-mm", options->burr_mm, "diameter of the burr")->capture_default_str();
  command->add_option("--rate", options->rate_hz, "ticks a second")->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object on the last line");
  add_picture_size(*command, options->size);
  add_volume_options(*command, options->volume);
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const BenchCommand command{60, add};

}  // namespace
}  // namespace burr::app
