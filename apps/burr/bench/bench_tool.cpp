// burr bench tool - time of one tick with a tool of the rack, touching and cutting, in scenes that such
// tools meet: a plane, a groove, a hole, a slot, rough bone.
//
// A rigid hand moves in curves of Lissajous in three directions and about three axes, at most 100 mm/s
// and 3 rad/s in each, and presses half a millimetre in. 256^3 voxels of 0.25 mm, axes turned by about
// 0.3 rad against the voxels', 1 kN/m. The clock is the thread's CPU time for the whole tick.
#include "bench/bench_tool.h"

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bench/bench.h"
#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/rt/clock.h"
#include "burr/rt/simd.h"
#include "burr/scenario/rack.h"
#include "burr/tick/servo.h"
#include "burr/workshop/mesh_shape.h"
#include "shared/json_line.h"

namespace {

using namespace burr;
using app::quantile;
using math::Vec3;

const std::vector<std::string> kScenes = {"plane", "groove", "hole", "slot", "rough"};
constexpr double kVoxel = 0.25e-3, kPressed = 0.5e-3;  // [m]
constexpr double kHole = 4e-3;                         // radius [m]
constexpr double kSpeed = 0.1, kTurns = 3;             // of the hand, at most [m/s], [rad/s]
constexpr int kWarmUp = 400;                           // ticks from free air into contact
constexpr double kRate = 1000;

using Options = app::ToolBench;

// Half the width of the cutting parts along the tool's x and y, and how far they reach below it.
struct Extent {
  double x = 0, y = 0, below = 0;
};
Extent extent_of(const tool::Tool& tool) {
  Extent out;
  const auto reach = [&](const Vec3& way) {
    double most = 0;
    for (int p = 0; p < tool.count; ++p) {
      const tool::Part& part = tool.parts[static_cast<std::size_t>(p)];
      if (part.role != tool::Role::cuts) continue;
      most = std::max(most, way.dot(part.tool_from_part.p) +
                                tool::support(part.shape, part.tool_from_part.q.conjugate() * way));
    }
    return most;
  };
  out.x = std::max(reach(Vec3::UnitX()), reach(-Vec3::UnitX()));
  out.y = std::max(reach(Vec3::UnitY()), reach(-Vec3::UnitY()));
  out.below = reach(-Vec3::UnitZ());
  return out;
}

// In the frame of the scene: its surface is z = 0, bone below.
phantom::Depth depth_of(const std::string& scene, const Extent& tool) {
  const phantom::Depth ground = phantom::slab();
  if (scene == "groove")
    return phantom::placed(phantom::groove(std::numbers::pi / 4),
                           {Vec3(0, 0, -6e-3), math::Quat::Identity()});
  if (scene == "hole") return phantom::without(ground, phantom::cylinder(kHole, 12e-3));
  if (scene == "slot")
    return phantom::without(ground, phantom::box(Vec3(20e-3, tool.y + 0.3e-3, 10e-3)));
  if (scene == "rough")
    return [](const Vec3& p) {
      const auto wave = [](double at, double length) {
        return std::sin(2 * std::numbers::pi * at / length);
      };
      return 0.9 * (-p.z() + 0.4e-3 * (wave(p.x(), 5e-3) + wave(p.y(), 6e-3)) +
                    0.25e-3 * wave(p.x() + p.y(), 3.1e-3));
    };
  return ground;
}

// Does the tool have room in this scene at all?
bool fits(const std::string& scene, const Extent& tool) {
  if (scene == "hole") return std::max(tool.x, tool.y) < kHole - 0.2e-3;
  return scene != "slot" || tool.y < 3e-3;
}

device::HandPath path_of(const Options& options, const std::string& scene, const Extent& tool,
                         const math::Quat& world_from_scene) {
  device::HandPath path;
  // how far it moves to each side and how far it turns; narrow places leave less
  double wide_x = 8e-3, wide_y = 8e-3, deep = -tool.below + kPressed;
  if (scene == "hole") {
    wide_x = kHole - tool.x + kPressed;
    wide_y = kHole - tool.y + kPressed;
    deep = 5e-3;
  } else if (scene == "slot") {
    wide_y = 0.3e-3 + kPressed;
    deep = 3e-3;
  } else if (scene == "groove") {
    wide_x = 2e-3;
    deep = 6e-3 - std::numbers::sqrt2 * tool.x + kPressed;
  }
  const auto angular = [&](double wide) { return kSpeed * options.speed / std::max(wide, 1e-3); };
  const double turn_rate = kTurns * options.speed, turned = 0.25;
  for (int n = 0; n < kWarmUp + options.ticks; ++n) {
    const double t = std::max(0, n - kWarmUp) / kRate;
    const double above = n < kWarmUp ? 8e-3 * (1 - static_cast<double>(n) / kWarmUp) : 0;
    const Vec3 at(wide_x * std::sin(angular(wide_x) * t),
                  wide_y * std::sin(0.83 * angular(wide_y) * t),
                  above - deep + kPressed * std::sin(31 * t));
    const Vec3 turn(turned * std::sin(turn_rate / turned * t),
                    turned * std::sin(0.77 * turn_rate / turned * t),
                    turned * std::sin(0.59 * turn_rate / turned * t));
    const double angle = turn.norm();
    const math::Quat q(angle > 0 ? Eigen::AngleAxisd(angle, turn / angle)
                                 : Eigen::AngleAxisd::Identity());
    path.points.push_back(
        {n / kRate, {world_from_scene * at, world_from_scene * q}, options.mill ? 1.0 : 0.0});
  }
  return path;
}

Result<nlohmann::json> measure(const Options& options, const scenario::RackTool& tool,
                               const std::string& scene) {
  const volume::Grid grid = phantom::cube_grid(kVoxel * options.size, options.size);
  const math::Quat turned = Eigen::AngleAxisd(0.31, Vec3::UnitX()) *
                            Eigen::AngleAxisd(0.23, Vec3::UnitY()) *
                            Eigen::AngleAxisd(0.17, Vec3::UnitZ());
  const Extent extent = extent_of(tool.tool);
  const auto bone = phantom::bone_from_distance(
      grid, {}, phantom::placed(depth_of(scene, extent), {Vec3::Zero(), turned}));
  volume::IsoVertices surface(*bone, {}, 2, app::progress());
  device::SimulatedHand hand(path_of(options, scene, extent, turned), {.stiffness = INFINITY},
                             {.peak_force = 50, .continuous_force = 50, .max_stiffness = 1e5});
  const Status opened = hand.open();
  if (!opened) return opened.error();
  tick::ServoSettings settings;
  settings.rate_hz = kRate;
  settings.tools = {{tool.name, tool.tool, tool.cutter}};
  settings.tool = 0;
  settings.force = {1000, 0};
  settings.limit.user_force = 50;
  settings.limit.slew = settings.limit.ramp_slew = 1e9;
  tick::Servo servo(*bone, surface, hand, settings);

  std::vector<double> cpu_us, candidates, rough_n, rough_nmm;
  std::array<Vec3, 2> force{Vec3::Zero(), Vec3::Zero()}, torque = force;
  double force_sum = 0, removed = 0;
  int touching = 0;
  for (int n = 0; n < kWarmUp + options.ticks; ++n) {
    const std::int64_t before = rt::thread_cpu_ns();
    const tick::TickRow& row = servo.tick(false);
    const std::int64_t took = rt::thread_cpu_ns() - before;
    servo.publish();
    const haptics::Contact& contact = row.contact;
    const Vec3 moment = contact.torque + contact.unsent_torque;
    if (n >= kWarmUp) {
      cpu_us.push_back(1e-3 * static_cast<double>(took));
      candidates.push_back(contact.candidates);
      rough_n.push_back((contact.force - 2 * force[0] + force[1]).norm());
      rough_nmm.push_back(1e3 * (moment - 2 * torque[0] + torque[1]).norm());
      force_sum += contact.force.norm();
      touching += contact.touching ? 1 : 0;
      removed = row.ledger.removed;
    }
    force = {contact.force, force[0]};
    torque = {moment, torque[0]};
  }
  nlohmann::json out;
  out["tool"] = tool.name;
  out["scene"] = scene;
  out["mill"] = options.mill;
  out["ticks"] = options.ticks;
  out["simd"] = rt::name(rt::simd());
  out["p50_us"] = quantile(cpu_us, 0.5);
  out["p99_us"] = quantile(cpu_us, 0.99);
  out["p999_us"] = quantile(cpu_us, 0.999);
  out["max_us"] = quantile(cpu_us, 1);
  out["over_1ms"] =
      std::count_if(cpu_us.begin(), cpu_us.end(), [](double us) { return us > 1000; });
  out["candidates_p50"] = quantile(candidates, 0.5);
  out["mean_force_N"] = force_sum / options.ticks;
  out["touching"] = static_cast<double>(touching) / options.ticks;
  out["second_difference_N_p99"] = quantile(rough_n, 0.99);
  out["second_difference_N_mm_p99"] = quantile(rough_nmm, 0.99);
  out["removed_mm3"] = 1e9 * removed;
  return out;
}

}  // namespace

