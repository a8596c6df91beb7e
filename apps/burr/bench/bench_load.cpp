// burr bench load / memory - from a file on disk to the first whole surface: time and memory.
#include <fmt/core.h>
#include <sys/resource.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/bench.h"
#include "burr/device/simulated_hand.h"
#include "burr/render/scene.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "burr/surgeon/motion.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"
#include "shared/json_line.h"
#include "shared/volume_words.h"

namespace {

using namespace burr;

struct Options {
  scenario::BoneRecipe volume;
  double burr_mm = 5;
  bool json = false;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// VmHWM (largest so far) or VmRSS (now) of this process, including memory shared with others [MB];
// 0 where the system does not report it.
double memory_mb(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(field + ":", 0) == 0) return std::stod(line.substr(field.size() + 1)) / 1024;
  return 0;
}

Status load(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  auto opened = workshop::open_bone(options.volume, app::progress());
  if (!opened) return opened.error();
  const double bone_s = seconds_since(start);
  surface::Worker worker(*opened->bone, 2);
  std::size_t triangles = 0;
  const Status skinned = worker.first(app::progress(), [&triangles](const surface::Skin& skin) {
    triangles += skin.mesh->triangles.size() / 3;
  });
  if (!skinned) return skinned;
  const double wall_s = seconds_since(start);
  if (options.json) {
    fmt::print("{}\n", app::json_line(nlohmann::json{{"wall_s", wall_s},
                                                     {"bone_s", bone_s},
                                                     {"surface_s", wall_s - bone_s},
                                                     {"triangles", triangles},
                                                     {"voxel_mm", opened->summary.voxel_mm}}));
  } else {
    fmt::print(
        "{:.2f} s to the first complete surface: {:.2f} s to the bone, {:.2f} s for {} triangles\n",
        wall_s, bone_s, wall_s - bone_s, triangles);
  }
  return fine();
}

// Passes progress on and records the memory at the end of each stage.
class Stages final : public Progress {
 public:
  struct Stage {
    std::string name;
    double now_mb = 0, most_mb = 0;  // at its end; most_mb is the largest since the program started
  };
  void report(double fraction, std::string_view stage) override {
    app::progress().report(fraction, stage);
    if (meanwhile) meanwhile();
    if (const auto numbered = base::numbered_stage(stage)) stage = numbered->words;
    if (stage == stage_) return;
    end();
    stage_ = stage;
  }
  [[nodiscard]] bool cancelled() const override { return app::progress().cancelled(); }
  void end() {
    if (!stage_.empty()) all_.push_back({stage_, memory_mb("VmRSS"), memory_mb("VmHWM")});
    stage_.clear();
  }
  [[nodiscard]] const std::vector<Stage>& all() const { return all_; }

  std::function<void()> meanwhile;  // work that the caller's thread does meanwhile

 private:
  std::string stage_;
  std::vector<Stage> all_;
};

// As in a session with a picture: bone, surface for touch, undo memory, visible surface; one second
// of milling. The memory of the graphics card, or of its software replacement, is not included.
Status memory(const Options& options) {
  Stages stages;
  stages.report(0, "the program");
  auto opened = workshop::open_bone(options.volume, stages);
  if (!opened) return opened.error();
  const double radius = 0.5e-3 * options.burr_mm;
  stages.report(0, "preparing the session");
  auto place = surgeon::find_work_place(*opened->bone, radius, {}, {});
  if (!place) return place.error();
  auto path = surgeon::motion("pocket", *place, radius, 2);
  if (!path) return path.error();
  sim::SessionSettings settings;
  settings.servo.burr.radius = radius;
  auto session =
      workshop::begin_by_itself(std::move(opened->bone), std::move(*path), settings, stages);
  if (!session) return session.error();
  surface::Worker worker((*session)->bone(), 2);
  render::Scene scene;
  std::size_t triangles = 0;
  const auto show = [&scene](const surface::Skin& skin) {
    render::set_patch(scene, skin.patch, *skin.mesh);
  };
  const Status skinned = worker.first(stages, [&](const surface::Skin& skin) {
    triangles += skin.mesh->triangles.size() / 3;
    show(skin);
  });
  if (!skinned) return skinned;
  stages.meanwhile = [&] {
    for (surface::Skin skin; worker.take(skin); worker.give_back(skin)) show(skin);
  };
  (*session)->run(1, stages);
  stages.end();
  const double peak = memory_mb("VmHWM"), steady = memory_mb("VmRSS");
  rusage children = {};  // the reader was a process of its own, which has ended
  getrusage(RUSAGE_CHILDREN, &children);
  const double reader = static_cast<double>(children.ru_maxrss) / 1024;
  const double touch = 1e-6 * static_cast<double>((*session)->surface().memory_bytes());
  if (options.json) {
    nlohmann::json table = nlohmann::json::array();
    for (const Stages::Stage& stage : stages.all())
      table.push_back(
          {{"stage", stage.name}, {"now_MB", stage.now_mb}, {"most_MB", stage.most_mb}});
    fmt::print("{}\n",
               app::json_line(nlohmann::json{
                   {"peak_MB", peak},
                   {"steady_MB", steady},
                   {"reader_peak_MB", reader},
                   {"bone_MB", 1e-6 * static_cast<double>((*session)->bone().memory_bytes())},
                   {"touch_MB", touch},
                   {"triangles", triangles},
                   {"stages", table}}));
  } else {
    for (const Stages::Stage& stage : stages.all())
      fmt::print("{:24} {:5.0f} MB, at most {:5.0f} MB so far\n", stage.name, stage.now_mb,
                 stage.most_mb);
    fmt::print(
        "{:.0f} MB at most, {:.0f} MB now, of which the surface for touch {:.0f} MB; {} "
        "triangles\n",
        peak, steady, touch, triangles);
  }
  return fine();
}

void add(CLI::App& bench, app::Todo& todo) {
  const auto one = [&](const char* name, const char* what, Status (*work)(const Options&)) {
    auto options = std::make_shared<Options>();
    auto* command = bench.add_subcommand(name, what);
    command->add_option("volume", options->volume.source, "file, DICOM folder, or phantom:NAME")
        ->required();
    command->add_flag("--json", options->json, "one JSON object on the last line");
    app::add_volume_options(*command, options->volume);
    command->callback(
        [options, &todo, work] { todo.work = [options, work] { return work(*options); }; });
    return command;
  };
  one("load", "measure the time from the file to the first complete surface", load);
  one("memory", "measure the memory of a session with this bone", memory);
}

const app::BenchCommand command{40, add};

}  // namespace
