// `burr bench surface` and `burr bench carve`: how fast bone becomes triangles.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "bench/bench.h"
#include "bench/bench_shell.h"
#include "burr/edit/carve.h"
#include "burr/edit/undo.h"
#include "burr/surface/mesher.h"
#include "burr/volume/iso_vertices.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"

namespace burr::app {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  int size = 512;
  int runs = 5;
  int cuts = 1000;
  bool json = false;
};

std::unique_ptr<volume::Bone> shell(int size) {
  progress().report(0, "making the bone");
  volume::Grid grid;
  grid.size = {size, size, size};
  grid.voxel = 0.5e-3;
  auto bone = volume::bone_from_arrays(grid, {}, bench::shell_field(size), {}, {}, 0);
  progress().report(1, "making the bone");
  return bone;
}

// The program burr_vtk_oracle, beside this one, runs vtkFlyingEdges3D on the same field; it is
// built only where VTK is installed.
struct Oracle {
  double one_ms = 0, two_ms = 0;
  std::size_t triangles = 0;
};
std::optional<Oracle> ask_oracle(const Options& options) {
  std::error_code none;
  const auto program =
      std::filesystem::read_symlink("/proc/self/exe", none).parent_path() / "burr_vtk_oracle";
  if (none || !std::filesystem::exists(program)) return std::nullopt;
  progress().report(0, "asking VTK");
  const std::string command =
      fmt::format("'{}' {} {}", program.string(), options.size, options.runs);
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  Oracle oracle;
  const int read =
      std::fscanf(pipe, "%lf %lf %zu", &oracle.one_ms, &oracle.two_ms, &oracle.triangles);
  const bool fine = ::pclose(pipe) == 0 && read == 3;
  return fine ? std::optional(oracle) : std::nullopt;
}

Status bench_surface(const Options& options) {
  const auto oracle = ask_oracle(options);
  const auto bone = shell(options.size);
  std::size_t triangles = 0;
  std::array<double, 2> ours{};
  for (int threads = 1; threads <= 2; ++threads) {
    std::vector<double> took;
    for (int run = 0; run < options.runs; ++run) {
      NoProgress quiet;
      const auto start = Clock::now();
      const auto mesh = surface::whole_surface(*bone, threads, quiet);
      took.push_back(ms_since(start));
      if (!mesh) return mesh.error();
      triangles = mesh->triangles.size() / 3;
      if (interrupted()) return error(Trouble::interrupted, "stopped");
    }
    std::sort(took.begin(), took.end());
    ours[static_cast<std::size_t>(threads - 1)] = quantile(took, 0.5);
  }
  if (oracle && oracle->triangles != triangles)
    fmt::print(stderr, "VTK makes {} triangles, burr {}\n", oracle->triangles, triangles);

  nlohmann::ordered_json row;
  row["size"] = options.size;
  row["ours_1t_ms"] = ours[0];
  row["ours_2t_ms"] = ours[1];
  const auto or_null = [&](auto value) {
    return oracle ? nlohmann::ordered_json(value(*oracle)) : nlohmann::ordered_json(nullptr);
  };
  row["vtk_1t_ms"] = or_null([](const Oracle& o) { return o.one_ms; });
  row["vtk_2t_ms"] = or_null([](const Oracle& o) { return o.two_ms; });
  row["ratio_1t"] = or_null([&](const Oracle& o) { return ours[0] / o.one_ms; });
  row["ratio_2t"] = or_null([&](const Oracle& o) { return ours[1] / o.two_ms; });
  row["triangles"] = triangles;
  if (options.json) {
    fmt::print("{}\n", json_line(row));
    return fine();
  }
  fmt::print("{}^3 shell, {} triangles, welded, with normals; median of {} runs\n", options.size,
             triangles, options.runs);
  fmt::print("burr  {:7.0f} ms on 1 thread, {:7.0f} ms on 2\n", ours[0], ours[1]);
  if (oracle)
    fmt::print("VTK   {:7.0f} ms on 1 thread, {:7.0f} ms on 2 (flying edges); burr takes {:.2f}\n",
               oracle->one_ms, oracle->two_ms, ours[0] / oracle->one_ms);
  else
    fmt::print("VTK   not compared: burr_vtk_oracle was not built (needs VTK 9)\n");
  return fine();
}

