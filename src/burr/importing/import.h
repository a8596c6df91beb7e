// importing/import.h - makes bone from a scan: crops it, smooths it as far as touch needs, makes
// the voxels cubic, finds the surface between the voxels and names the tissues.
//
//     auto scan = io::read_scan(path, {}, progress);
//     auto made = import_bone(*scan, {}, progress);      // made->bone, made->summary
//
// Grey scans: the surface lies where linear interpolation of the (smoothed, cubic) values crosses
// the iso-level. Label maps: the surface lies halfway between a solid voxel and one that is not,
// with the staircase of the voxels smoothed and the volume of each label kept. The field is a ramp
// of the distance to that surface: field = 32768 + depth * kFieldPerVoxel within kRamp voxels of it
// (volume/bone.h). Where the border of the scan or of the region cuts bone, the bone ends in a flat
// face half a voxel beyond the last voxel, and layers of air lie behind that face: it is touched,
// cut and drawn as any other.
//
// Units: mm for what people type and read, HU or the file's own unit for values; Bone is SI.
// Thread: any; uses up to two workers; the result does not depend on their number.
// Memory: the scan, twice 2 bytes a voxel while working, then the bone. See Recipe::memory_mb.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/importing/bone_level.h"
#include "burr/importing/parts.h"
#include "burr/io/scan.h"
#include "burr/scenario/recipe.h"
#include "burr/volume/bone.h"
#include "burr/volume/greys.h"

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
                               // around them where bone reaches the border (Recipe::margin)
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

struct Imported {
  std::unique_ptr<volume::Bone> bone;
  ImportSummary summary;
  std::shared_ptr<const volume::Greys> greys;  // if keep_greys is set
};

// Whether the recipe answers this question of the reader.
[[nodiscard]] bool answered(const io::Question& question, const scenario::Recipe& recipe);

// Makes all decisions of an import without building anything.
[[nodiscard]] Result<ImportSummary> plan_import(const io::Scan& scan,
                                                const scenario::Recipe& recipe);

// The separate parts of the bone that an import would make, before any is removed, and where they
// lie; choose_parts() says what the recipe removes. Takes most of the time of an import: a grey
// scan is smoothed and made cubic first.
struct FoundParts {
  Parts parts;
  Place place;
};
[[nodiscard]] Result<FoundParts> parts_of(const io::Scan& scan, const scenario::Recipe& recipe,
                                          Progress& progress);
// The same for a plan: fills `parts` of the summary and adds to its notices.
[[nodiscard]] Status count_parts(const io::Scan& scan, const scenario::Recipe& recipe,
                                 Progress& progress, ImportSummary& summary);

// Every label that occurs in a label map, and the tissue it becomes; labels that become air have id
// 0. Empty for a grey scan.
[[nodiscard]] Result<std::vector<TissueFound>> labels_of(const io::Scan& scan,
                                                         const scenario::Recipe& recipe);

// keep_greys: of a grey scan, to be looked at.
[[nodiscard]] Result<Imported> import_bone(const io::Scan& scan, const scenario::Recipe& recipe,
                                           Progress& progress, bool keep_greys = false);

}  // namespace burr::importing
