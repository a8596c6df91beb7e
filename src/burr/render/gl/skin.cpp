#include "burr/render/gl/skin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "burr/render/soft_part.h"
#include "burr/render/unseen.h"

namespace burr::render::gl {

using math::Vec3;

namespace {

constexpr std::size_t kWorthLooking = 30;  // number of patches; for fewer the test costs more than
                                           // it saves
constexpr long kCall = 50;                 // cost of drawing one part by itself, in triangles

std::uint8_t unorm(float v) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 1.0F) * 255.0F));
}

// A narrow cone around the normals of all triangles, found at low cost (not the narrowest).
// Computed in single precision, so the caller adds a margin.
void find_cone(const SkinMesh& mesh, Vec3& facing, double& spread,
               std::vector<math::Vec3f>& normals) {
  normals.clear();
  const auto visit = [&](const auto& indices) {
    for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
      const math::Vec3f& a = mesh.vertices()[indices[t]].p;
      normals.push_back(
          (mesh.vertices()[indices[t + 1]].p - a).cross(mesh.vertices()[indices[t + 2]].p - a));
    }
  };
  if (mesh.large_indices().empty())
    visit(mesh.small_indices());
  else
    visit(mesh.large_indices());
  math::Vec3f sum = math::Vec3f::Zero();
  for (const math::Vec3f& n : normals) sum += n;
  const math::Vec3f towards =
      sum.norm() > 0 ? sum.normalized().eval() : math::Vec3f::UnitZ().eval();
  float least = 1;  // least cosine; compares squares, and takes a root only for the widest
  for (const math::Vec3f& n : normals) {
    const float along = n.dot(towards), length = n.squaredNorm();
    if (length > 0) least = std::min(least, along * std::abs(along) / length);
  }
  facing = towards.cast<double>().normalized();
  const double cosine = std::copysign(std::sqrt(std::abs(static_cast<double>(least))), least);
  spread = std::acos(std::clamp(cosine, -1.0, 1.0));
}

// True: no triangle of the patch can face the eye.
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

bool inside(const math::Aabb& box, const std::array<Eigen::Vector4d, 6>& planes) {
  return std::all_of(planes.begin(), planes.end(), [&](const Eigen::Vector4d& plane) {
    const Vec3 nearest((plane.x() > 0 ? box.lo : box.hi).x(), (plane.y() > 0 ? box.lo : box.hi).y(),
                       (plane.z() > 0 ? box.lo : box.hi).z());
    return plane.head<3>().dot(nearest) + plane.w() >= 0;
  });
}

}  // namespace

int Skin::update(const Scene& scene, std::vector<math::Aabb>& changed) {
  const bool recolour =
      colour_row_.get() == 0 || scene.tissue_colours != colours_ || scene.materials != materials_;
  if (recolour) {
    colours_ = scene.tissue_colours;
    materials_ = scene.materials;
    send_colours();
  }
  if (patches_.size() > scene.patches.size()) {
    for (std::size_t i = scene.patches.size(); i < patches_.size(); ++i)
      if (!patches_[i].levels.empty()) changed.push_back(patches_[i].box);
  }
  const bool other_size = patches_.size() != scene.patches.size();
  patches_.resize(scene.patches.size());
  other_stains_ = other_stains_ || other_size;

  int sent = 0;
  const auto look_at = [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    const ScenePatch& patch = scene.patches[i];
    Patch& part = patches_[i];
    const bool anew = part.version != patch.version, stains = part.stains != patch.stains;
    const bool levels = anew || part.coarser != patch.coarser;
    if (!levels && !stains && !recolour) return;
    if (levels && !anew && !stains && !recolour) {  // looks the same
      send_indices(part, patch);
      return;
    }
    other_stains_ = other_stains_ || (part.stains == nullptr) != (patch.stains == nullptr);
    part.version = patch.version;
    if (!part.levels.empty()) changed.push_back(part.box);
    if (anew)
      send(part, patch);
    else if (levels)
      send_indices(part, patch);
    if (anew || stains) send_stains(part, patch);
    if (anew && !part.levels.empty()) changed.push_back(part.box);
    sent += anew ? 1 : 0;
  };
  if (recolour || other_size || !scene.changes.since(known_, look_at)) {
    for (std::size_t i = 0; i < patches_.size(); ++i) look_at(static_cast<int>(i));
    for (Block& block : blocks_) block.laid_out = false;
  }
  known_ = scene.changes.newest();
  update_soft(scene, changed);
  update_blocks(scene);
  return sent;
}

