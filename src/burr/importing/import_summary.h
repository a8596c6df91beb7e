// importing/import_summary.h - what an import did, or would do, and the parts that it found.
// Units: mm, HU or the file's own unit for values. Plain data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/importing/bone_level.h"
#include "burr/importing/parts.h"
#include "burr/volume/tissue.h"

namespace burr::importing {

// One tissue of the result.
struct TissueFound {
  volume::TissueId id = 0;
  volume::Tissue tissue;
  std::int64_t voxels = 0;  // label maps: voxels of the file inside the region
  double volume_mm3 = 0;    // of those voxels
  bool assumed = false;     // solid, because its name does not say what it is, nor does a table
};

// What an import did, or would do.
struct ImportSummary {
  std::string format, modality;  // as in Scan
  math::Ijk scan_size = {0, 0, 0};
  math::Vec3 spacing_mm = {0, 0, 0};
  math::Mat3 axes = math::Mat3::Identity();
  math::Vec3 origin_mm = math::Vec3::Zero();
  bool labels = false, hounsfield = false;
  float low = 0, high = 0;         // lowest and highest value of a grey scan
  math::Ijk roi_from = {0, 0, 0};  // in Scan's voxels
  math::Ijk roi_size = {0, 0, 0};
  math::Ijk size = {0, 0, 0};  // cubic voxels of the region; the bone's grid has layers of air
                               // around them where bone reaches the border (BoneRecipe::margin)
  double voxel_mm = 0;
  double iso = 0;  // of grey scans
  bool iso_by_otsu = false;
  bool iso_estimated = false;  // by bone_level.h: the scan is not in HU and nobody gave a level
  Sure iso_sure = Sure::low;   // of an estimate
  std::string iso_why;         // of an estimate: one sentence without its full stop
  double smooth = 0;           // noise removed, in the scan's unit; 0: none
  double memory_mb = 0;        // estimate in a plan, real value in an import
  std::vector<TissueFound> tissues;
  double solid_mm3 = 0;              // volume_of the bone; 0 in a plan
  std::optional<PartsFound> parts;   // of an import that removes parts; of a plan: count_parts()
  std::vector<std::string> notices;  // the scan's and the import's own
};

// The separate parts of a bone, before any is removed, and where they lie.
struct FoundParts {
  Parts parts;
  Place place;
};

}  // namespace burr::importing
