#include "burr/render/gl/skin_programs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "burr/render/gl/skin_shaders.h"

namespace burr::render::gl {

using math::Vec3;

namespace {

constexpr int kEdge = 64;                            // of the noise [texel]
constexpr double kNoise = 6.4e-3;                    // the same length in the world [m]
constexpr double kRidgePitch = 70 * Stain::kAlong;   // distance between two ridges [m]
constexpr int kPores = 50;                           // in one cube of the noise
constexpr double kPoreLeast = 1.2, kPoreMost = 2.6;  // radius [texel]

// Smooth noise of `cells` random values along each side, which goes on beyond the borders.
class Clouds {
 public:
  Clouds(int cells, std::mt19937& random) : cells_(cells) {
    values_.resize(static_cast<std::size_t>(cells * cells * cells));
    for (float& v : values_) v = static_cast<float>(random()) / 4294967296.0F;
  }
  [[nodiscard]] float at(int x, int y, int z) const {
    std::array<int, 3> low{};
    std::array<float, 3> part{};
    const std::array<int, 3> p = {x, y, z};
    for (std::size_t d = 0; d < 3; ++d) {
      const float q = static_cast<float>(p[d] * cells_) / static_cast<float>(kEdge);
      low[d] = static_cast<int>(q);
      const float t = q - static_cast<float>(low[d]);
      part[d] = t * t * (3 - 2 * t);
    }
    float sum = 0;
    for (int c = 0; c < 8; ++c) {
      float weight = 1;
      std::array<int, 3> at{};
      for (std::size_t d = 0; d < 3; ++d) {
        const int by = c >> d & 1;
        weight *= by == 1 ? part[d] : 1 - part[d];
        at[d] = (low[d] + by) % cells_;
      }
      sum += weight * values_[static_cast<std::size_t>((at[2] * cells_ + at[1]) * cells_ + at[0])];
    }
    return sum;
  }

 private:
  int cells_;
  std::vector<float> values_;
};

std::uint8_t unorm(float v) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 1.0F) * 255));
}

std::vector<std::uint8_t> noise() {
  std::mt19937 random(20261126);  // the same noise in every program
  const Clouds broad(8, random), middle(16, random), fine(32, random), other(32, random);
  std::vector<std::uint8_t> texels(static_cast<std::size_t>(4 * kEdge * kEdge * kEdge));
  std::size_t n = 0;
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x, n += 4) {
        texels[n] = unorm(0.65F * broad.at(x, y, z) + 0.35F * middle.at(x, y, z));
        texels[n + 2] = unorm(fine.at(x, y, z));
        texels[n + 3] = unorm(other.at(x, y, z));
      }
  const auto share = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  for (int pore = 0; pore < kPores; ++pore) {
    const Vec3 middle_at = kEdge * Vec3(share(), share(), share());
    const double radius = kPoreLeast + (kPoreMost - kPoreLeast) * share() * share();
    const math::Ijk low = (middle_at.array() - radius).ceil().cast<int>(),
                    high = (middle_at.array() + radius).floor().cast<int>();
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) {
          const double off = (Vec3(x, y, z) - middle_at).norm() / radius;
          const auto wrap = [](int v) { return (v + kEdge) % kEdge; };
          std::uint8_t& texel = texels[static_cast<std::size_t>(
              4 * ((wrap(z) * kEdge + wrap(y)) * kEdge + wrap(x)) + 1)];
          texel = std::max(texel, unorm(static_cast<float>(1.4 * (1 - off))));
        }
  }
  return texels;
}

}  // namespace

Status SkinPrograms::start(bool es) {
  for (int variant = 0; variant < 8; ++variant) {
    const bool stained = (variant & 1) != 0, grain = (variant & 2) != 0,
               clipped = (variant & 4) != 0;
    const char *one = stained ? "#define STAINED\n" : "", *two = grain ? "#define GRAIN\n" : "",
               *three = clipped ? "#define CLIP\n" : "";
    Result<Program> linked = Program::link(es, {one, two, three, kStainFunction, kSkinVertex},
                                           {one, two, three, kStainFunction, kSkinFragment});
    if (!linked) return linked.error();
    programs_[stained ? 1 : 0][grain ? 1 : 0][clipped ? 1 : 0] = std::move(*linked);
  }
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_3D, noise_.make());
  glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, kEdge, kEdge, kEdge, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               noise().data());
  for (const GLenum way : {GLenum{GL_TEXTURE_MIN_FILTER}, GLenum{GL_TEXTURE_MAG_FILTER}})
    glTexParameteri(GL_TEXTURE_3D, way, GL_LINEAR);
  for (const GLenum way :
       {GLenum{GL_TEXTURE_WRAP_S}, GLenum{GL_TEXTURE_WRAP_T}, GLenum{GL_TEXTURE_WRAP_R}})
    glTexParameteri(GL_TEXTURE_3D, way, GL_REPEAT);
  glActiveTexture(GL_TEXTURE0);
  return fine();
}

void SkinPrograms::use(const SkinKind& kind, const Scene& scene, const Frame& frame,
                       GLuint colours) {
  Program& program = programs_[kind.stained ? 1 : 0][kind.grain ? 1 : 0][kind.clipped ? 1 : 0];
  program.use();
  const Eigen::Matrix4d clip_from_world = frame.clip * frame.view;
  program.set("clip_from_model", Eigen::Matrix4f(clip_from_world.cast<float>()));
  const Eigen::Matrix3d turn = frame.view.block<3, 3>(0, 0);
  program.set("view_from_model_n", Eigen::Matrix3f(turn.cast<float>()));
  program.set("tissue_colours", 0);
  if (kind.stained && kind.grain)
    program.set("turns_per_step",
                static_cast<float>(2 * std::numbers::pi * Stain::kAlong / kRidgePitch));
  if (kind.grain) {
    program.set("noise", 1);
    program.set("noises_per_m", static_cast<float>(1 / kNoise));
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_3D, noise_.get());
  }
  if (kind.clipped && scene.clip) {
    const Vec3& n = scene.clip->n;
    Eigen::Vector4f plane;
    plane << n.cast<float>(), static_cast<float>(-n.dot(scene.clip->p));
    program.set("plane", plane);
    program.set("plane_n", Eigen::Vector3f((turn * n).cast<float>()));
  }
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, colours);
}

}  // namespace burr::render::gl
