// surface/label_surface.h - a smooth closed surface around the voxels of one label: nerves, vessels,
// dura, which the bone's own surface does not show.
//
// Labels are stairs. The surface is made of their share in each voxel's neighbourhood (a binomial
// filter of five, variance one voxel), held on the label's side of one half at every voxel, so that
// no thin membrane gets a hole and no voxel is lost. The mesh is then smoothed without shrinking
// (Taubin 1995); no vertex moves more than half a voxel. A face that is flat and nearly parallel to
// the voxels would keep long terraces: flat faces are smoothed again as a net under tension that keeps
// within 0.6 voxel of its labels (Gibson 1998, Constrained Elastic Surface Nets). Normals are smoothed further than places,
// since an eye sees a stair by its shading. A smooth tube three voxels across or more is true to half
// a voxel; thinner ones get ragged (tests/surface/label_surface_test.cpp).
//
// Thread: any, while nobody writes the bone. Frame: world (LPS). Units: m. Memory: 1.5 KiB for each
// brick at the label, and that of the mesh. Cost: that of its surface, not of its volume.
#pragma once

#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/surface/patch.h"
#include "burr/volume/bone.h"

namespace burr::surface {

// The tissues of kind `soft` of which there is at least one voxel, in ascending order.
[[nodiscard]] std::vector<volume::TissueId> soft_tissues(const volume::Bone& bone);

// Closed and oriented; empty if no voxel has this label. Every vertex has this tissue. Errors:
// Trouble::interrupted if progress is cancelled.
[[nodiscard]] Result<Mesh> label_surface(const volume::Bone& bone, volume::TissueId tissue,
                                         Progress& progress);

}  // namespace burr::surface
