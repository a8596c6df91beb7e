// metrics/cover.h - how much bone lies over a structure, seen through what was cut away.
//
//     tau(s) = min over looks w through the cavity of   integral sigma_after(s + l w) dl
//     t(s)   = n . w  times the same minimum over the looks with n . w >= 1/2
//
// s: a sample of the structure's surface, n its normal; the looks are those of look_directions.h; sigma and rho
// are those of solidity.h. A look w goes through the cavity if it crosses removed material: integral
// of rho at least w0 = max(1 mm, 2 h). Without this condition half of a nerve is "found" before the
// first cut, because nerves lie in canals and beside air. No such look: tau and t are infinite.
// tau is the length of bone on the best line of sight, t the thickness of the layer across.
// (The least product over all looks would not do for t: aslant looks halve the layer over the flank of a tube. Nor would the look
// that gave tau: from the flank it goes through the tube and out at its crown, so half of a sinus under 2 mm counted as under 1 mm.)
//
// With `exposed`, the look must also come into the air that was opened (open_cavity.h), and what lies before that counts as
// bone, cells included: what is found is exposed as an area, not seen along lines through cells.
//
// Samples that were open from the start leave the patch: in no look does the bone before the cut have
// 0.2 mm within 3 mm. If they were more than half of its weight, it is not assessable.
//
// One pass: all measures of one structure and region (identified, skeletonised, intact plate) read
// the same Cover. The result does not depend on the number of threads.
// Frame: world. Units: m. Thread: uses `threads` of its own. Cost: docs/teach/metrics.md.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/open_cavity.h"
#include "burr/metrics/region.h"
#include "burr/metrics/structure_patch.h"
#include "burr/metrics/voxel_set.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct CoverSettings {
  std::vector<math::Vec3> towards = {};  // from the bone to the surgeon: one or several directions
  std::vector<volume::TissueId> glass = {};  // soft tissues that hide nothing (eardrum, marrow)
  double cap = 3e-3;                         // longer lengths of bone count as this         [m]
  double least_removed = 1e-3;               // w0, but at least two voxels                 [m]
  std::size_t most_samples = 600;            // 0: all; take more where areas are measured
  const OpenCavity* exposed = nullptr;       // of the same bones; nullptr: any line of sight does
  int threads = 2;
};

inline constexpr double kUnseen = std::numeric_limits<double>::infinity();

struct CoverSample {
  SurfaceSample surface;
  double cover = kUnseen;                // tau [m]
  double thickness = kUnseen;            // t [m]
  math::Vec3 look = math::Vec3::Zero();  // the best one for tau, unit, to the surgeon; zero: none
  double plate_before = 0;  // the first layer of bone along n, before the cut; at most cap [m]
  double plate_after = 0;   // what stands of that layer before the first cut in it [m]
};

struct Cover {
  std::vector<CoverSample> samples;  // without those open from the start
  std::size_t thinned = 1;           // as Patch::thinned
  double weight = 0;                 // sum of the samples' faces
  double open_share = 0;             // of the patch's weight, left out: open from the start
  double voxel = 0;                  // h [m]
  double error = 0;                  // of tau, t: max(0.05 mm, 0.2 h); of solid structures h
};

// before, after: the same grid. Not assessable: see patch_of(), and above.
[[nodiscard]] Assessed<Cover> cover_of(const volume::Bone& before, const volume::Bone& after,
                                       const VoxelSet& structure, const Region& region,
                                       const CoverSettings& settings);

}  // namespace burr::metrics