void Skin::update_soft(const Scene& scene, std::vector<math::Aabb>& changed) {
  for (std::size_t i = scene.soft.size(); i < soft_.size(); ++i) changed.push_back(soft_[i].box);
  soft_.resize(scene.soft.size());
  for (std::size_t i = 0; i < soft_.size(); ++i) {
    const SoftStructure& structure = scene.soft[i];
    Soft& part = soft_[i];
    if (part.mesh == structure.mesh) continue;
    if (!part.levels.empty()) changed.push_back(part.box);
    part.mesh = structure.mesh;
    part.box = structure.box;
    part.tissue = structure.tissue;
    part.levels.clear();
    if (part.mesh == nullptr || part.mesh->vertices.empty()) continue;
    part.open = (part.mesh->vertices.front().under & kOpen) != 0;
    send(part, *part.mesh);
    changed.push_back(part.box);
  }
}

// Blocks look the same as their patches, so this changes nothing in the picture.
void Skin::update_blocks(const Scene& scene) {
  if (blocks_.size() != scene.blocks.size()) {
    blocks_.clear();
    blocks_.resize(scene.blocks.size());
    other_stains_ = true;
  }
  if (std::exchange(other_stains_, false)) find_stained(scene);
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const SceneBlock& block = scene.blocks[i];
    Block& part = blocks_[i];
    if (part.mesh == block.mesh && part.now == block.now && part.laid_out) continue;
    if (!std::exchange(part.laid_out, true) || part.now != block.now) {
      part.patches = block.patches;
      part.inner = block.inner;
      part.outermost = block.outer < 0;
      part.now = block.now;
      find_box(part, scene);
    }
    part.of_now = block.versions == block.now;
    if (part.mesh == block.mesh) continue;
    part.mesh = block.mesh;
    if (part.mesh == nullptr || part.mesh->vertices.empty())
      part.levels.clear();
    else
      send(part, *part.mesh);
  }
}

void Skin::find_stained(const Scene& scene) {
  stained_ = false;
  for (Block& part : blocks_) part.stained = false;
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    stained_ = stained_ || patches_[i].stains != nullptr;
    if (!patches_[i].passing) continue;
    int b = i < scene.block_of.size() ? scene.block_of[i] : -1;
    for (; b >= 0; b = scene.blocks[static_cast<std::size_t>(b)].outer)
      blocks_[static_cast<std::size_t>(b)].stained = true;
  }
}

// The boxes of its own blocks are known.
void Skin::find_box(Block& part, const Scene& scene) const {
  part.box = {};
  const auto add = [&part](const math::Aabb& box) {
    if (box.empty()) return;
    part.box.extend(box.lo);
    part.box.extend(box.hi);
  };
  for (const int inner : part.inner) add(blocks_[static_cast<std::size_t>(inner)].box);
  if (!part.inner.empty()) return;
  for (const int patch : part.patches)
    if (const auto p = static_cast<std::size_t>(patch);
        p < scene.patches.size() && scene.patches[p].mesh != nullptr)
      add(scene.patches[p].box);
}

namespace {

constexpr float kMilky = 0.7F;                     // below this the loss is too small to be seen
constexpr Colour kLost = {0.11F, 0.125F, 0.175F};  // by enamel, whose shade is then about A2

}  // namespace

void Skin::send_colours() {
  constexpr std::size_t kRow = 256;
  std::array<std::array<std::uint8_t, 4>, 2 * kRow> rows{};
  for (std::size_t t = 0; t < kRow; ++t) {
    Colour colour = t < colours_.size() ? colours_[t] : Colour{1, 1, 1};
    const Material of = t < materials_.size() ? materials_[t] : Material{};
    const std::uint8_t seen = is_unseen(colour) ? 0 : 255;
    // light is lost in what it passes through, and more of it than a face reflects
    const float lost = std::max(0.0F, of.milk - kMilky) / (1 - kMilky);
    for (std::size_t c = 0; c < colour.size(); ++c) colour[c] *= 1 - lost * kLost[c];
    rows[t] = {unorm(colour[0]), unorm(colour[1]), unorm(colour[2]), unorm(of.gloss)};
    rows[kRow + t] = {unorm(of.grain), unorm(of.pores), unorm(of.milk), seen};
  }
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, colour_row_.make());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, static_cast<GLsizei>(kRow), 2, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, rows.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

namespace {

void fill(GLenum target, const void* values, std::size_t bytes) {
  glBufferData(target, static_cast<GLsizeiptr>(bytes), values, GL_DYNAMIC_DRAW);
}

// The offsets of position, normal and tissue in a vertex.
void lay_out() {
  constexpr GLsizei kStride = sizeof(SkinVertex);
  const auto* behind_p = reinterpret_cast<const void*>(sizeof(math::Vec3f));
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribIPointer(1, 2, GL_UNSIGNED_INT, kStride, behind_p);
}

}  // namespace

