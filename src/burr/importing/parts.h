// importing/parts.h - the separate parts of what would become bone, and which of them are kept: a
// scan also holds the table, the head rest, the cylinder of the scanner, and islands of noise.
//
// The rule: two voxels belong to one part if both are inside and they share a face (6
// neighbours); over an edge or a corner they do not touch. Counted in the bone's own voxels, of grey
// scans after smoothing. The field and the mesh have the same parts (settle.h, surface/mesher.h), and
// the volume of a part is what its mesh encloses (part_volumes.h).
//
//     auto parts = find_parts(grid.size, row, progress);        // row: which voxels are inside
//     auto chosen = choose_parts(*parts, recipe, place);        // chosen->kept, chosen->notices
//     if (chosen->removes()) remove_values(*parts, chosen->kept, grey.voxels);
//
// A part that is removed has no voxel beside a voxel of a part that is kept: else they were one.
// So the edges of the grid on which the surface of a kept part lies keep the values at both their
// ends, and the surface stays where it was.
//
// Memory: 12 bytes for each run, a stretch of inside voxels in one row, and 8 for each row; a head
// of 512^3 voxels has about three million runs, 40 MB. At worst, every other voxel is inside, 6
// bytes a voxel. Cost: one pass, with one thread. Units: voxels, and mm where the name
// says so. Thread: any.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/scenario/recipe.h"

namespace burr::importing {

struct Run {
  int from = 0, to = 0;    // voxels from .. to - 1 of the row
  std::uint32_t part = 0;  // index into Parts::parts
};

struct Parts {
  math::Ijk size = {0, 0, 0};
  std::vector<std::size_t> starts;  // the runs of row j + ny k: starts[row] .. starts[row + 1]
  std::vector<Run> runs;            // in the order of the voxels
  std::vector<std::int64_t> parts;  // voxels of each; the largest first, equal ones as they lie
  std::vector<double> volumes;      // enclosed by the surface of each [voxel]; empty: not measured
  std::vector<math::Ijk> first;     // its first voxel, in the order of the voxels
  [[nodiscard]] std::optional<std::uint32_t> part_at(const math::Ijk& voxel) const;
};

// Sets the bytes of a row to 1 where the voxel is inside, else to 0.
using InsideRow = std::function<void(int j, int k, std::span<std::uint8_t> row)>;

// None: cancelled.
[[nodiscard]] std::optional<Parts> find_parts(const math::Ijk& size, const InsideRow& inside,
                                              Progress& progress);

// Parts below this volume are called islands.  [mm3]
inline constexpr double kIslandMm3 = 0.1;

// The separate parts of the bone (importing/parts.h), and which of them the recipe removes.
struct PartsFound {
  std::size_t count = 0;  // before any is removed
  double mm3 = 0;         // of all, enclosed by their surfaces
  double largest_mm3 = 0;
  std::size_t islands = 0;  // parts below kIslandMm3
  std::size_t removed = 0;
  double removed_mm3 = 0;          // of all that are removed
  double largest_removed_mm3 = 0;  // of the largest of them
};

// Where the voxels lie: voxel n has its centre at origin_mm + axes * (n * voxel_mm).
struct Place {
  math::Vec3 origin_mm = math::Vec3::Zero(), voxel_mm = math::Vec3::Ones();
  math::Mat3 axes = math::Mat3::Identity();
};

struct ChosenParts {
  std::vector<bool> kept;  // of each part
  PartsFound found;
  std::vector<std::string> notices;
  [[nodiscard]] bool removes() const { return found.removed > 0; }
};

// What recipe.keep and recipe.drop_islands_mm3 say of these parts. Error: a point that is not in
// bone, or nothing that is left.
[[nodiscard]] Result<ChosenParts> choose_parts(const Parts& parts,
                                               const scenario::BoneRecipe& recipe,
                                               const Place& place);

// Gives the voxels of the parts that are not kept the mean value of the voxels around their part;
// these lie below the level. voxels: greys, or solid shares of voxels.
void remove_values(const Parts& parts, const std::vector<bool>& kept,
                   std::vector<std::int16_t>& voxels);
void remove_values(const Parts& parts, const std::vector<bool>& kept,
                   std::vector<std::uint8_t>& voxels);
// The same with the label that is most frequent around the part. labels: of the same size.
void remove_labels(const Parts& parts, const std::vector<bool>& kept,
                   std::vector<std::uint8_t>& labels);

}  // namespace burr::importing
