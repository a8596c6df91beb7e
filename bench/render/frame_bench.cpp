// bench/render/frame_bench.cpp - the time for one picture, as in the window and as a still.
//
// The bone is the bumpy shell of the surface benchmarks: 0.9 million triangles at 256^3, 2 million
// at 384^3. Also reported: triangles drawn, share of the picture that was redrawn. The label names
// the GPU.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>

#include "apps/burr/bench/bench_shell.h"
#include "burr/render/bone_scene.h"
#include "burr/render/pick.h"
#include "burr/render/renderer.h"

namespace {

using namespace burr;
using render::Renderer;
using render::Scene;

// Made once, for the renderers of all benchmarks.
const Scene& shell_scene(int size) {
  static std::map<int, Scene> made;
  const auto [entry, fresh] = made.try_emplace(size);
  if (!fresh) return entry->second;
  volume::Grid grid;
  grid.size = {size, size, size};
  grid.voxel = 0.2 / size;
  const auto field = bench::shell_field(size);
  const auto bone = volume::bone_from_arrays(grid, {}, field, {}, {}, 0);
  NoProgress nobody;
  const Status skinned = render::skin_bone(entry->second, *bone, 2, nobody);
  BURR_CHECK(skinned.ok());
  entry->second.camera = render::whole_view(entry->second, 0.3, 0.3, 16.0 / 9);
  return entry->second;
}

std::unique_ptr<Renderer> renderer(benchmark::State& state) {
  auto made = Renderer::offscreen();
  if (!made) {
    state.SkipWithError(made.error().text.c_str());
    return nullptr;
  }
  state.SetLabel((*made)->gpu());
  return std::move(*made);
}

void look_at_work(Scene& scene, double view_height) {
  const auto hit = render::pick(scene, render::ray_through(scene.camera, 640, 360, 1280, 720));
  BURR_CHECK(hit.has_value());
  scene.camera = render::view_of_work(hit->p, hit->n, view_height);
  scene.burr.visible = true;
  scene.burr.world_from_tool.p = hit->p;
  scene.burr.world_from_tool.q =
      math::Quat(Eigen::Quaterniond::FromTwoVectors(math::Vec3::UnitZ(), hit->n));
}

void figures(benchmark::State& state, const Renderer& gpu) {
  state.counters["triangles"] = static_cast<double>(gpu.figures().triangles_drawn);
  state.counters["redrawn"] = gpu.figures().redrawn;
}

// The eye moves: everything is redrawn.
void orbit_whole(benchmark::State& state) {
  Scene scene = shell_scene(static_cast<int>(state.range(0)));
  const auto gpu = renderer(state);
  if (gpu == nullptr || !gpu->show(scene)) return;  // the bone is sent before timing begins
  for (auto _ : state) {
    render::orbit(scene.camera, 0.01, 0);
    if (!gpu->show(scene)) state.SkipWithError("not drawn");
  }
  figures(state, *gpu);
}

void orbit_close(benchmark::State& state) {
  Scene scene = shell_scene(static_cast<int>(state.range(0)));
  look_at_work(scene, 0.045);
  const auto gpu = renderer(state);
  if (gpu == nullptr || !gpu->show(scene)) return;  // the bone is sent before timing begins
  for (auto _ : state) {
    render::orbit(scene.camera, 0.001, 0);
    if (!gpu->show(scene)) state.SkipWithError("not drawn");
  }
  figures(state, *gpu);
}

// The eye rests, the burr moves and a patch changes: milling.
void mill_close(benchmark::State& state) {
  Scene scene = shell_scene(static_cast<int>(state.range(0)));
  look_at_work(scene, 0.045);
  const auto gpu = renderer(state);
  if (gpu == nullptr) return;
  const math::Vec3 start = scene.burr.world_from_tool.p;
  std::size_t near = 0;
  for (std::size_t i = 0; i < scene.patches.size(); ++i)
    if (scene.patches[i].mesh != nullptr && (scene.patches[i].box.centre() - start).norm() <
                                                (scene.patches[near].box.centre() - start).norm())
      near = i;
  int step = 0;
  if (!gpu->show(scene)) return;
  for (auto _ : state) {
    scene.burr.world_from_tool.p = start + 2e-3 * std::sin(0.1 * ++step) * scene.camera.right();
    scene.burr.turn += 0.7;
    ++scene.patches[near].version;
    if (!gpu->show(scene)) state.SkipWithError("not drawn");
  }
  figures(state, *gpu);
}

void still(benchmark::State& state) {
  Scene scene = shell_scene(static_cast<int>(state.range(0)));
  scene.look = render::still_look();
  const auto gpu = renderer(state);
  if (gpu == nullptr) return;
  for (auto _ : state)
    if (!gpu->image(scene, 1280, 720)) state.SkipWithError("not drawn");
  figures(state, *gpu);
}

void picking(benchmark::State& state) {
  const Scene& scene = shell_scene(static_cast<int>(state.range(0)));
  double x = 400;
  for (auto _ : state) {
    x = x < 800 ? x + 1 : 400;
    benchmark::DoNotOptimize(
        render::pick(scene, render::ray_through(scene.camera, x, 360, 1280, 720)));
  }
}

// CPU time is the sum over all threads: without a GPU it is the cost of a frame, however busy the
// machine is; divided by the number of processors it is the shortest possible time of a frame.
void frames(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime()->Iterations(20);
}

BENCHMARK(orbit_whole)->Arg(256)->Arg(384)->Apply(frames);
BENCHMARK(orbit_close)->Arg(256)->Arg(384)->Apply(frames);
BENCHMARK(mill_close)->Arg(256)->Arg(384)->Apply(frames);
BENCHMARK(still)->Arg(256)->Apply(frames);
BENCHMARK(picking)->Arg(384)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
