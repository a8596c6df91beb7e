// burr bench piece - time of one tick with a piece of bone in the hand: the front segment of the built-in
// jaw, cut free along the plane of the case.
//
// The kerf is made by formula, so that no tool leaves a bridge. A rigid hand lifts the segment by its plan
// and swings about there in curves of Lissajous, pressing it on the bone on both sides of the kerf; 1 kN/m.
// The clock is the thread's CPU time for the whole tick.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/bench.h"
#include "burr/device/replayed_hand.h"
#include "burr/edit/piece_store.h"
#include "burr/math/turn.h"
#include "burr/rt/clock.h"
#include "burr/rt/flags.h"
#include "burr/rt/simd.h"
#include "burr/scenario/case.h"
#include "burr/sim/move_pieces.h"
#include "burr/surgeon/plane_cut.h"
#include "burr/tick/held_piece.h"
#include "burr/tick/servo.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"
#include "shared/json_line.h"

namespace {

using namespace burr;
using app::quantile;
using math::Vec3;

struct Options {
  double kerf_mm = 0.7, speed = 1;
  int ticks = 5000;
  bool json = false;
};

constexpr double kRate = 1000, kSpeed = 0.1, kTurns = 3;  // of the hand, at most [m/s], [rad/s]
constexpr double kWide = 2e-3, kTurned = 0.05;            // how far it swings  [m], [rad]

// The bone with everything gone that lies in the kerf, beside its plane by half of `kerf`.
std::unique_ptr<volume::Bone> with_kerf(const volume::Bone& bone, const Vec3& point,
                                        const Vec3& normal, double kerf) {
  const volume::Grid& grid = bone.grid();
  auto out = std::make_unique<volume::Bone>(grid, bone.tissues(), bone.used_slots(), 4096, false);
  std::vector<volume::Field> field(volume::kBrickVoxels);
  const std::vector<volume::TissueId> none(volume::kBrickVoxels, 0);
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const volume::Field* const was = bone.brick_field(brick);
    if (was == nullptr) continue;
    const math::Ijk first = bone.brick_ijk(brick);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const Vec3 p =
          grid.world_from_grid((first + math::Ijk(v & 7, v >> 3 & 7, v >> 6)).cast<double>());
      const double outside = (std::abs((p - point).dot(normal)) - 0.5 * kerf) / grid.voxel;
      const double most = volume::kIso + volume::kFieldPerVoxel * outside;
      field[static_cast<std::size_t>(v)] =
          std::min(was[v], static_cast<volume::Field>(std::clamp(most, 0.0, 65535.0)));
    }
    const volume::TissueId* const tissue = bone.brick_tissue(brick);
    out->build_brick(brick, field.data(), tissue != nullptr ? tissue : none.data());
  }
  out->pack();
  return out;
}

Result<std::unique_ptr<volume::Bone>> jaw(double kerf) {
  const auto work = scenario::read_case("jaw");
  if (!work) return work.error();
  auto opened = workshop::open_bone(workshop::recipe_of(*work, {}), app::progress());
  if (!opened) return opened.error();
  const auto lesson = workshop::placed_lesson(*work);
  if (!lesson) return lesson.error();
  const auto plane = surgeon::plane_of(*lesson, "divide");
  if (!plane) return plane.error();
  return with_kerf(*opened->bone, plane->at, plane->normal, kerf);
}

