// burr bench tick - time of one tick, on the scene with which CHAI3D was measured, and the error of
// its force.
//
// Scene: cube of 49.2 mm in n^3 voxels, a ball of 19.7 mm radius, a rigid hand dragged along a
// tilted great circle at a commanded depth, 1 kN/m, no friction. The clock is the thread's CPU time
// for the whole tick; wall time is given too.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/bench.h"
#include "bench/bench_tool.h"
#include "burr/device/simulated_hand.h"
#include "burr/haptics/force_steps.h"
#include "burr/math/rotation.h"
#include "burr/phantom/build.h"
#include "burr/rt/clock.h"
#include "burr/rt/simd.h"
#include "burr/tick/servo.h"
#include "shared/json_line.h"

namespace {

using namespace burr;
using app::quantile;
using math::Vec3;

struct Options {
  int size = 512;
  std::string shape = "ball", mill, touch = "constraint", removal = "energy";
  double burr_mm = 6, depth_mm = 0.5, speed_mm_s = 20, sink_mm = 3;
  int ticks = 3000;
  double rate_hz = 1000;
  bool evict = false, json = false;
};

constexpr int kWarmUp = 400;           // ticks from free air into contact, not counted
constexpr double kGathers = 0.1;       // until the hand has its full speed [s]
constexpr double kSurfaceSpeed = 8.4;  // of the burr; 3.4 mm^3/s per N in cortical bone [m/s]

// The hand's path; `out` gets the true direction of the force at each time.
device::HandPath hand_path(const Options& options) {
  const double dt = 1 / options.rate_hz, r = options.burr_mm * 0.5e-3,
               depth = options.depth_mm * 1e-3;
  const double speed = options.speed_mm_s * 1e-3, ball = phantom::kPeersBall;
  const Vec3 a(1, 0, 0), b(0, 0.8, 0.6), side = a.cross(b);
  device::HandPath path;
  double angle = 0;
  for (int n = 0; n < kWarmUp + options.ticks; ++n) {
    const int counted = std::max(0, n - kWarmUp);
    double sunk = depth, above = n < kWarmUp ? 3e-3 * (1 - static_cast<double>(n) / kWarmUp) : 0;
    if (options.mill == "plunge") sunk = std::min(options.sink_mm * 1e-3, 3e-3 * counted * dt);
    if (options.mill == "slot") sunk = std::min(options.sink_mm * 1e-3, 6e-3 * counted * dt);
    // a hand needs time to gain speed: from rest to full speed in a tenth of a second
    const double begins = options.mill == "slot" ? 0.5 : 0;
    const double gathered = std::clamp((counted * dt - begins) / kGathers, 0.0, 1.0);
    if (options.mill != "plunge") angle += gathered * speed * dt / (ball + r - sunk);
    Vec3 at = (ball + r - sunk + above) * (std::cos(angle) * a + std::sin(angle) * b);
    if (options.shape == "box") {  // along the top face of a box, through the region near its edge
                                   // and back
      const double half = 15e-3, way = std::fmod(speed * dt * counted, 4 * 0.8 * half);
      const double along = way < 2 * 0.8 * half ? way - 0.8 * half : 3 * 0.8 * half - way;
      at = Vec3(along, 0.3 * along, half + r - sunk + above);
    }
    // the burr's axis lies along the surface, where it cuts best
    device::PathPoint point{n * dt, {at, math::shortest_rotation(Vec3::UnitZ(), side)}, 1};
    point.pedal = options.mill.empty() ? 0 : 1;
    path.points.push_back(point);
  }
  return path;
}

// What comparable programs do at each step of their march: look at every voxel in the burr's box.
double reference_us(const volume::Bone& bone, double radius) {
  const int reach = static_cast<int>(std::ceil(radius / bone.grid().voxel)) + 1;
  const math::Ijk middle = bone.grid().size / 2;
  std::vector<double> took;
  std::uint64_t seen = 0;
  for (int round = 0; round < 15; ++round) {
    const std::int64_t before = rt::thread_cpu_ns();
    for (int k = -reach; k <= reach; ++k)
      for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i)
          seen +=
              bone.field(middle.x() + i, middle.y() + j, middle.z() + k) >= volume::kIso ? 1U : 0U;
    took.push_back(1e-3 * static_cast<double>(rt::thread_cpu_ns() - before));
  }
  return seen == 0 ? 0 : quantile(took, 0.5);
}

