#include "burr/metrics/main_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>

#include "burr/volume/volume_of.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using volume::Field;

constexpr double kGap = 0.75e-3;  // [m]
constexpr double kJoins = 0.5;    // a voxel of which less is gone joins nothing
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

using Cell = std::array<int, 3>;

struct Piece {
  std::size_t parent = 0;
  double volume = 0;  // [voxel]
};
using Cells = std::map<Cell, std::size_t>;  // the number of each one's piece

Cell cell_of(const Vec3& place, double edge) {
  Cell cell = {};
  for (int a = 0; a < 3; ++a)
    cell[static_cast<std::size_t>(a)] = static_cast<int>(std::floor(place[a] / edge));
  return cell;
}

// Calls use(cell) for the cells about one that are at most `far` away along each axis, itself among them.
template <class Use>
void for_each_about(const Cell& cell, int far, const Use& use) {
  for (int k = -far; k <= far; ++k)
    for (int j = -far; j <= far; ++j)
      for (int i = -far; i <= far; ++i) use(Cell{cell[0] + i, cell[1] + j, cell[2] + k});
}

std::size_t root_of(std::vector<Piece>& pieces, std::size_t n) {
  while (pieces[n].parent != n) n = pieces[n].parent = pieces[pieces[n].parent].parent;
  return n;
}

std::vector<Gone> all_gone(const volume::Bone& before, const volume::Bone& after,
                           const Region& region) {
  std::vector<Gone> gone;
  const volume::Grid& grid = before.grid();
  for (volume::BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    const Field *was = before.brick_field(brick), *is = after.brick_field(brick);
    if (was == nullptr) continue;
    const math::Ijk first = before.brick_ijk(brick);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const std::int32_t units =
          volume::volume_units(std::int32_t{was[v]}) -
          volume::volume_units(std::int32_t{is == nullptr ? Field{0} : is[v]});
      if (units <= 0) continue;
      const math::Ijk at = first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
      const Vec3 place = grid.world_from_grid(at.cast<double>());
      if (!contains(region, place)) continue;
      gone.push_back(
          {place, static_cast<double>(units) / static_cast<double>(volume::kVoxelUnits)});
    }
  }
  return gone;
}

// The cells that hold a voxel of which most is gone, and the piece of each.
Cells cells_of(const std::vector<Gone>& gone, double edge, std::vector<Piece>& pieces) {
  Cells cells;
  for (const Gone& one : gone)
    if (one.share >= kJoins && cells.emplace(cell_of(one.place, edge), pieces.size()).second)
      pieces.push_back({pieces.size(), 0});
  for (const auto& [cell, number] : cells)
    for_each_about(cell, 2, [&, mine = number](const Cell& beside) {
      const auto other = cells.find(beside);
      if (other == cells.end()) return;
      const std::size_t a = root_of(pieces, mine), b = root_of(pieces, other->second);
      pieces[std::max(a, b)].parent = std::min(a, b);
    });
  for (const Gone& one : gone)
    if (const auto own = cells.find(cell_of(one.place, edge)); own != cells.end())
      pieces[root_of(pieces, own->second)].volume += one.share;
  return cells;
}

}  // namespace

MainCut main_cut(const volume::Bone& before, const volume::Bone& after, const Region& region) {
  MainCut out;
  const std::vector<Gone> gone = all_gone(before, after, region);
  // between the centres of voxels on both sides of a gap lies a voxel more; cells two apart are joined
  const double edge = 0.5 * (kGap + before.grid().voxel);
  std::vector<Piece> pieces;
  const Cells cells = cells_of(gone, edge, pieces);
  std::size_t largest = kNone;
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    if (pieces[n].parent != n) continue;
    ++out.others;
    if (largest == kNone || pieces[n].volume > pieces[largest].volume) largest = n;
  }
  if (largest == kNone) return out;
  --out.others;
  // a voxel that is partly gone belongs to the piece beside it
  std::set<Cell> near;
  for (const auto& [cell, number] : cells)
    if (root_of(pieces, number) == largest)
      for_each_about(cell, 1, [&near](const Cell& beside) { near.insert(beside); });
  double all = 0, left_out = 0;
  for (const Gone& one : gone) {
    all += one.share;
    if (near.contains(cell_of(one.place, edge)))
      out.gone.push_back(one);
    else
      left_out += one.share;
  }
  out.others_share = left_out / all;
  return out;
}

}  // namespace burr::metrics
