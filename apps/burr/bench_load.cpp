// burr bench load / memory - from a file on disk to the first whole surface: how long, and how much
// memory.
#include <fmt/core.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "bench.h"
#include "burr/device/simulated_hand.h"
#include "burr/sim/motion.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "volume_options.h"

namespace {

using namespace burr;

struct Options {
  app::VolumeOptions volume;
  double burr_mm = 5;
  bool json = false;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// VmHWM (the most ever) or VmRSS (now) of this process  [MB]; 0 where the system does not say
double memory_mb(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(field + ":", 0) == 0) return std::stod(line.substr(field.size() + 1)) / 1024;
  return 0;
}

Status load(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  auto opened = app::open_volume(options.volume, app::progress());
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
    fmt::print("{}\n", nlohmann::json{{"wall_s", wall_s},
                                      {"bone_s", bone_s},
                                      {"surface_s", wall_s - bone_s},
                                      {"triangles", triangles},
                                      {"voxel_mm", opened->summary.voxel_mm}}
                           .dump());
  } else {
    fmt::print(
        "{:.2f} s to the first whole surface: {:.2f} s to the bone, {:.2f} s for {} triangles\n",
        wall_s, bone_s, wall_s - bone_s, triangles);
  }
  return fine();
}

// As a session has it: bone, surface for touch, undo memory, visible surface; a second of milling.
Status memory(const Options& options) {
  auto opened = app::open_volume(options.volume, app::progress());
  if (!opened) return opened.error();
  const double radius = 0.5e-3 * options.burr_mm;
  auto place = sim::find_work_place(*opened->bone, radius, {}, {});
  if (!place) return place.error();
  auto path = sim::motion("pocket", *place, radius, 2);
  if (!path) return path.error();
  sim::SessionSettings settings;
  settings.servo.burr.radius = radius;
  auto session =
      sim::Session::make(std::move(opened->bone),
                         std::make_unique<device::SimulatedHand>(*path, device::ArmSettings{}),
                         settings, app::progress());
  if (!session) return session.error();
  surface::Worker worker((*session)->bone(), 2);
  std::vector<surface::Patch> patches;  // kept, as a picture would
  const Status skinned = worker.first(
      app::progress(), [&patches](const surface::Skin& skin) { patches.push_back(*skin.mesh); });
  if (!skinned) return skinned;
  (*session)->run(1, app::progress());
  const double peak = memory_mb("VmHWM"), steady = memory_mb("VmRSS");
  if (options.json) {
    fmt::print("{}\n",
               nlohmann::json{
                   {"peak_MB", peak},
                   {"steady_MB", steady},
                   {"bone_MB", 1e-6 * 1536 * static_cast<double>((*session)->bone().used_slots())},
                   {"touch_MB", 1e-6 * static_cast<double>((*session)->surface().memory_bytes())}}
                   .dump());
  } else {
    fmt::print("{:.0f} MB at most, {:.0f} MB now, of which the surface for touch {:.0f} MB\n", peak,
               steady, 1e-6 * static_cast<double>((*session)->surface().memory_bytes()));
  }
  return fine();
}

void add(CLI::App& bench, app::Todo& todo) {
  const auto one = [&](const char* name, const char* what, Status (*work)(const Options&)) {
    auto options = std::make_shared<Options>();
    auto* command = bench.add_subcommand(name, what);
    command->add_option("volume", options->volume.path, "file, DICOM folder, or phantom:NAME")
        ->required();
    command->add_flag("--json", options->json, "one JSON object on the last line");
    app::add_volume_options(*command, options->volume);
    command->callback(
        [options, &todo, work] { todo.work = [options, work] { return work(*options); }; });
    return command;
  };
  one("load", "from disk to the first whole surface", load);
  one("memory", "what a session of this bone takes", memory);
}

const app::BenchCommand command{40, add};

}  // namespace
