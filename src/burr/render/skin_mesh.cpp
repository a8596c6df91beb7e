#include "burr/render/skin_mesh.h"

#include <algorithm>
#include <cmath>

namespace burr::render {
namespace {

// 4095 values, one of which is 0, so that a normal along an axis is exact
constexpr float kHalf = 2047.0F;

float sign(float v) { return v >= 0 ? 1.0F : -1.0F; }

std::uint32_t step(float v) {
  // The value is never negative: adding a half and truncating rounds it, many times faster than
  // std::lround.
  return static_cast<std::uint32_t>(
      static_cast<int>((std::clamp(v, -1.0F, 1.0F) + 1.0F) * kHalf + 0.5F));
}

}  // namespace

std::uint32_t folded(const math::Vec3f& n, volume::TissueId tissue) {
  const float sum = std::abs(n.x()) + std::abs(n.y()) + std::abs(n.z());
  float x = sum > 0 ? n.x() / sum : 0, y = sum > 0 ? n.y() / sum : 0;
  if (n.z() < 0) {
    const float flat = x;
    x = (1 - std::abs(y)) * sign(flat);
    y = (1 - std::abs(flat)) * sign(y);
  }
  return std::uint32_t{tissue} | step(x) << 8 | step(y) << 20;
}

math::Vec3f normal_of(const SkinVertex& vertex) {
  float x = static_cast<float>(vertex.rest >> 8 & 0xFFFU) / kHalf - 1.0F,
        y = static_cast<float>(vertex.rest >> 20) / kHalf - 1.0F;
  const float z = 1 - std::abs(x) - std::abs(y), fold = std::max(-z, 0.0F);
  x -= fold * sign(x);
  y -= fold * sign(y);
  return math::Vec3f(x, y, z).normalized();
}

SkinMesh::SkinMesh(const surface::Patch& patch) {
  vertices_.resize(patch.vertices.size());
  std::transform(patch.vertices.begin(), patch.vertices.end(), vertices_.begin(),
                 [](const surface::Vertex& v) {
                   return SkinVertex{v.p, folded(v.n, v.tissue),
                                     std::uint32_t{v.beneath} | std::uint32_t{v.through} << 8 |
                                         std::uint32_t{v.wall} << 16};
                 });
  if (patch.vertices.size() > 65535) {
    large_ = patch.triangles;
    return;
  }
  small_.resize(patch.triangles.size());
  std::transform(patch.triangles.begin(), patch.triangles.end(), small_.begin(),
                 [](std::uint32_t v) { return static_cast<std::uint16_t>(v); });
}

}  // namespace burr::render