Result<nlohmann::json> measure(const Options& options) {
  if (options.size < 32 || options.size > 1024)
    return error(Trouble::usage, "--size is out of range; use 32 to 1024");
  if (options.ticks < 10) return error(Trouble::usage, "--ticks is out of range; use 10 or more");
  const volume::Grid grid = phantom::peers_grid(options.size);
  app::progress().report(0, "making the bone");
  std::unique_ptr<volume::Bone> bone =
      options.shape == "ball"
          ? phantom::peers_bone(options.size)
          : phantom::bone_from_distance(grid, {}, phantom::box(Vec3::Constant(15e-3)));
  volume::IsoVertices surface(*bone, {}, 2, app::progress());
  device::SimulatedHand hand(hand_path(options), {.stiffness = INFINITY},
                             {.peak_force = 50, .continuous_force = 50, .max_stiffness = 1e5});
  Status opened = hand.open();
  if (!opened) return opened.error();

  const double r = options.burr_mm * 0.5e-3;
  tick::ServoSettings settings;
  settings.rate_hz = options.rate_hz;
  settings.burr.radius = r;
  settings.touch = *haptics::method_named(options.touch);
  settings.removal.law = *edit::law_named(options.removal);
  settings.spindle_rad_s = kSurfaceSpeed / r;
  settings.force = {1000, 0};
  settings.limit.user_force = 50;
  settings.limit.slew = settings.limit.ramp_slew = 1e9;
  settings.friction_scale = settings.friction_turning = 0;
  tick::Servo servo(*bone, surface, hand, settings);

  std::vector<double> cpu_us, wall_us, error_deg, candidates;
  std::vector<std::uint64_t> walk(options.evict ? std::size_t{64} << 17 : 0, 1);  // 64 MiB
  double force_sum = 0, step_most = 0;
  Vec3 last_force = Vec3::Zero();
  haptics::ForceSteps steps(settings.force.stiffness);
  double removed = 0, asked = 0;
  std::uint64_t sink = 0;
  for (int n = 0; n < kWarmUp + options.ticks; ++n) {
    for (std::size_t w = 0; w < walk.size(); w += 8) sink += walk[w]++;
    const auto wall = std::chrono::steady_clock::now();
    const std::int64_t before = rt::thread_cpu_ns();
    const tick::TickRow& row = servo.tick(false);
    const std::int64_t took = rt::thread_cpu_ns() - before;
    const std::chrono::duration<double, std::micro> waited =
        std::chrono::steady_clock::now() - wall;
    servo.publish();
    if (n < kWarmUp) continue;
    cpu_us.push_back(1e-3 * static_cast<double>(took));
    wall_us.push_back(waited.count());
    candidates.push_back(row.contact.candidates);
    const Vec3 force = row.contact.force, hand_at = row.hand.world_from_tool.p;
    const Vec3 truth = options.shape == "ball" ? hand_at : Vec3(0, 0, 1);
    const double both = force.norm() * truth.norm();
    error_deg.push_back(
        both > 0 ? std::acos(std::clamp(force.dot(truth) / both, -1.0, 1.0)) * 180 / M_PI : 90);
    if (n > kWarmUp) step_most = std::max(step_most, (force - last_force).norm());
    last_force = force;
    steps.add(hand_at, force);
    force_sum += force.norm();
    removed = row.ledger.removed;
    asked = row.ledger.asked;
  }
  if (sink == 42) fmt::print("\n");  // keeps the compiler from removing the walk

  const double reference = reference_us(*bone, r), p50 = quantile(cpu_us, 0.5);
  nlohmann::json out;
  out["size"] = options.size;
  out["shape"] = options.shape;
  out["burr_mm"] = options.burr_mm;
  out["speed_mm_s"] = options.speed_mm_s;
  out["mill"] = options.mill;
  out["touch"] = options.touch;
  out["removal"] = options.removal;
  out["sink_mm"] = options.sink_mm;
  out["evict"] = options.evict;
  out["simd"] = rt::name(rt::simd());
  out["p50_us"] = p50;
  out["p99_us"] = quantile(cpu_us, 0.99);
  out["p999_us"] = quantile(cpu_us, 0.999);
  out["max_us"] = quantile(cpu_us, 1);
  out["over_1ms"] =
      std::count_if(cpu_us.begin(), cpu_us.end(), [](double us) { return us > 1000; });
  out["wall_us"] = {{"p50", quantile(wall_us, 0.5)},
                    {"p99", quantile(wall_us, 0.99)},
                    {"max", quantile(wall_us, 1)}};
  out["direction_error_deg"] = {{"p50", quantile(error_deg, 0.5)},
                                {"p99", quantile(error_deg, 0.99)}};
  out["mean_force_N"] = force_sum / options.ticks;
  out["removed_mm3"] = removed * 1e9;
  out["asked_mm3"] = asked * 1e9;
  out["force_step_N_max"] = step_most;
  out["excess_step_N_max"] = steps.most();
  out["candidates_p50"] = quantile(candidates, 0.5);
  out["reference_us"] = reference;
  out["ratio"] = reference / p50;
  return out;
}

Status run(const Options& options) {
  const auto measured = measure(options);
  if (!measured) return measured.error();
  const nlohmann::json& out = *measured;
  if (options.json) {
    fmt::print("{}\n", app::json_line(out));
    return fine();
  }
  const auto of = [&out](const char* name) { return out.at(name).get<double>(); };
  const nlohmann::json& direction = out.at("direction_error_deg");
  fmt::print(
      "tick {:.1f} us median, {:.1f} p99, {:.1f} p99.9, {:.1f} worst (thread CPU); reference "
      "visit {:.0f} us, {:.0f} times as long\n",
      of("p50_us"), of("p99_us"), of("p999_us"), of("max_us"), of("reference_us"), of("ratio"));
  fmt::print(
      "force {:.4f} N mean, direction off by {:.2f} deg median, {:.2f} p99, largest step {:.4f} "
      "N a tick, {:.4f} N beyond the hand's own move; removed {:.3f} mm3\n",
      of("mean_force_N"), direction.at("p50").get<double>(), direction.at("p99").get<double>(),
      of("force_step_N_max"), of("excess_step_N_max"), of("removed_mm3"));
  return fine();
}