Result<nlohmann::json> measure(const Options& options) {
  auto bone = jaw(1e-3 * options.kerf_mm);
  if (!bone) return bone.error();
  volume::IsoVertices surface(**bone, {.reserve_blocks = 1 << 14}, 2, app::progress());
  device::ReplayedHand hand({.peak_force = 50, .continuous_force = 50, .max_stiffness = 1e5});
  tick::ServoSettings settings;
  settings.rate_hz = kRate;
  settings.force = {1000, 0};
  settings.limit.user_force = 50;
  settings.limit.slew = settings.limit.ramp_slew = 1e9;
  tick::Servo servo(**bone, surface, hand, settings);
  edit::PieceStore store;
  const auto piece = store.find(**bone, Vec3(-6.4, -35, -21.5) * 1e-3, 5e-3);
  if (!piece) return piece.error();
  device::HandState now;
  now.world_from_tool.p = piece->centre;
  hand.set(now);
  static_cast<void>(servo.tick(false));

  edit::PieceMove move = sim::further(*piece, Vec3::Zero(), math::Quat::Identity());
  move.writes = servo.writes_done();
  const auto wall = rt::monotonic_ns();
  const auto prepared = store.prepare_lift(**bone, move);
  if (!prepared) return prepared.error();
  const double prepared_ms = 1e-6 * static_cast<double>(rt::monotonic_ns() - wall);
  move.bricks = prepared->bricks->hash;
  move.body = prepared->bricks->body.hash;
  (*bone)->commit_ahead();
  servo.commit_ahead();
  if (!servo.lay_ready(*prepared->bricks) ||
      !servo.commands().push({tick::CommandKind::lift_piece, 0, move}))
    return error(Trouble::internal, "the command to lift the piece did not reach the servo");
  int lift_ticks = 0;
  for (; !servo.piece().lifted() && lift_ticks < 10000; ++lift_ticks)
    static_cast<void>(servo.tick(false));
  if (!servo.piece().lifted()) return error(Trouble::internal, "the piece was not lifted");

  std::vector<double> cpu_us, candidates;
  double force_sum = 0;
  int touching = 0, lagging = 0;
  const double rate = kSpeed * options.speed / kWide, turn_rate = kTurns * options.speed / kTurned;
  for (int n = 0; n < options.ticks; ++n) {
    const double t = n / kRate;
    now.pedal = n < 2 ? 0 : 1;
    now.world_from_tool.p =
        piece->centre +
        kWide * Vec3(std::sin(rate * t), std::sin(0.83 * rate * t), std::sin(0.61 * rate * t));
    now.world_from_tool.q =
        math::turned(math::Quat::Identity(),
                     kTurned * Vec3(std::sin(turn_rate * t), std::sin(0.77 * turn_rate * t),
                                    std::sin(0.59 * turn_rate * t)));
    hand.set(now);
    const std::int64_t before = rt::thread_cpu_ns();
    const tick::TickRow& row = servo.tick(false);
    const std::int64_t took = rt::thread_cpu_ns() - before;
    servo.publish();
    cpu_us.push_back(1e-3 * static_cast<double>(took));
    candidates.push_back(row.contact.candidates);
    force_sum += row.contact.force.norm();
    touching += row.contact.touching ? 1 : 0;
    lagging += (row.contact.flags & rt::kFlagLagging) != 0 ? 1 : 0;
  }
  const tool::ShapeGrid& grid = *prepared->bricks->body.tool.parts[0].shape.grid;
  nlohmann::json out;
  out["volume_mm3"] = 1e9 * piece->volume;
  out["nodes"] = {grid.size[0], grid.size[1], grid.size[2]};
  out["cell_mm"] = 1e3 * prepared->bricks->body.tool.parts[0].shape.a;
  out["voxel_mm"] = 1e3 * (*bone)->grid().voxel;
  out["prepared_ms"] = prepared_ms;
  out["lift_ticks"] = lift_ticks;
  out["ticks"] = options.ticks;
  out["simd"] = rt::name(rt::simd());
  out["p50_us"] = quantile(cpu_us, 0.5);
  out["p99_us"] = quantile(cpu_us, 0.99);
  out["p999_us"] = quantile(cpu_us, 0.999);
  out["max_us"] = quantile(cpu_us, 1);
  out["over_1ms"] =
      std::count_if(cpu_us.begin(), cpu_us.end(), [](double us) { return us > 1000; });
  out["candidates_p50"] = quantile(candidates, 0.5);
  out["candidates_max"] = quantile(candidates, 1);
  out["mean_force_N"] = force_sum / options.ticks;
  out["touching"] = static_cast<double>(touching) / options.ticks;
  out["lagging"] = static_cast<double>(lagging) / options.ticks;
  return out;
}

Status run(const Options& options) {
  const auto measured = measure(options);
  if (!measured) return measured.error();
  if (options.json) {
    fmt::print("{}\n", app::json_line(*measured));
    return fine();
  }
  const auto of = [&](const char* name) { return measured->at(name).get<double>(); };
  fmt::print(
      "piece of {:.0f} mm3, cells of {:.2f} mm, prepared in {:.0f} ms, lifted in {:.0f} ticks\n"
      "tick {:.1f} us median, {:.1f} p99, {:.1f} p99.9, {:.1f} worst (thread CPU); {:.0f} points "
      "median, {:.0f} most\n"
      "force {:.2f} N mean, touching in {:.0f} %, lagging in {:.1f} % of the ticks\n",
      of("volume_mm3"), of("cell_mm"), of("prepared_ms"), of("lift_ticks"), of("p50_us"),
      of("p99_us"), of("p999_us"), of("max_us"), of("candidates_p50"), of("candidates_max"),
      of("mean_force_N"), 100 * of("touching"), 100 * of("lagging"));
  return fine();
}

void add(CLI::App& bench, app::Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command =
      bench.add_subcommand("piece", "measure one tick with a piece of bone in the hand");
  command->add_option("--kerf-mm", options->kerf_mm, "width of the cut that frees it")
      ->check(CLI::Range(0.3, 3.0))
      ->capture_default_str();
  command->add_option("--ticks", options->ticks, "ticks to measure")
      ->check(CLI::Range(10, 1'000'000))
      ->capture_default_str();
  command->add_option("--speed", options->speed, "of the hand, over 100 mm/s and 3 rad/s")
      ->check(CLI::Range(0.01, 10.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object on the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const app::BenchCommand command{12, add};

}  // namespace