Status burr::app::bench_tools(const ToolBench& options) {
  scenario::Rack rack = scenario::built_in_rack();
  if (!options.tools.empty()) {
    auto read = scenario::read_rack(options.tools, workshop::mesh_shape);
    if (!read) return read.error();
    rack = std::move(*read);
  }
  std::vector<scenario::RackTool> tools = rack.all;
  if (options.tool != "all") {
    const auto named = rack.get(options.tool);
    if (!named) return named.error();
    tools = {*named};
  }
  nlohmann::json all = nlohmann::json::array();
  if (!options.json)
    fmt::print("{:<18} {:<7} {:>7} {:>7} {:>8} {:>7} {:>6} {:>7} {:>7} {:>8} {:>9}\n", "tool",
               "scene", "p50 us", "p99 us", "p99.9 us", "max us", "points", "force N", "ddF N",
               "ddT N mm", "cut mm3");
  for (const scenario::RackTool& tool : tools)
    for (const std::string& scene : kScenes) {
      if (options.scene != "all" && options.scene != scene) continue;
      if (!fits(scene, extent_of(tool.tool))) continue;
      const auto measured = measure(options, tool, scene);
      if (!measured) return measured.error();
      all.push_back(*measured);
      const auto of = [&](const char* name) { return measured->at(name).get<double>(); };
      if (options.json) continue;
      fmt::print(
          "{:<18} {:<7} {:>7.1f} {:>7.1f} {:>8.1f} {:>7.1f} {:>6.0f} {:>7.2f} {:>7.3f} {:>8.2f} "
          "{:>9.2f}\n",
          tool.name, scene, of("p50_us"), of("p99_us"), of("p999_us"), of("max_us"),
          of("candidates_p50"), of("mean_force_N"), of("second_difference_N_p99"),
          of("second_difference_N_mm_p99"), of("removed_mm3"));
    }
  if (options.json) fmt::print("{}\n", app::json_line(all));
  return fine();
}