// All touch methods on one scene with one hand: touching, then milling a slide.
Status run_methods(Options options) {
  const bool json = options.json;
  nlohmann::json all = nlohmann::json::array();
  if (!json)
    fmt::print("{:<16} {:<8} {:>9} {:>9} {:>9} {:>9} {:>12} {:>12}\n", "touch", "mill", "p50 us",
               "p99 us", "p99.9 us", "max us", "force N", "off by deg");
  for (const char* mill : {"", "slide"})
    for (const std::string_view method : haptics::kMethodNames) {
      options.touch = method;
      options.mill = mill;
      const auto measured = measure(options);
      if (!measured) return measured.error();
      all.push_back(*measured);
      const auto of = [&](const char* name) { return measured->at(name).get<double>(); };
      if (!json)
        fmt::print("{:<16} {:<8} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>12.3f} {:>12.2f}\n", method,
                   *mill == 0 ? "no" : mill, of("p50_us"), of("p99_us"), of("p999_us"),
                   of("max_us"), of("mean_force_N"),
                   measured->at("direction_error_deg").at("p50").get<double>());
    }
  if (json) fmt::print("{}\n", app::json_line(all));
  return fine();
}

void add_methods(CLI::App& bench, app::Todo& todo) {
  auto options = std::make_shared<Options>();
  options->size = 256;
  auto* command =
      bench.add_subcommand("methods", "measure all methods of touch on the scene of `tick`");
  command->add_option("--size", options->size, "voxels along each edge of the cube")
      ->capture_default_str();
  command->add_option("--burr-mm", options->burr_mm, "diameter of the burr")
      ->check(CLI::Range(0.6, 20.0))
      ->capture_default_str();
  command->add_option("--ticks", options->ticks, "ticks to measure")->capture_default_str();
  command->add_flag("--json", options->json, "one JSON array on the last line");
  command->callback([options, &todo] { todo.work = [options] { return run_methods(*options); }; });
}

void add(CLI::App& bench, app::Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command = bench.add_subcommand("tick", "measure one tick of touch and cutting");
  command->add_option("--size", options->size, "voxels along each edge of the cube")
      ->capture_default_str();
  command->add_option("--shape", options->shape, "ball or box")
      ->check(CLI::IsMember({"ball", "box"}))
      ->capture_default_str();
  command->add_option("--mill", options->mill, "cut while moving")
      ->check(CLI::IsMember({"slide", "slot", "plunge"}));
  command->add_option("--touch", options->touch, "method of touch")
      ->check(CLI::IsMember(haptics::kMethodNames))
      ->capture_default_str();
  command->add_option("--removal", options->removal, "law of removal")
      ->check(CLI::IsMember(edit::kLawNames))
      ->capture_default_str();
  command->add_option("--sink-mm", options->sink_mm, "depth of slot and plunge")
      ->check(CLI::Range(0.01, 10.0))
      ->capture_default_str();
  command->add_option("--burr-mm", options->burr_mm, "diameter of the burr")
      ->check(CLI::Range(0.6, 20.0))
      ->capture_default_str();
  command->add_option("--depth-mm", options->depth_mm, "depth of the hand below the surface")
      ->capture_default_str();
  command->add_option("--speed-mm-s", options->speed_mm_s, "speed of the hand")
      ->capture_default_str();
  command->add_option("--ticks", options->ticks, "ticks to measure")->capture_default_str();
  command->add_option("--rate", options->rate_hz, "ticks a second")
      ->check(CLI::Range(500.0, 10000.0))
      ->capture_default_str();
  command->add_flag("--evict", options->evict,
                    "read 64 MiB between ticks, so that the caches are cold");
  auto tool = std::make_shared<std::string>();
  auto* with_tool = command->add_option(
      "--tool", *tool, "with this tool of the rack, in the five scenes of `burr bench tool`");
  for (const char* other : {"--shape", "--touch", "--removal", "--sink-mm", "--burr-mm",
                            "--depth-mm", "--speed-mm-s", "--rate", "--evict"})
    with_tool->excludes(other);  // those of the scene with one ball
  command->add_flag("--json", options->json,
                    "one JSON object on the last line; with --tool an array of them");
  command->callback([options, tool, command, &todo] {
    if (tool->empty()) {
      todo.work = [options] { return run(*options); };
      return;
    }
    app::ToolBench with;
    with.tool = *tool;
    with.mill = !options->mill.empty();
    with.json = options->json;
    if (command->count("--size") > 0) with.size = options->size;
    if (command->count("--ticks") > 0) with.ticks = options->ticks;
    todo.work = [with] { return app::bench_tools(with); };
  });
}

const app::BenchCommand command{10, add}, methods{12, add_methods};

}  // namespace