void Skin::send(Patch& part, const ScenePatch& patch) {
  if (patch.mesh == nullptr) {
    const std::uint64_t version = part.version;
    part = Patch{};
    part.version = version;
    return;
  }
  const SkinMesh& mesh = *patch.mesh;
  part.box = patch.box;
  find_cone(mesh, part.facing, part.spread, normals_);

  const bool fresh = part.array.get() == 0;
  glBindVertexArray(part.array.make());
  glBindBuffer(GL_ARRAY_BUFFER, part.vertices.make());
  fill(GL_ARRAY_BUFFER, mesh.vertices().data(), mesh.vertices().size() * sizeof(SkinVertex));
  if (fresh) lay_out();
  send_indices(part, patch);
}

// All its levels, one after the other. The vertex array exists, unless the patch has no surface.
void Skin::send_indices(Patch& part, const ScenePatch& patch) {
  part.coarser = patch.coarser;
  if (patch.mesh == nullptr || part.array.get() == 0) return;
  const SkinMesh& mesh = *patch.mesh;
  part.levels = {{0, 0, static_cast<GLsizei>(mesh.index_count())}};
  const bool large = !mesh.large_indices().empty();
  part.type = large ? GL_UNSIGNED_INT : GL_UNSIGNED_SHORT;
  glBindVertexArray(part.array.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, part.indices.make());
  const auto put = [&](auto indices) {  // a copy
    if (part.coarser != nullptr)
      for (const CoarseLevel& level : *part.coarser) {
        part.levels.push_back({level.error, static_cast<GLsizei>(indices.size()),
                               static_cast<GLsizei>(level.indices.size())});
        for (const std::uint32_t index : level.indices)
          indices.push_back(static_cast<typename decltype(indices)::value_type>(index));
      }
    fill(GL_ELEMENT_ARRAY_BUFFER, indices.data(), indices.size() * sizeof(indices.front()));
  };
  if (large)
    put(mesh.large_indices());
  else
    put(mesh.small_indices());
}

// Sends the stains. The vertex array exists, unless the patch has no surface.
void Skin::send_stains(Patch& part, const ScenePatch& patch) {
  const bool passed =
      std::exchange(part.passing, patch.stains != nullptr &&
                                      std::any_of(patch.stains->begin(), patch.stains->end(),
                                                  [](const Stain& s) { return s.passing(); }));
  other_stains_ = other_stains_ || passed != part.passing;
  part.stains = patch.stains;
  if (part.array.get() == 0) return;
  glBindVertexArray(part.array.get());
  if (patch.mesh == nullptr || part.stains == nullptr ||
      part.stains->size() != patch.mesh->vertices().size()) {
    glDisableVertexAttribArray(2);
    glDisableVertexAttribArray(3);
    return;
  }
  glBindBuffer(GL_ARRAY_BUFFER, part.stain_values.make());
  fill(GL_ARRAY_BUFFER, part.stains->data(), part.stains->size() * sizeof(Stain));
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Stain), nullptr);
  const auto* behind_look = reinterpret_cast<const void*>(offsetof(Stain, ridges));
  glEnableVertexAttribArray(3);
  glVertexAttribIPointer(3, 1, GL_UNSIGNED_INT, sizeof(Stain), behind_look);
}

void Skin::send(Part& part, const CoarseMesh& mesh) {
  part.spread = std::numbers::pi;  // so large a part faces all directions
  part.type = GL_UNSIGNED_INT;
  part.levels.clear();
  std::vector<std::uint32_t> indices;
  for (const CoarseLevel& level : mesh.levels) {
    part.levels.push_back({level.error, static_cast<GLsizei>(indices.size()),
                           static_cast<GLsizei>(level.indices.size())});
    indices.insert(indices.end(), level.indices.begin(), level.indices.end());
  }
  glBindVertexArray(part.array.make());
  glBindBuffer(GL_ARRAY_BUFFER, part.vertices.make());
  fill(GL_ARRAY_BUFFER, mesh.vertices.data(), mesh.vertices.size() * sizeof(SkinVertex));
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, part.indices.make());
  fill(GL_ELEMENT_ARRAY_BUFFER, indices.data(), indices.size() * sizeof(std::uint32_t));
  lay_out();
}

void Skin::draw(const Part& part, const Part::Level& level, Drawn& drawn) {
  const std::size_t size =
      part.type == GL_UNSIGNED_SHORT ? sizeof(std::uint16_t) : sizeof(std::uint32_t);
  glBindVertexArray(part.array.get());
  glDrawElements(GL_TRIANGLES, level.count, part.type,
                 reinterpret_cast<const void*>(static_cast<std::size_t>(level.first) * size));
  ++drawn.patches;
  drawn.triangles += level.count / 3;
}