namespace {

void add(CLI::App& bench, app::Todo& todo) {
  auto options = std::make_shared<Options>();
  std::vector<std::string> scenes = kScenes;
  scenes.emplace_back("all");
  auto* command = bench.add_subcommand("tool", "measure one tick with the tools of the rack");
  command->add_option("--tool", options->tool, "one of the rack, or all")->capture_default_str();
  command->add_option("--tools", options->tools, "F.toml: custom tools for the rack");
  command->add_option("--scene", options->scene, "plane, groove, hole, slot, rough or all")
      ->check(CLI::IsMember(scenes))
      ->capture_default_str();
  command->add_flag("--mill", options->mill, "cut as well");
  command->add_option("--ticks", options->ticks, "ticks to measure in each scene")
      ->check(CLI::Range(10, 1'000'000))
      ->capture_default_str();
  command->add_option("--speed", options->speed, "of the hand, over 100 mm/s and 3 rad/s")
      ->check(CLI::Range(0.01, 10.0))
      ->capture_default_str();
  command->add_option("--size", options->size, "voxels of 0.25 mm along each edge of the cube")
      ->check(CLI::Range(64, 512))
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON array on the last line");
  command->callback(
      [options, &todo] { todo.work = [options] { return app::bench_tools(*options); }; });
}

const app::BenchCommand command{11, add};

}  // namespace
