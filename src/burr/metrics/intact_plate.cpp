#include "burr/metrics/intact_plate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "burr/math/sums.h"
#include "burr/metrics/same_math.h"

namespace burr::metrics {
namespace {

using math::Vec3;

std::size_t root_of(std::vector<std::size_t>& parent, std::size_t n) {
  while (parent[n] != n) n = parent[n] = parent[parent[n]];
  return n;
}

// Samples belong together if they are neighbours, also across a corner; thinned samples lie farther
// apart.
std::vector<IntactPlate::Hole> holes_of(const std::vector<const CoverSample*>& bare, double voxel,
                                        std::size_t thinned) {
  const double reach = voxel * 1.8 * std::sqrt(static_cast<double>(thinned));
  std::vector<std::size_t> parent(bare.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  for (std::size_t a = 0; a < bare.size(); ++a)
    for (std::size_t b = a + 1; b < bare.size(); ++b)
      if (math::squared_norm(bare[a]->surface.place - bare[b]->surface.place) <= reach * reach) {
        const std::size_t u = root_of(parent, a), v = root_of(parent, b);
        parent[std::max(u, v)] = std::min(u, v);
      }
  std::vector<IntactPlate::Hole> pieces(bare.size());
  for (std::size_t n = 0; n < bare.size(); ++n) {
    IntactPlate::Hole& piece = pieces[root_of(parent, n)];
    piece.area += bare[n]->surface.area;
    piece.at += bare[n]->surface.place;
    ++piece.samples;
  }
  std::erase_if(pieces, [](const IntactPlate::Hole& one) { return one.samples == 0; });
  for (IntactPlate::Hole& one : pieces) one.at /= static_cast<double>(one.samples);
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const auto& a, const auto& b) { return a.area > b.area; });
  return pieces;
}

}  // namespace

Assessed<IntactPlate> intact_plate(const Cover& cover, const Worked& worked,
                                   const IntactPlateSettings& settings) {
  IntactPlate out;
  std::vector<const CoverSample*> bare;
  double thin = 0, area = 0;
  for (const CoverSample& one : cover.samples) {
    if (one.plate_before < 2 * cover.voxel) {
      thin += one.surface.faces;
    } else if (one.cover <= settings.bare && one.plate_after <= settings.bare) {
      bare.push_back(&one);
      area += one.surface.area;
    }
  }
  out.thin_share = thin / cover.weight;
  if (out.thin_share > 0.5)
    return NotAssessable{
        "the plate of bone over the structure was thinner than two voxels before "
        "the first cut; it needs finer voxels"};
  out.holes = holes_of(bare, cover.voxel, cover.thinned);
  // thinned samples know the rim to their own distance
  const double rim = 0.6 * cover.voxel * std::sqrt(static_cast<double>(cover.thinned));
  double error = 0;
  for (const IntactPlate::Hole& one : out.holes) error += 2 * rim * std::sqrt(kPi * one.area);
  out.mark = intact_mark(area, settings.most_area, error, worked);
  return out;
}

}  // namespace burr::metrics
