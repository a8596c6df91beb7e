// bench/record - the cost of a recording: ticks per second that the writer can take, bytes per
// tick, and the time to open a moment of a ten-minute recording (worst of many).
#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <random>

#include "burr/record/player.h"
#include "burr/record/recorder.h"

namespace {

using namespace burr;

// A slab of 128^3 voxels with a soft top.
std::unique_ptr<volume::Bone> slab() {
  volume::Grid grid;
  grid.size = {128, 128, 128};
  grid.voxel = 0.2e-3;
  std::vector<volume::Field> field(std::size_t{128} * 128 * 128);
  for (std::size_t v = 0; v < field.size(); ++v)
    field[v] = volume::field_from_depth(100.3 - static_cast<double>(v / (128 * 128)));
  return volume::bone_from_arrays(grid, {}, field, {}, {}, 0);
}

// A hand that moves in circles and trembles: no number stays constant.
tick::TickRow tick_of(std::uint64_t tick, double rate_hz, std::mt19937_64& random) {
  const double t = static_cast<double>(tick) / rate_hz;
  std::normal_distribution<double> tremble(0, 2e-6);
  tick::TickRow row;
  row.tick = tick;
  row.hand.world_from_tool.p = {0.01 * std::cos(t), 0.01 * std::sin(t), 0.001 * std::sin(9 * t)};
  for (int i = 0; i < 3; ++i) row.hand.world_from_tool.p[i] += tremble(random);
  row.hand.velocity = {-0.01 * std::sin(t), 0.01 * std::cos(t), 0.009 * std::cos(9 * t)};
  row.hand.pedal = 1;
  row.contact.proxy = row.hand.world_from_tool.p * 0.98;
  row.contact.normal = math::Vec3(std::cos(t), std::sin(t), 3).normalized();
  row.contact.force = row.contact.normal * (1.5 + tremble(random));
  row.contact.depth = row.contact.force.norm() / 1000;
  row.contact.active = 1;
  row.contact.candidates = static_cast<int>(20 + random() % 9);
  row.contact.touching = true;
  row.ledger.asked = 1e-9 * t + tremble(random) * 1e-9;
  row.ledger.removed = row.ledger.asked * 0.99;
  row.ledger.debt = row.ledger.asked * 0.01;
  row.ledger.energy = t * 0.7;
  row.spindle_rad_s = 6283;
  row.took_us = static_cast<float>(15 + random() % 5);
  row.hash = random();
  return row;
}

// Records `seconds` of milling: every 50 ms the 27 bricks around the burr are written again.
std::string record_session(const volume::Bone& base, double seconds, double rate_hz,
                           record::RecordingStats& account) {
  const auto path = (std::filesystem::temp_directory_path() / "burr_record_bench.mcap").string();
  std::mt19937_64 random(1);
  record::SessionInfo info;
  info.volume.grid = base.grid();
  info.volume.tissues = base.tissues();
  record::Recorder recorder(rate_hz);
  if (const Status started = recorder.start(path, info); !started.ok()) {
    fmt::print(stderr, "{}\n", started.error().text);
    std::exit(1);
  }
  const auto ticks = static_cast<std::uint64_t>(seconds * rate_hz);
  const auto every = static_cast<std::uint64_t>(0.05 * rate_hz);
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    recorder.wait_for_room();
    if (tick % every == 0) {
      const auto step = static_cast<int>(tick / every);
      for (int b = 0; b < 27; ++b) {
        tick::BrickRow row;
        row.tick = tick;
        const int i = (step / 40 + b % 3) % 16, j = (step / 640 + b / 3 % 3) % 16, k = 10 + b / 9;
        row.brick = base.brick_at(i, j, k);
        std::copy_n(base.brick_field(row.brick), volume::kBrickVoxels, row.field.voxel);
        for (int v = 0; v < step % 512; ++v)
          row.field.voxel[v] = static_cast<volume::Field>(row.field.voxel[v] / (2 + step % 7));
        recorder.bricks().push(row);
      }
    }
    recorder.ticks().push(tick_of(tick, rate_hz, random));
  }
  const auto done = recorder.finish();
  if (!done) {
    fmt::print(stderr, "{}\n", done.error().text);
    std::exit(1);
  }
  account = *done;
  return path;
}

void record_ticks(benchmark::State& state) {
  const auto bone = slab();
  record::RecordingStats account;
  for (auto _ : state) record_session(*bone, 60, 1000, account);
  state.SetItemsProcessed(state.iterations() * 60'000);
  state.counters["bytes_per_tick"] =
      static_cast<double>(account.bytes) / static_cast<double>(account.ticks);
}
BENCHMARK(record_ticks)->Unit(benchmark::kMillisecond)->UseRealTime();

void open_a_moment_of_ten_minutes(benchmark::State& state) {
  const auto base = slab();
  record::RecordingStats account;
  const std::string path = record_session(*base, 600, 1000, account);
  std::mt19937_64 random(2);
  std::vector<double> took_ms;
  for (auto _ : state) {
    const double t_s = std::uniform_real_distribution<double>(0, 600)(random);
    const auto bone = slab();
    const auto start = std::chrono::steady_clock::now();
    auto player = record::Player::open(path);
    const Status shown = (*player)->bone_at(t_s, *bone);
    const auto row = (*player)->tick_at(t_s);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (!shown.ok() || !row) state.SkipWithError("the moment cannot be shown");
    state.SetIterationTime(took.count());
    took_ms.push_back(took.count() * 1e3);
  }
  std::sort(took_ms.begin(), took_ms.end());
  state.counters["p50_ms"] = took_ms[took_ms.size() / 2];
  state.counters["worst_ms"] = took_ms.back();
  state.counters["file_MiB"] = static_cast<double>(account.bytes) / 1048576.0;
}
BENCHMARK(open_a_moment_of_ten_minutes)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(50);

}  // namespace

BENCHMARK_MAIN();