Status bench_carve(const Options& options) {
  const auto bone = shell(options.size);
  rt::ChangedBits& changed = bone->add_watcher();
  volume::IsoVertices vertices(*bone, {}, 2, progress());
  edit::UndoStore undo(*bone, 4096);
  edit::BoneWriter writer(*bone, vertices, undo, nullptr);
  edit::Carver carver(writer, {});
  surface::Mesher mesher(*bone);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<int> named;
  std::vector<surface::Patch> patches(static_cast<std::size_t>(mesher.patch_count()));
  std::vector<double> took, carving;  // [ms] in all, and the servo's share of it
  double patches_made = 0;
  for (int i = 0; i < options.cuts && !interrupted(); ++i) {
    // a place on the outer surface, found by a ray from outside
    math::Vec3 way(unit(random), unit(random), unit(random));
    if (way.norm() > 1 || way.norm() < 0.1) way = {0, 0, 1};
    way.normalize();
    const math::Vec3 middle = 0.5 * (bone->grid().size.cast<double>() - math::Vec3::Ones());
    math::Vec3 p = middle + way * middle.x();
    const auto inside = [&] {
      const math::Ijk v = p.array().round().cast<int>();
      return bone->field(v.x(), v.y(), v.z()) >= volume::kIso;
    };
    while (!inside() && (p - middle).norm() > 1) p -= 0.5 * way;

    // a burr of 12 voxels' diameter removes everything inside it
    edit::Cut cut;
    cut.centre = p;
    cut.push = -way;
    cut.radius = 6;
    cut.energy = 1e3;
    std::uint32_t flags = 0;
    undo.begin_stroke(static_cast<std::uint64_t>(i));
    const auto start = Clock::now();
    carver.carve(cut, flags);
    vertices.refresh();
    const double carved = ms_since(start);
    named.clear();
    changed.take_all([&](std::size_t brick) {
      mesher.patches_of_brick(static_cast<volume::BrickIndex>(brick), named);
    });
    std::sort(named.begin(), named.end());
    named.erase(std::unique(named.begin(), named.end()), named.end());
    for (const int patch : named)
      if (!mesher.mesh_patch(patch, patches[static_cast<std::size_t>(patch)]))
        return error(Trouble::internal, "a patch could not be read though nobody writes");
    took.push_back(ms_since(start));
    undo.end_stroke();
    carving.push_back(carved);
    patches_made += static_cast<double>(named.size());
  }
  if (took.empty()) return error(Trouble::interrupted, "stopped before the first cut");
  patches_made /= static_cast<double>(took.size());
  std::sort(took.begin(), took.end());
  std::sort(carving.begin(), carving.end());
  nlohmann::ordered_json row;
  row["size"] = options.size;
  row["cuts"] = took.size();
  row["p50_ms"] = quantile(took, 0.5);
  row["p99_ms"] = quantile(took, 0.99);
  row["max_ms"] = took.back();
  row["carve_p50_ms"] = quantile(carving, 0.5);
  row["carve_p99_ms"] = quantile(carving, 0.99);
  row["patches_mean"] = patches_made;
  if (options.json)
    fmt::print("{}\n", json_line(row));
  else
    fmt::print(
        "{} cuts 12 voxels across, until their {:.1f} patches are meshed: p50 {:.2f} ms, "
        "p99 {:.2f} ms, max {:.2f} ms\n",
        took.size(), patches_made, quantile(took, 0.5), quantile(took, 0.99), took.back());
  return fine();
}

void add_surface(CLI::App& bench, Todo& todo) {
  auto* command =
      bench.add_subcommand("surface", "measure meshing the whole surface of a 512^3 shell");
  auto options = std::make_shared<Options>();
  command->add_option("--size", options->size, "voxels along each edge")
      ->check(CLI::Range(32, 1024))
      ->capture_default_str();
  command->add_option("--runs", options->runs, "number of runs; the median is shown")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object as the last line");
  command->callback(
      [options, &todo] { todo.work = [options] { return bench_surface(*options); }; });
}

void add_carve(CLI::App& bench, Todo& todo) {
  auto* command =
      bench.add_subcommand("carve", "measure cutting the shell and meshing what changed");
  auto options = std::make_shared<Options>();
  options->size = 256;
  command->add_option("--size", options->size, "voxels along each edge")
      ->check(CLI::Range(32, 1024))
      ->capture_default_str();
  command->add_option("--cuts", options->cuts, "number of cuts")
      ->check(CLI::Range(10, 1000000))
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object as the last line");
  command->callback([options, &todo] { todo.work = [options] { return bench_carve(*options); }; });
}

const BenchCommand surface_command{20, add_surface};
const BenchCommand carve_command{30, add_carve};

}  // namespace
}  // namespace burr::app
