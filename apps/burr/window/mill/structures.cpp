#include "window/mill/structures.h"

#include <algorithm>
#include <array>

#include "burr/render/unseen.h"
#include "shared/word_names.h"

namespace burr::app {

using math::Vec3;
using volume::TissueId;
using volume::TissueKind;

namespace {

constexpr double kDeepest = 80e-3;  // one looks no deeper through transparent bone [m]

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool must_be_spared(const volume::Tissue& tissue, const scenario::CaseLesson* lesson,
                    const scenario::Case* work_case) {
  if (work_case == nullptr) return tissue.spare;
  if (has(work_case->spare, tissue.name)) return true;
  return lesson != nullptr && std::any_of(lesson->structures.begin(), lesson->structures.end(),
                                          [&](const scenario::Structure& one) {
                                            return (one.intact == scenario::Intact::soft ||
                                                    one.intact == scenario::Intact::solid) &&
                                                   has(one.names, tissue.name);
                                          });
}

// spared, soft, solid, air
int group(const Structures::Row& row) {
  if (row.spare) return 0;
  return row.kind == TissueKind::soft ? 1 : row.kind == TissueKind::solid ? 2 : 3;
}

std::vector<Structures::Row> rows_of(const volume::Bone& bone, const scenario::CaseLesson* lesson,
                                     const scenario::Case* work_case) {
  std::vector<Structures::Row> rows;
  const auto& tissues = bone.tissues().tissues;
  for (std::size_t n = 1; n < tissues.size() && n < 256; ++n)
    rows.push_back({static_cast<TissueId>(n), tissues[n].kind,
                    must_be_spared(tissues[n], lesson, work_case), false, std::nullopt});
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto& a, const auto& b) { return group(a) < group(b); });
  return rows;
}

std::vector<bool> wanted(const std::vector<Structures::Row>& rows) {
  std::vector<bool> all(256);
  for (const Structures::Row& row : rows) all[row.id] = row.spare || row.kind == TissueKind::soft;
  return all;
}

}  // namespace

Structures::Structures(const volume::Bone& bone, const scenario::CaseLesson* lesson,
                       const scenario::Case* work_case)
    : bone_(bone), rows_(rows_of(bone, lesson, work_case)), map_(bone, wanted(rows_)) {
  std::erase_if(rows_, [this](const Row& row) { return map_.voxels(row.id) == 0; });
}

std::string Structures::name(TissueId id) const { return anatomy(bone_.tissues()[id].name); }

void Structures::measure(const Vec3& tip, double radius) {
  for (Row& row : rows_) {
    row.distance = map_.distance(row.id, tip);
    if (row.distance) *row.distance -= radius;
  }
}

void Structures::toggle(TissueId id) {
  for (Row& row : rows_)
    if (row.id == id && row.kind == TissueKind::soft) row.hidden = !row.hidden;
}

bool Structures::hidden(TissueId id) const {
  return std::any_of(rows_.begin(), rows_.end(),
                     [id](const Row& row) { return row.id == id && row.hidden; });
}

void Structures::hide_in(std::vector<render::Colour>& colours) const {
  for (const Row& row : rows_)
    if (row.hidden && row.id < colours.size()) colours[row.id] = render::kUnseen;
}

TissueId Structures::label(const Vec3& p) const {
  const math::Ijk at = bone_.grid().grid_from_world(p).array().round().cast<int>();
  return bone_.grid().contains(at) ? bone_.shared_tissue(at.x(), at.y(), at.z()) : TissueId{0};
}

TissueId Structures::at(const Vec3& p) const {
  const math::Ijk at = bone_.grid().grid_from_world(p).array().round().cast<int>();
  if (!bone_.grid().contains(at)) return 0;
  const TissueId id = bone_.shared_tissue(at.x(), at.y(), at.z());
  if (bone_.tissues()[id].kind != TissueKind::solid) return id;
  // solid tissue may be gone
  const math::Ijk brick = at / volume::kBrickEdge, in = at - brick * volume::kBrickEdge;
  volume::BrickField field = {};
  constexpr int kTries = 8;  // while the servo writes this brick
  bool read = false;
  for (int n = 0; n < kTries && !read; ++n)
    read = bone_.copy_brick(bone_.brick_at(brick.x(), brick.y(), brick.z()), field);
  const auto place = static_cast<std::size_t>(in.x() + 8 * (in.y() + 8 * in.z()));
  return !read || field.voxel[place] >= volume::kIso ? id : TissueId{0};
}

std::optional<Structures::Seen> Structures::under(const render::Scene& scene,
                                                  const render::Ray& ray) const {
  const auto hit = render::pick(scene, ray);
  if (!hit) return std::nullopt;
  const double step = 0.5 * bone_.grid().voxel;
  // soft tissue fills a hollow up to its wall: where the wall lies open, one sees the tissue
  for (int n = 1; n <= 4; ++n)
    if (const TissueId id = label(hit->p + n * step * hit->n); is_soft(id)) return Seen{id, hit->p};
  if (scene.look.opacity < 1)
    for (double deep = step; deep < kDeepest; deep += step) {
      const Vec3 p = hit->p + deep * ray.direction;
      if (const TissueId id = label(p); is_soft(id) && !hidden(id)) return Seen{id, p};
    }
  return Seen{hit->tissue, hit->p};
}

}  // namespace burr::app
