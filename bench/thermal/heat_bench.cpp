// bench/thermal/heat_bench.cpp - the cost of computing one second of heat in bone.
//
// A cube of 40 mm with voxels of 0.25 mm, all bone except the upper quarter; cells of 1 mm or 0.5
// mm. A burr mills wet in the middle of its surface, warm enough that doses are counted.
//   second    one second of the session: twenty steps of 50 ms
//   summary   one summary; there are ten per second
//   look      reading four bricks that were cut
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "burr/thermal/heating.h"

namespace {

using burr::math::Vec3;
namespace thermal = burr::thermal;
namespace volume = burr::volume;

constexpr int kEdge = 160;          // [voxel]
constexpr double kVoxel = 0.25e-3;  // [m]
constexpr int kTop = 120;           // first slice of air

std::unique_ptr<volume::Bone> bone() {
  volume::Grid grid;
  grid.size = {kEdge, kEdge, kEdge};
  grid.voxel = kVoxel;
  std::vector<volume::Field> field(std::size_t{kEdge} * kEdge * kEdge);
  for (std::size_t v = 0; v < field.size(); ++v)
    field[v] = volume::field_from_depth(kTop - 0.5 - static_cast<double>(v / (kEdge * kEdge)));
  return volume::bone_from_arrays(grid, {}, field, {}, {}, 64);
}

struct Milling {
  explicit Milling(double cell)
      : milled(bone()),
        heating(*milled, {Vec3::Zero(), Vec3::Constant(kEdge * kVoxel)}, {.cell = cell}) {
    row.place = Vec3(20e-3, 20e-3, (kTop - 1) * kVoxel);
    row.radius = 2e-3;
    row.irrigated = true;
    row.energy = 5e-3;
    for (int n = 0; n < 20; ++n) second();
  }
  void second() {
    for (int tick = 0; tick < 1000; ++tick, row.time_ns += 1'000'000)
      benchmark::DoNotOptimize(heating.take(row));
  }
  std::unique_ptr<volume::Bone> milled;
  thermal::Heating heating;
  thermal::HeatRow row;
};

double cell_of(const benchmark::State& state) { return 1e-6 * static_cast<double>(state.range(0)); }

void second(benchmark::State& state) {
  Milling milling(cell_of(state));
  for (auto _ : state) milling.second();
  state.counters["cells"] = milling.heating.grid().box().count.prod();
  state.counters["hottest_c"] = milling.heating.sum_up().hottest_c;
}
BENCHMARK(second)->Arg(1000)->Arg(500)->Unit(benchmark::kMillisecond);

void summary(benchmark::State& state) {
  Milling milling(cell_of(state));
  for (auto _ : state) benchmark::DoNotOptimize(&milling.heating.sum_up());
}
BENCHMARK(summary)->Arg(1000)->Arg(500)->Unit(benchmark::kMillisecond);

void look(benchmark::State& state) {
  Milling milling(cell_of(state));
  volume::Bone& bone = *milling.milled;
  for (auto _ : state) {
    for (int n = 0; n < 4; ++n) {
      const volume::BrickIndex brick = bone.brick_at(9 + n % 2, 9 + n / 2, kTop / 8 - 1);
      volume::BrickField content;
      if (bone.copy_brick(brick, content)) bone.write_brick(brick, content);
    }
    benchmark::DoNotOptimize(milling.heating.grid().read_changes());
  }
}
BENCHMARK(look)->Arg(1000)->Arg(500)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
