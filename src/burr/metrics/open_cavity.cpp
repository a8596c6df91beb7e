#include "burr/metrics/open_cavity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "burr/base/check.h"

namespace burr::metrics {
namespace {

using math::Ijk;
using volume::Bone;

// A surface lies on average this much before the centre of the first voxel behind it [voxel].
constexpr double kBeforeCentre = 0.3;

VoxelBox box_between(const Ijk& lo, const Ijk& hi, int grown, const Ijk& size) {
  const Ijk first = (lo.array() - grown).max(0), end = (hi.array() + grown).min(size.array());
  return {first, (end - first).cwiseMax(0)};
}

// The box around the bricks whose field differs; empty: none does.
VoxelBox changed(const Bone& before, const Bone& after, int grown) {
  const Ijk& size = before.grid().size;
  Ijk lo = size, hi = Ijk::Zero();
  for (volume::BrickIndex b = 0; b < before.brick_count(); ++b) {
    const volume::Field *was = before.brick_field(b), *is = after.brick_field(b);
    if (was == is) continue;
    if (was != nullptr && is != nullptr &&
        std::memcmp(was, is, volume::kBrickVoxels * sizeof(volume::Field)) == 0)
      continue;
    const Ijk first = before.brick_ijk(b);
    lo = lo.cwiseMin(first);
    hi = hi.cwiseMax(first + Ijk::Constant(volume::kBrickEdge));
  }
  return (hi.array() > lo.array()).all() ? box_between(lo, hi, grown, size) : VoxelBox{};
}

// What stops a ball.
std::vector<std::uint8_t> full_in(const VoxelBox& box, const Bone& before, const Bone& after,
                                  const std::vector<volume::TissueId>& glass) {
  std::array<bool, 256> hides = {};
  for (std::size_t id = 1; id < before.tissues().tissues.size() && id < hides.size(); ++id)
    hides[id] = before.tissues().tissues[id].kind == volume::TissueKind::soft;
  for (const volume::TissueId id : glass) hides[id] = false;
  std::vector<std::uint8_t> full(box.count());
  std::size_t n = 0;
  for (int k = 0; k < box.size.z(); ++k)
    for (int j = 0; j < box.size.y(); ++j)
      for (int i = 0; i < box.size.x(); ++i, ++n) {
        const Ijk v = box.first + Ijk(i, j, k);
        full[n] = after.field(v.x(), v.y(), v.z()) >= volume::kIso ||
                  hides[before.tissue(v.x(), v.y(), v.z())];
      }
  return full;
}

// From the removed voxels through all that a centre may pass.
std::vector<std::uint8_t> flood(const VoxelBox& box, const Bone& before,
                                const std::vector<std::uint8_t>& may_pass) {
  std::vector<std::uint8_t> reached(box.count(), 0);
  std::vector<std::size_t> todo;
  for (std::size_t n = 0; n < reached.size(); ++n) {
    if (may_pass[n] == 0) continue;
    const Ijk v = box.first + box.at(n);
    if (before.field(v.x(), v.y(), v.z()) < volume::kIso) continue;
    reached[n] = 1;
    todo.push_back(n);
  }
  while (!todo.empty()) {
    const Ijk v = box.at(todo.back());
    todo.pop_back();
    for (int n = 0; n < 27; ++n) {
      const Ijk w = v + Ijk(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      if (!box.has(w)) continue;
      const std::size_t m = box.index(w);
      if (may_pass[m] == 0 || reached[m] != 0) continue;
      reached[m] = 1;
      todo.push_back(m);
    }
  }
  return reached;
}

// Air that is open by an opened cell alone: it was there before the cut, and is neither near to what was removed nor wide.
std::vector<std::uint8_t> cells_in(const VoxelBox& box, const Bone& before,
                                   const std::vector<std::uint8_t>& open,
                                   const std::vector<std::int32_t>& apart,
                                   const OpenCavitySettings& settings) {
  const double h = before.grid().voxel, deep = settings.cells / h, wide = settings.wide / h;
  std::vector<std::uint8_t> cells(box.count()), removed(box.count()), balls(box.count());
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const Ijk v = box.first + box.at(n);
    cells[n] = before.field(v.x(), v.y(), v.z()) < volume::kIso;
    removed[n] = open[n] != 0 && cells[n] == 0 && apart[n] > 0;
    balls[n] = open[n] != 0 && apart[n] >= wide * wide;
  }
  const auto to_removed = squared_distances(box, removed, settings.threads);
  const auto to_ball = squared_distances(box, balls, settings.threads);
  for (std::size_t n = 0; n < cells.size(); ++n)
    if (to_removed[n] <= deep * deep || to_ball[n] <= (wide + 1) * (wide + 1)) cells[n] = 0;
  return cells;
}

}  // namespace

OpenCavity::OpenCavity(const Bone& before, const Bone& after, const OpenCavitySettings& settings)
    : size_(before.grid().size) {
  BURR_CHECK(before.grid().size == after.grid().size);
  const double h = before.grid().voxel, r = settings.rho / h;
  box_ = changed(before, after, static_cast<int>(std::ceil(settings.around / h)));
  if (box_.count() == 0) return;
  const auto apart =
      squared_distances(box_, full_in(box_, before, after, settings.glass), settings.threads);
  const double least = (r + kBeforeCentre) * (r + kBeforeCentre), most = (r + 1) * (r + 1);
  std::vector<std::uint8_t> may_pass(box_.count());
  for (std::size_t n = 0; n < may_pass.size(); ++n) may_pass[n] = apart[n] >= least;
  std::vector<std::uint8_t> centres = flood(box_, before, may_pass);
  const auto within = [&] {
    const auto to_centre = squared_distances(box_, centres, settings.threads);
    std::vector<std::uint8_t> out(box_.count());
    for (std::size_t n = 0; n < out.size(); ++n) out[n] = to_centre[n] <= most;
    return out;
  };
  const auto cells = cells_in(box_, before, within(), apart, settings);
  for (std::size_t n = 0; n < centres.size(); ++n) centres[n] = centres[n] & ~cells[n] & 1;
  if (std::none_of(centres.begin(), centres.end(), [](std::uint8_t one) { return one != 0; }))
    return;
  open_ = within();
  for (std::size_t n = 0; n < open_.size(); ++n) open_[n] = open_[n] & ~cells[n] & 1;
}

bool OpenCavity::has(const math::Vec3& p) const {
  if (open_.empty()) return false;
  Ijk v;
  for (int a = 0; a < 3; ++a) v[a] = static_cast<int>(std::floor(p[a] + 0.5));
  if ((v.array() < 0).any() || (v.array() >= size_.array()).any()) return true;
  const Ijk in = v - box_.first;
  return box_.has(in) && open_[box_.index(in)] != 0;
}

}  // namespace burr::metrics
