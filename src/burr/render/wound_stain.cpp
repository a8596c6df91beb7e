// How a wound is shown, and what it learns from the surface: where the surface is and which tissue
// was opened.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "burr/render/wound.h"

namespace burr::render {

using math::Aabb;
using math::Ijk;
using math::Vec3;

namespace {

constexpr int kLevels = 32;           // number of levels of stains: with fewer levels they are sent
                                      // less often
constexpr double kCutFace = 0.75;     // within this distance of the tool's path a vertex belongs to
                                      // the cut face [voxel]
constexpr double kStillBleeds = 4.0;  // blood runs for so long before a still picture [s]

std::uint8_t level(float v) {
  const auto step = static_cast<int>(std::lround(std::clamp(v, 0.0F, 1.0F) * kLevels));
  return static_cast<std::uint8_t>(step * 255 / kLevels);
}

// The tissue that bleeds when the bone is opened there: for the wall of a canal, what fills the
// canal.
volume::TissueId tissue_behind(const SkinVertex& vertex) {
  const bool wall = (vertex.under >> 16 & 0xFFU) >= 128;
  return wall ? static_cast<volume::TissueId>(vertex.under & 0xFFU) : tissue_of(vertex);
}

}  // namespace

// Where a vertex of a bleeding tissue lies on the surface that the tool left, the tissue was
// opened. A canal that the tool has not reached has no such vertex, however thin the bone in front
// of it.
void Wound::look_at(const SkinMesh& mesh) {
  const float cut_face = static_cast<float>(kCutFace * voxel_ / cell_);
  for (const SkinVertex& vertex : mesh.vertices()) {
    const Vec3 p = vertex.p.cast<double>();
    const Ijk at = (p / cell_).array().floor().cast<int>().matrix() - first_;
    if (at.minCoeff() < 0 || at.maxCoeff() >= kEdge) continue;
    Cell& cell = cells_[index(at.x(), at.y(), at.z())];
    cell.skin = true;
    const auto tissue = static_cast<std::size_t>(tissue_behind(vertex));
    const float bleeds = tissue < bleeding_.size() ? bleeding_[tissue] : 0;
    if (bleeds <= cell.open || cell.look.fresh <= 0 || mean_at(p).off > cut_face) continue;
    cell.open = bleeds;
    bleeds_ = true;
  }
}

bool Wound::reached(const ScenePatch& patch) const {
  const Aabb box = touched();
  return patch.mesh != nullptr && !box.empty() && (patch.box.lo.array() <= box.hi.array()).all() &&
         (patch.box.hi.array() >= box.lo.array()).all();
}

// In a Stain's form: of the cell that the place is in, since the ways of different passes cannot be
// mixed. Where the cells around it are of other passes, the ridges end.
std::uint32_t Wound::ridges_at(const Vec3& p, float height) const {
  constexpr double kSame = 60e-6;  // as far along the path, for cells of one pass [m]
  const Vec3 q = p / cell_ - first_.cast<double>() - Vec3::Constant(0.5);
  const Ijk low = q.array().floor().cast<int>(), own = q.array().round().cast<int>();
  if (low.minCoeff() < 0 || low.maxCoeff() + 1 >= kEdge) return 0;
  const auto along = [&p](const Cell& cell) {
    return static_cast<double>(cell.along) + cell.way.cast<double>().dot(p);
  };
  const Cell& mine = cells_[index(own.x(), own.y(), own.z())];
  if (mine.ridges <= 0) return 0;
  const double here = along(mine);
  const Vec3 part = q - low.cast<double>();
  double agree = 0;
  for (int c = 0; c < 8; ++c) {
    const Ijk by(c & 1, (c >> 1) & 1, c >> 2);
    const Cell& cell = cells_[index(low.x() + by.x(), low.y() + by.y(), low.z() + by.z())];
    if (cell.ridges <= 0 || std::abs(along(cell) - here) > kSame) continue;
    double product = 1;
    for (int d = 0; d < 3; ++d) product *= by[d] == 1 ? part[d] : 1 - part[d];
    agree += product;
  }
  const std::uint32_t high = level(height * static_cast<float>(2 * agree - 1));
  if (high == 0) return 0;
  constexpr double kMiddle = 1 << 22;  // so that it never is negative
  const auto steps = static_cast<std::uint32_t>(here / Stain::kAlong + kMiddle) & 0xFFFFFFU;
  return high | steps << 8;
}

void Wound::stain(Scene& scene, int patch) {
  ScenePatch& entry = scene.patches[static_cast<std::size_t>(patch)];
  if (!reached(entry)) {
    set_stains(scene, patch, nullptr);
    return;
  }
  look_at(*entry.mesh);
  const math::Vec3f up = up_.value_or(Vec3::UnitZ()).cast<float>();
  std::vector<Stain> stains;
  stains.reserve(entry.mesh->vertices().size());
  bool any = false;
  for (const SkinVertex& vertex : entry.mesh->vertices()) {
    const Vec3 p = vertex.p.cast<double>();
    State state = at(p);
    // dust slides off steep faces, and none lies under an overhang; a paste sticks
    if (state.dust > 0)
      state.dust *=
          std::clamp(normal_of(vertex).dot(up) / 0.6F + 0.3F + 0.6F * state.wet, 0.0F, 1.0F);
    stains.push_back({level(state.fresh), level(state.wet), level(state.dust), level(state.blood),
                      ridges_at(p, 1 - state.dust)});
    any = any || stains.back() != Stain{};
  }
  if (!any)
    set_stains(scene, patch, nullptr);
  else if (entry.stains == nullptr || *entry.stains != stains)
    set_stains(scene, patch, std::make_shared<const std::vector<Stain>>(std::move(stains)));
}

void Wound::stain(Scene& scene) {
  for (Cell& cell : cells_) cell.skin = false;
  for (std::size_t patch = 0; patch < scene.patches.size(); ++patch)
    stain(scene, static_cast<int>(patch));
  chips_.lie(scene, first_tool_.last ? first_tool_.last->t : 0);
}

void Wound::stain_still(Scene& scene) {
  stain(scene);
  if (!bleeds_) return;
  for (double t = 0; t < kStillBleeds; t += 0.1) flow(0.1);
  stain(scene);
}

void Wound::renew(Scene& scene, double now) {
  if (now - stained_at_ < scene.quality.stain_s) return;
  stained_at_ = now;
  stain(scene);
}

}  // namespace burr::render
