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
// (volume/bone.h).
//
// Units: mm for what people type and read, HU or the file's own unit for values; Bone is SI.
// Thread: any; uses up to two workers; the result does not depend on their number.
// Memory: the scan, twice 2 bytes a voxel while working, then the bone. See memory_budget_mb.
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

// First and last voxel of a box, both included, counted from 0 as in the file (also for slices that
// Scan::k_reversed has put in reverse order).
struct Roi {
  std::array<int, 2> i{}, j{}, k{};
};

struct ImportOptions {
  double voxel_mm = 0;  // edge of the cubic voxels [mm]; 0: the finest axis of the scan, coarser if
                        // the memory budget demands it
  double memory_budget_mb = 2048;  // for the work and the bone, if voxel_mm = 0 [MiB]
  std::optional<double> iso;       // surface level [HU or the file's unit]; none: 300 HU, or Otsu
  std::optional<Roi> roi;
  double smooth = -1;        // noise to remove, standard deviation [HU or the file's unit]; 0:
                             // none, below 0: as measured in the scan
  std::string tissue_table;  // path of a TOML file (docs/labels.md); empty: by name
  std::string materials;     // path of a TOML file (docs/materials.md); empty: built-in
  std::size_t reserve_bricks = 4096;  // room for deposited material
  bool keep_greys = false;            // keep the values of a grey scan, to show them
};

// One tissue of the result.
struct TissueFound {
  volume::TissueId id = 0;
  volume::Tissue tissue;
  std::int64_t voxels = 0;  // label maps: voxels of the file inside the region
  double volume_mm3 = 0;    // of those voxels
};

// What an import did, or would do.
struct ImportSummary {
  std::string format;
  math::Ijk scan_size = {0, 0, 0};
  math::Vec3 spacing_mm = {0, 0, 0};
  math::Mat3 axes = math::Mat3::Identity();
  math::Vec3 origin_mm = math::Vec3::Zero();
  bool labels = false, hounsfield = false;
  float low = 0, high = 0;         // lowest and highest value of a grey scan
  math::Ijk roi_from = {0, 0, 0};  // in Scan's voxels
  math::Ijk roi_size = {0, 0, 0};
  math::Ijk size = {0, 0, 0};  // voxels of the bone
  double voxel_mm = 0;
  double iso = 0;  // of grey scans
  bool iso_by_otsu = false;
  double smooth = 0;     // noise removed, in the scan's unit; 0: none
  double memory_mb = 0;  // estimate in a plan, real value in an import
  std::vector<TissueFound> tissues;
  double solid_mm3 = 0;              // volume_of the bone; 0 in a plan
  std::vector<std::string> notices;  // the scan's and the import's own
};

struct Imported {
  std::unique_ptr<volume::Bone> bone;
  ImportSummary summary;
  std::shared_ptr<const volume::Greys> greys;  // if keep_greys is set
};

// Makes all decisions of an import without building anything.
[[nodiscard]] Result<ImportSummary> plan_import(const io::Scan& scan, const ImportOptions& options);

// Every label that occurs in a label map, and the tissue it becomes; labels that become air have id
// 0. Empty for a grey scan.
[[nodiscard]] Result<std::vector<TissueFound>> labels_of(const io::Scan& scan,
                                                         const ImportOptions& options);

[[nodiscard]] Result<Imported> import_bone(const io::Scan& scan, const ImportOptions& options,
                                           Progress& progress);

}  // namespace burr::importing
