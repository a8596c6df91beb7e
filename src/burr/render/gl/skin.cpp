#include "burr/render/gl/skin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace burr::render::gl {

using math::Vec3;

namespace {

constexpr std::size_t kWorthLooking = 200;  // patches; for fewer it costs more than it saves

std::uint8_t unorm(float v) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 1.0F) * 255.0F));
}

// the narrowest cone we easily find around all triangles' own normals
void find_cone(const SkinMesh& mesh, Vec3& facing, double& spread) {
  std::vector<Vec3> normals;
  normals.reserve(mesh.index_count() / 3);
  Vec3 sum = Vec3::Zero();
  for (std::size_t t = 0; t + 2 < mesh.index_count(); t += 3) {
    const Vec3 a = mesh.vertices()[mesh.index(t)].p.cast<double>();
    const Vec3 b = mesh.vertices()[mesh.index(t + 1)].p.cast<double>();
    const Vec3 c = mesh.vertices()[mesh.index(t + 2)].p.cast<double>();
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
  const bool recolour = colour_row_.get() == 0 || scene.tissue_colours != colours_;
  if (recolour) {
    colours_ = scene.tissue_colours;
    send_colours();
  }
  if (parts_.size() > scene.patches.size()) {
    for (std::size_t i = scene.patches.size(); i < parts_.size(); ++i)
      if (parts_[i].count > 0) changed.push_back(parts_[i].box);
  }
  parts_.resize(scene.patches.size());

  int sent = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const ScenePatch& patch = scene.patches[i];
    Part& part = parts_[i];
    if (part.version == patch.version) {
      if (recolour && part.count > 0) changed.push_back(part.box);
      continue;
    }
    if (part.count > 0) changed.push_back(part.box);
    send(part, patch);
    if (part.count > 0) changed.push_back(part.box);
    ++sent;
  }
  return sent;
}

void Skin::send_colours() {
  constexpr std::size_t kRow = 256;
  std::array<std::array<std::uint8_t, 4>, kRow> row{};
  for (std::size_t t = 0; t < kRow; ++t) {
    const Colour colour = t < colours_.size() ? colours_[t] : Colour{1, 1, 1};
    row[t] = {unorm(colour[0]), unorm(colour[1]), unorm(colour[2]), 255};
  }
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, colour_row_.make());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, static_cast<GLsizei>(kRow), 1, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, row.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void Skin::send(Part& part, const ScenePatch& patch) {
  if (patch.mesh == nullptr) {
    part = Part{};
    part.version = patch.version;
    return;
  }
  const SkinMesh& mesh = *patch.mesh;
  part.version = patch.version;
  part.box = patch.box;
  find_cone(mesh, part.facing, part.spread);

  const auto fill = [](GLenum target, const auto& values) {
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(),
                 GL_DYNAMIC_DRAW);
  };
  const bool fresh = part.array.get() == 0;
  glBindVertexArray(part.array.make());
  glBindBuffer(GL_ARRAY_BUFFER, part.vertices.make());
  fill(GL_ARRAY_BUFFER, mesh.vertices());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, part.indices.make());
  part.count = static_cast<GLsizei>(mesh.index_count());
  if (mesh.large_indices().empty()) {
    part.type = GL_UNSIGNED_SHORT;
    fill(GL_ELEMENT_ARRAY_BUFFER, mesh.small_indices());
  } else {
    part.type = GL_UNSIGNED_INT;
    fill(GL_ELEMENT_ARRAY_BUFFER, mesh.large_indices());
  }
  if (!fresh) return;
  constexpr GLsizei kStride = sizeof(SkinVertex);
  const auto* behind_p = reinterpret_cast<const void*>(sizeof(math::Vec3f));
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribIPointer(1, 1, GL_UNSIGNED_INT, kStride, behind_p);
}

void Skin::draw(const Part& part, Drawn& drawn) const {
  glBindVertexArray(part.array.get());
  glDrawElements(GL_TRIANGLES, part.count, part.type, nullptr);
  ++drawn.patches;
  drawn.triangles += part.count / 3;
}

Skin::Drawn Skin::draw(const Vec3& eye, const std::array<Eigen::Vector4d, 6>& planes,
                       const Hidden* hidden) {
  Drawn drawn;
  asked_.clear();
  for (Part& part : parts_)
    if (part.count > 0 && !outside(part.box, planes) &&
        !turned_away(part.box, part.facing, part.spread, eye))
      asked_.push_back(&part);
  if (hidden == nullptr || asked_.size() < kWorthLooking) {
    for (const Part* part : asked_) draw(*part, drawn);
    return drawn;
  }
  if (std::none_of(asked_.begin(), asked_.end(), [](const Part* part) { return part->seen; })) {
    // nothing is known yet: what is nearest hides most
    const auto third = asked_.begin() + static_cast<std::ptrdiff_t>(asked_.size() / 3);
    std::nth_element(asked_.begin(), third, asked_.end(), [&](const Part* a, const Part* b) {
      return (a->box.centre() - eye).squaredNorm() < (b->box.centre() - eye).squaredNorm();
    });
    for (auto at = asked_.begin(); at != third; ++at) (*at)->seen = true;
  }
  for (const Part* part : asked_)
    if (part->seen) draw(*part, drawn);
  hidden->look();
  for (Part* part : asked_) {
    const bool before = std::exchange(part->seen, !hidden->is(part->box));
    if (part->seen && !before) draw(*part, drawn);
  }
  return drawn;
}

}  // namespace burr::render::gl
