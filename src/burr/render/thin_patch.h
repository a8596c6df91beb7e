// render/thin_patch.h - fewer triangles over the same vertices of one patch, for a picture drawn by the
// processor. Needs no other patch, so it fits bones whose blocks (coarsening.h) would always hold some
// fresh cut, and places without a thread for it.
//
//     const std::vector<CoarseLevel> levels = thinned(mesh, errors);
//
// The border of the patch stays as it is, edge by edge, and so does the border between two tissues:
// the patch meets its neighbours without a crack, and no colour moves. Method: edge collapses onto
// one of the two ends, by quadric errors (Garland & Heckbert 1997).
// Thread: any. Units: m.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "burr/render/coarse_mesh.h"
#include "burr/render/skin_mesh.h"

namespace burr::render {

// errors: approximate distance of each level from the patch, increasing [m]. One level for each; a
// level that would save little is left out.
[[nodiscard]] std::vector<CoarseLevel> thinned(const SkinMesh& mesh,
                                               std::span<const double> errors);
// The same for any mesh without seams inside; triangles: (n x 3).
[[nodiscard]] std::vector<CoarseLevel> thinned(std::span<const SkinVertex> vertices,
                                               std::vector<std::uint32_t> triangles,
                                               std::span<const double> errors);

}  // namespace burr::render
