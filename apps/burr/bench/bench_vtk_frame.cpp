#include "bench/bench_vtk_frame.h"

#include <fmt/core.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "shared/subcommand.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

// Writes the format that bench/render/vtk_frame.cpp reads.
bool write_scene(const render::Scene& scene, const fs::path& path) {
  std::ofstream out(path, std::ios::binary);
  const auto put = [&out](const auto& value) {
    out.write(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  const render::Camera& camera = scene.camera;
  for (const math::Vec3& v : {camera.eye(), camera.target, camera.above()})
    for (int axis = 0; axis < 3; ++axis) put(v[axis]);
  put(camera.field_of_view * 180 / std::numbers::pi);
  std::array<std::uint32_t, 2> count{};
  for (const render::ScenePatch& patch : scene.patches) {
    if (patch.mesh == nullptr) continue;
    count[0] += static_cast<std::uint32_t>(patch.mesh->vertices().size());
    count[1] += static_cast<std::uint32_t>(patch.mesh->index_count() / 3);
  }
  put(count);
  for (const render::ScenePatch& patch : scene.patches) {
    if (patch.mesh == nullptr) continue;
    for (const render::SkinVertex& vertex : patch.mesh->vertices()) {
      const math::Vec3f n = render::normal_of(vertex);
      for (const float v : {vertex.p.x(), vertex.p.y(), vertex.p.z(), n.x(), n.y(), n.z()}) put(v);
    }
  }
  std::uint32_t first = 0;
  for (const render::ScenePatch& patch : scene.patches) {
    if (patch.mesh == nullptr) continue;
    for (std::size_t n = 0; n < patch.mesh->index_count(); ++n) put(first + patch.mesh->index(n));
    first += static_cast<std::uint32_t>(patch.mesh->vertices().size());
  }
  return out.flush().good();
}

}  // namespace

std::optional<double> vtk_frame_ms(const render::Scene& scene, int width, int height, int frames) {
  std::error_code none;
  const fs::path program =
      fs::read_symlink("/proc/self/exe", none).parent_path() / "burr_vtk_frame";
  if (none || !fs::exists(program)) return std::nullopt;
  progress().report(0, "asking VTK");
  const fs::path file = fs::temp_directory_path() / fmt::format("burr_vtk_{}.bin", ::getpid());
  std::optional<double> answer;
  if (write_scene(scene, file)) {
    const std::string command =
        fmt::format("'{}' '{}' {} {} {}", program.string(), file.string(), width, height, frames);
    if (std::FILE* pipe = ::popen(command.c_str(), "r"); pipe != nullptr) {
      double ms = 0;
      const int read = std::fscanf(pipe, "%lf", &ms);
      if (::pclose(pipe) == 0 && read == 1 && ms > 0) answer = ms;
    }
  }
  fs::remove(file, none);
  return answer;
}

}  // namespace burr::app