const Skin::Part::Level& Skin::coarsest(const Part& part, const Vec3& eye) const {
  const double nearest =
      std::max(0.0, (part.box.centre() - eye).norm() - 0.5 * part.box.extent().norm());
  const Part::Level* level = &part.levels.front();
  for (const Part::Level& coarser : part.levels)
    if (coarser.error <= error_share_ * nearest) level = &coarser;
  return *level;
}

Skin::Drawn Skin::draw_soft(const Vec3& eye, const Planes& planes, bool open) {
  Drawn drawn;
  const auto unseen = [this](const Soft& part) {
    return part.tissue < colours_.size() && is_unseen(colours_[part.tissue]);
  };
  for (const Soft& part : soft_)
    if (!part.levels.empty() && !unseen(part) && (open || !part.open) && !outside(part.box, planes))
      draw(part, coarsest(part, eye), drawn);
  return drawn;
}

long Skin::ask(Patch& patch, const Vec3& eye, const Planes& planes) {
  if (patch.levels.empty() || outside(patch.box, planes) ||
      (!both_sides_ && turned_away(patch.box, patch.facing, patch.spread, eye)))
    return 0;
  const Part::Level& level = patch.passing ? patch.levels.front() : coarsest(patch, eye);
  asked_.push_back({&patch, &level});
  return kCall + level.count / 3;
}

// Draws at the coarsest allowed level: the block, or what it is made of. If only a part of the
// block is in sight, the block may cost more than that part of what it is made of.
long Skin::ask(Block& block, const Vec3& eye, const Planes& planes) {
  if (block.box.empty() || outside(block.box, planes)) return 0;
  const Part::Level* level = nullptr;
  if (block.mesh != nullptr && block.of_now && !block.stained) {
    if (block.levels.empty()) return 0;
    const double nearest =
        std::max(0.0, (block.box.centre() - eye).norm() - 0.5 * block.box.extent().norm());
    for (const Part::Level& coarser : block.levels)
      if (coarser.error <= error_share_ * nearest) level = &coarser;
  }
  if (level == nullptr) return ask_inside(block, eye, planes);
  const long whole = kCall + level->count / 3;
  if (!inside(block.box, planes)) {
    const std::size_t before = asked_.size();
    const long parts = ask_inside(block, eye, planes);
    if (parts < whole) return parts;
    asked_.resize(before);
  }
  asked_.push_back({&block, level});
  return whole;
}

long Skin::ask_inside(Block& block, const Vec3& eye, const Planes& planes) {
  long cost = 0;
  for (const int inner : block.inner)
    cost += ask(blocks_[static_cast<std::size_t>(inner)], eye, planes);
  if (!block.inner.empty()) return cost;
  for (const int patch : block.patches)
    if (static_cast<std::size_t>(patch) < patches_.size())
      cost += ask(patches_[static_cast<std::size_t>(patch)], eye, planes);
  return cost;
}

Skin::Drawn Skin::draw(const Vec3& eye, const Planes& planes, bool both_sides,
                       const Hidden* hidden) {
  Drawn drawn;
  glVertexAttrib4f(2, 0, 0, 0, 0);  // for patches without stains
  glVertexAttribI4ui(3, 0, 0, 0, 0);
  both_sides_ = both_sides;
  asked_.clear();
  if (blocks_.empty() || error_share_ <= 0)
    for (Patch& patch : patches_) ask(patch, eye, planes);
  else
    for (Block& block : blocks_)
      if (block.outermost) ask(block, eye, planes);
  if (hidden == nullptr || asked_.size() < kWorthLooking) {
    for (const Asked& asked : asked_) draw(*asked.part, *asked.level, drawn);
    return drawn;
  }
  if (std::none_of(asked_.begin(), asked_.end(), [](const Asked& a) { return a.part->seen; })) {
    // nothing is known yet: the nearest parts hide most
    const auto third = asked_.begin() + static_cast<std::ptrdiff_t>(asked_.size() / 3);
    std::nth_element(asked_.begin(), third, asked_.end(), [&](const Asked& a, const Asked& b) {
      return (a.part->box.centre() - eye).squaredNorm() <
             (b.part->box.centre() - eye).squaredNorm();
    });
    for (auto at = asked_.begin(); at != third; ++at) at->part->seen = true;
  }
  for (const Asked& asked : asked_)
    if (asked.part->seen) draw(*asked.part, *asked.level, drawn);
  hidden->look();
  for (const Asked& asked : asked_) {
    const bool before = std::exchange(asked.part->seen, !hidden->is(asked.part->box));
    if (asked.part->seen && !before) draw(*asked.part, *asked.level, drawn);
  }
  return drawn;
}

}  // namespace burr::render::gl
