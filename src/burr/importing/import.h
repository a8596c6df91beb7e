// importing/import.h - a scan becomes bone: cropped, smoothed as far as touch needs it, made cubic, its
// surface found between the voxels, its tissues named.
//
//     auto scan = io::read_scan(path, {}, progress);
//     auto made = import_bone(*scan, {}, progress);      // made->bone, made->summary
//
// Grey scans: the surface lies where linear interpolation of the (smoothed, cubic) values crosses
// the iso-level. Label maps: halfway between a solid voxel and one that is not, smoothed over the
// staircase, at fixed volume per label. The field is a ramp of the distance to that surface:
// field = 32768 + depth * kFieldPerVoxel within kRamp voxels of it (volume/bone.h).
//
// Units: mm for what people type and read, HU or the file's own unit for values; Bone is SI.
// Thread: any; uses up to two workers. The result does not depend on how many.
// Memory: beside the scan, 2 bytes a voxel twice while working, then the bone. See
// memory_budget_mb.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/scan.h"
#include "burr/volume/bone.h"
#include "burr/volume/greys.h"

namespace burr::importing {

// First and last voxel of a box, both inside, counted from 0 as the file does (slices as they lie
// in the file, even where Scan::k_reversed).
struct Roi {
  std::array<int, 2> i{}, j{}, k{};
};

struct ImportOptions {
  double voxel_mm = 0;  // edge of the cubic voxels; 0: the finest axis of the scan, coarser
                        // where the memory budget asks for it
  double memory_budget_mb = 2048;  // of the work and the bone, for voxel_mm = 0
  std::optional<double> iso;       // surface level, in HU or the file's unit; none: 300 HU, or Otsu
  std::optional<Roi> roi;
  double smooth = -1;        // noise to remove, standard deviation in HU or the file's unit;
                             // 0: none, below 0: as much as is measured in the scan
  std::string tissue_table;  // path of a TOML file, see docs/labels.md; empty: by name
  std::string materials;     // path of a TOML file, see docs/materials.md; empty: the built-in ones
  std::size_t reserve_bricks = 4096;  // room for deposited material
  bool keep_greys = false;            // of a grey scan, to be looked at
};

// One tissue of the result.
struct TissueFound {
  volume::TissueId id = 0;
  volume::Tissue tissue;
  std::int64_t voxels = 0;  // label maps: voxels of the file inside the region
  double volume_mm3 = 0;    // of those voxels
};

// What was, or would be, done.
struct ImportSummary {
  std::string format;
  math::Ijk scan_size = {0, 0, 0};
  math::Vec3 spacing_mm = {0, 0, 0};
  math::Mat3 axes = math::Mat3::Identity();
  math::Vec3 origin_mm = math::Vec3::Zero();
  bool labels = false, hounsfield = false;
  float low = 0, high = 0;         // values of a grey scan
  math::Ijk roi_from = {0, 0, 0};  // in Scan's voxels
  math::Ijk roi_size = {0, 0, 0};
  math::Ijk size = {0, 0, 0};  // voxels of the bone
  double voxel_mm = 0;
  double iso = 0;  // grey scans
  bool iso_by_otsu = false;
  double smooth = 0;     // noise removed, in the scan's unit; 0: none
  double memory_mb = 0;  // estimate in a plan, as built in an import
  std::vector<TissueFound> tissues;
  double solid_mm3 = 0;              // volume_of the bone; 0 in a plan
  std::vector<std::string> notices;  // the scan's and the import's own
};

struct Imported {
  std::unique_ptr<volume::Bone> bone;
  ImportSummary summary;
  std::shared_ptr<const volume::Greys> greys;  // if they are to be kept
};

// Everything decided, nothing built.
[[nodiscard]] Result<ImportSummary> plan_import(const io::Scan& scan, const ImportOptions& options);

// Every label that occurs anywhere in a label map, and what is decided about it; those taken for
// air too, with id 0. Empty for a grey scan.
[[nodiscard]] Result<std::vector<TissueFound>> labels_of(const io::Scan& scan,
                                                         const ImportOptions& options);

[[nodiscard]] Result<Imported> import_bone(const io::Scan& scan, const ImportOptions& options,
                                           Progress& progress);

}  // namespace burr::importing
