#include "burr/importing/voxel_tissue.h"

#include <algorithm>
#include <cmath>

#include "burr/importing/tissues.h"

namespace burr::importing {
namespace {

using block::at;
using block::kBlock;
using block::kHalo;
using block::kPlane;
using volume::kBrickEdge;
using volume::TissueId;

// Neighbours within 2.5 voxels, nearest first.
const std::vector<math::Ijk>& near_offsets() {
  static const std::vector<math::Ijk> all = [] {
    std::vector<math::Ijk> found;
    for (int z = -2; z <= 2; ++z)
      for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x)
          if (x * x + y * y + z * z > 0 && x * x + y * y + z * z <= 8) found.emplace_back(x, y, z);
    std::stable_sort(found.begin(), found.end(), [](const math::Ijk& a, const math::Ijk& b) {
      return a.squaredNorm() < b.squaredNorm();
    });
    return found;
  }();
  return all;
}

bool is_beyond(const InsideGrid& grid, const math::Ijk& p) {
  return p.minCoeff() < 0 || (p.array() >= grid.size.array()).any();
}

// To the nearest whole number, halves away from 0, like std::lround, but without a call.
std::int16_t nearest(double value) {
  const double bounded = std::clamp(value, -32768.0, 32767.0);
  const int whole = static_cast<int>(bounded);
  const double rest = bounded - whole;
  return static_cast<std::int16_t>(whole + static_cast<int>(rest >= 0.5) -
                                   static_cast<int>(rest <= -0.5));
}

// Writes the densest value within two voxels to desk.work_greys, one axis after the other.
void find_densest(Desk& desk) {
  const auto densest = [](const std::int16_t* from, int stride, std::int16_t* result) {
    for (int x = 0; x < kBrickEdge; ++x)
      result[x] = std::max({from[x], from[x - stride], from[x + stride], from[x - 2 * stride],
                            from[x + 2 * stride]});
  };
  constexpr int kFirst = kHalo, kEnd = kHalo + kBrickEdge;
  const auto along = [&](const auto& from, int stride, auto& to, int wider_y, int wider_z) {
    for (int z = kFirst - wider_z; z < kEnd + wider_z; ++z)
      for (int y = kFirst - wider_y; y < kEnd + wider_y; ++y) {
        const auto row = static_cast<std::size_t>(at(kFirst, y, z));
        densest(&from[row], stride, &to[row]);
      }
  };
  along(desk.greys, 1, desk.work_greys, 2, 2);
  along(desk.work_greys, kBlock, desk.most, 0, 2);
  along(desk.most, kPlane, desk.work_greys, 0, 0);
}

}  // namespace

void label_tissue(const InsideGrid& grid, const math::Ijk& first, const Desk& desk,
                  const math::Ijk& room, const Target& to) {
  for (int z = 0; z < room.z(); ++z)
    for (int y = 0; y < room.y(); ++y)
      for (int x = 0; x < room.x(); ++x) {
        const int v = x + kBrickEdge * (y + kBrickEdge * z),
                  a = at(x + kHalo, y + kHalo, z + kHalo);
        const std::uint8_t own = desk.labels[static_cast<std::size_t>(a)];
        TissueId id = grid.tissue[own];
        // a label that is not solid ends with the scan
        if (!grid.solid[own] && is_beyond(grid, first + math::Ijk(x, y, z))) id = 0;
        if (id == 0 && to.field[v] > 0)
          for (const math::Ijk& off : near_offsets()) {
            const std::uint8_t label =
                desk.labels[static_cast<std::size_t>(a + at(off.x(), off.y(), off.z()))];
            if (!grid.solid[label]) continue;
            id = grid.tissue[label];
            break;
          }
        to.tissue[v] = id;
      }
}

GreyTable::GreyTable(const InsideGrid& grid, const GreyTissue& rule) : grid_(grid), rule_(rule) {
  if (grid.grey == nullptr) return;
  constexpr int kValues = 65536;
  tissue_.resize(kValues);
  intensity_.resize(kValues);
  for (int v = 0; v < kValues; ++v) {
    const auto grey = static_cast<std::int16_t>(v - 32768);
    intensity_[static_cast<std::size_t>(v)] = intensity(level(grey));
    tissue_[static_cast<std::size_t>(v)] =
        rule.by_hu ? hu_tissue((level(grey) + double{grid.iso}) * rule.step + rule.zero)
                   : TissueId{1};
  }
}

std::int16_t GreyTable::intensity(double level) const {
  return nearest((double{grid_.iso} + level) * rule_.step + rule_.zero);
}

void grey_tissue_of(const InsideGrid& grid, const GreyTable& table, const math::Ijk& first,
                    bool ramps, Desk& desk, const math::Ijk& room, const Target& to) {
  if (ramps) find_densest(desk);
  const bool any_beyond =
      is_beyond(grid, first) || is_beyond(grid, first + room - math::Ijk::Ones());
  for (int z = 0; z < room.z(); ++z)
    for (int y = 0; y < room.y(); ++y)
      for (int x = 0; x < room.x(); ++x) {
        const int v = x + kBrickEdge * (y + kBrickEdge * z);
        const auto a = static_cast<std::size_t>(at(x + kHalo, y + kHalo, z + kHalo));
        const std::int16_t own = desk.greys[a];
        if (to.intensity != nullptr)
          to.intensity[v] =
              table.intensity(own, any_beyond && is_beyond(grid, first + math::Ijk(x, y, z)));
        const bool ramp = to.field[v] < volume::kSolid;
        to.tissue[v] =
            to.field[v] == 0 ? TissueId{0} : table.tissue(ramp && ramps ? desk.work_greys[a] : own);
      }
}

}  // namespace burr::importing
