#include "burr/render/gl/skin.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace burr::render::gl {

using math::Vec3;

namespace {

struct Packed {
  float p[3];
  std::int16_t n[3];
  std::uint8_t colour[4];
  std::int16_t unused;
};
static_assert(sizeof(Packed) == 24);

std::int16_t snorm(float v) {
  return static_cast<std::int16_t>(std::lround(std::clamp(v, -1.0F, 1.0F) * 32767.0F));
}
std::uint8_t unorm(float v) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 1.0F) * 255.0F));
}

// the narrowest cone we easily find around all triangles' own normals
void find_cone(const surface::Patch& mesh, Vec3& facing, double& spread) {
  std::vector<Vec3> normals;
  normals.reserve(mesh.triangles.size() / 3);
  Vec3 sum = Vec3::Zero();
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const Vec3 a = mesh.vertices[mesh.triangles[t]].p.cast<double>();
    const Vec3 b = mesh.vertices[mesh.triangles[t + 1]].p.cast<double>();
    const Vec3 c = mesh.vertices[mesh.triangles[t + 2]].p.cast<double>();
    const Vec3 n = (b - a).cross(c - a);
    const double length = n.norm();
    if (length == 0) continue;
    normals.emplace_back(n / length);
    sum += n;
  }
  facing = sum.norm() > 0 ? sum.normalized().eval() : Vec3::UnitZ();
  double least = 1;
  for (const Vec3& n : normals) least = std::min(least, n.dot(facing));
  spread = std::acos(std::clamp(least, -1.0, 1.0));
}

// true: no triangle of the patch can show its face to the eye
bool turned_away(const math::Aabb& box, const Vec3& facing, double spread, const Vec3& eye) {
  const Vec3 d = box.centre() - eye;
  const double far = d.norm(), radius = 0.5 * box.extent().norm();
  if (far <= radius) return false;
  const double margin = spread + std::asin(radius / far) + 1e-3;
  return margin < std::numbers::pi / 2 && d.dot(facing) > far * std::sin(margin);
}

bool outside(const math::Aabb& box, const std::array<Eigen::Vector4d, 6>& planes) {
  return std::any_of(planes.begin(), planes.end(), [&](const Eigen::Vector4d& plane) {
    const Vec3 nearest((plane.x() > 0 ? box.hi : box.lo).x(), (plane.y() > 0 ? box.hi : box.lo).y(),
                       (plane.z() > 0 ? box.hi : box.lo).z());
    return plane.head<3>().dot(nearest) + plane.w() < 0;
  });
}

}  // namespace

int Skin::update(const Scene& scene, std::vector<math::Aabb>& changed) {
  // other colours: everything again
  const bool recolour = scene.tissue_colours != colours_;
  if (recolour) colours_ = scene.tissue_colours;
  if (parts_.size() > scene.patches.size()) {
    for (std::size_t i = scene.patches.size(); i < parts_.size(); ++i)
      if (parts_[i].count > 0) changed.push_back(parts_[i].box);
  }
  parts_.resize(scene.patches.size());

  int sent = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const ScenePatch& patch = scene.patches[i];
    Part& part = parts_[i];
    if (part.version == patch.version && !(recolour && patch.mesh != nullptr)) continue;
    if (part.count > 0) changed.push_back(part.box);
    send(part, patch, scene.tissue_colours);
    if (part.count > 0) changed.push_back(part.box);
    ++sent;
  }
  return sent;
}

void Skin::send(Part& part, const ScenePatch& patch, const std::vector<Colour>& colours) {
  if (patch.mesh == nullptr) {
    part = Part{};
    part.version = patch.version;
    return;
  }
  const surface::Patch& mesh = *patch.mesh;
  part.version = patch.version;
  part.box = patch.box;
  find_cone(mesh, part.facing, part.spread);

  std::vector<Packed> packed(mesh.vertices.size());
  for (std::size_t v = 0; v < packed.size(); ++v) {
    const surface::Vertex& from = mesh.vertices[v];
    const Colour colour = from.tissue < colours.size() ? colours[from.tissue] : Colour{1, 1, 1};
    Packed& to = packed[v];
    for (int axis = 0; axis < 3; ++axis) {
      to.p[axis] = from.p[axis];
      to.n[axis] = snorm(from.n[axis]);
      to.colour[axis] = unorm(colour[static_cast<std::size_t>(axis)]);
    }
    to.colour[3] = 255;
    to.unused = 0;
  }

  const bool fresh = part.array.get() == 0;
  glBindVertexArray(part.array.make());
  glBindBuffer(GL_ARRAY_BUFFER, part.vertices.make());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(packed.size() * sizeof(Packed)),
               packed.data(), GL_DYNAMIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, part.indices.make());
  part.count = static_cast<GLsizei>(mesh.triangles.size());
  if (mesh.vertices.size() <= 65535) {
    part.type = GL_UNSIGNED_SHORT;
    std::vector<std::uint16_t> small(mesh.triangles.size());
    std::transform(mesh.triangles.begin(), mesh.triangles.end(), small.begin(),
                   [](std::uint32_t index) { return static_cast<std::uint16_t>(index); });
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(small.size() * 2), small.data(),
                 GL_DYNAMIC_DRAW);
  } else {
    part.type = GL_UNSIGNED_INT;
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.triangles.size() * 4),
                 mesh.triangles.data(), GL_DYNAMIC_DRAW);
  }
  if (!fresh) return;
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Packed), at(offsetof(Packed, p)));
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_SHORT, GL_TRUE, sizeof(Packed), at(offsetof(Packed, n)));
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 3, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Packed),
                        at(offsetof(Packed, colour)));
}

Skin::Drawn Skin::draw(const Vec3& eye, const std::array<Eigen::Vector4d, 6>& planes) const {
  Drawn drawn;
  for (const Part& part : parts_) {
    if (part.count == 0 || outside(part.box, planes) ||
        turned_away(part.box, part.facing, part.spread, eye))
      continue;
    glBindVertexArray(part.array.get());
    glDrawElements(GL_TRIANGLES, part.count, part.type, nullptr);
    ++drawn.patches;
    drawn.triangles += part.count / 3;
  }
  return drawn;
}

}  // namespace burr::render::gl
