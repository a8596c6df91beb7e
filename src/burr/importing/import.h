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
// Memory: the scan, twice 2 bytes a voxel while working, then the bone. See BoneRecipe::memory_mb.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/importing/import_summary.h"
#include "burr/importing/scan_questions.h"
#include "burr/io/scan.h"
#include "burr/scenario/recipe.h"
#include "burr/volume/bone.h"
#include "burr/volume/greys.h"

namespace burr::importing {

struct Imported {
  std::unique_ptr<volume::Bone> bone;
  ImportSummary summary;
  std::shared_ptr<const volume::Greys> greys;  // if keep_greys is set
};

// Makes all decisions of an import without building anything.
[[nodiscard]] Result<ImportSummary> plan_import(const io::Scan& scan,
                                                const scenario::BoneRecipe& recipe);

// The separate parts of the bone that an import would make, before any is removed, and where they
// lie; choose_parts() says what the recipe removes. Takes the time of an import: only the finished
// surface says how much each part encloses.
[[nodiscard]] Result<FoundParts> parts_of(const io::Scan& scan, const scenario::BoneRecipe& recipe,
                                          Progress& progress);
// The same for a plan: fills `parts` of the summary and adds to its notices.
[[nodiscard]] Status count_parts(const io::Scan& scan, const scenario::BoneRecipe& recipe,
                                 Progress& progress, ImportSummary& summary);

// Every label that occurs in a label map, and the tissue it becomes; labels that become air have id
// 0. Empty for a grey scan.
[[nodiscard]] Result<std::vector<TissueFound>> labels_of(const io::Scan& scan,
                                                         const scenario::BoneRecipe& recipe);

// keep_greys: of a grey scan, to be looked at.
[[nodiscard]] Result<Imported> import_bone(const io::Scan& scan, const scenario::BoneRecipe& recipe,
                                           Progress& progress, bool keep_greys = false);

}  // namespace burr::importing
