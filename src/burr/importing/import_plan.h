// importing/import_plan.h - all decisions of an import, before anything is built. Internal to importing.
// Units: mm, voxels, and the scan's values. Thread: any.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burr/importing/import_summary.h"
#include "burr/importing/materials.h"
#include "burr/importing/scan_questions.h"
#include "burr/importing/tissues.h"
#include "burr/io/scan.h"
#include "burr/scenario/recipe.h"

namespace burr::importing {

struct Plan {
  ImportSummary summary;
  LabelTissues labels;
  volume::TissueTable grey_tissues;
  std::array<std::int64_t, 256> counts{};  // voxels of each label in the region
  math::Vec3 scale = math::Vec3::Ones();   // size of a new voxel, in old voxels
  math::Vec3 first =
      math::Vec3::Zero();  // centre of the first new voxel, in old voxels of the region
};
[[nodiscard]] Result<Plan> make_plan(const io::Scan& scan, const scenario::BoneRecipe& recipe);

// The labels of a region of a scan.
struct LabelRegion {
  const std::uint8_t* labels = nullptr;  // of a box of `size` voxels (x fastest)
  math::Ijk size = {0, 0, 0}, from = {0, 0, 0};
  [[nodiscard]] const std::uint8_t* row(int j, int k) const {
    return labels + static_cast<std::size_t>(from.x()) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(from.y() + j) +
                static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(from.z() + k));
  }
};
[[nodiscard]] std::array<std::int64_t, 256> count_labels(const LabelRegion& region,
                                                         const math::Ijk& size);
[[nodiscard]] std::array<bool, 256> solid_labels(const Plan& plan);
[[nodiscard]] Result<Materials> materials_of(const scenario::BoneRecipe& recipe);

}  // namespace burr::importing
