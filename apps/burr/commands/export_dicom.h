// apps/burr/commands/export_dicom.h - what `burr export` needs for a DICOM segmentation: whose scan was segmented, what the
// structures are, and who drew them.
//
// Thread: main.
#pragma once

#include <optional>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/scan.h"
#include "burr/io/write/write_dicom_seg.h"
#include "burr/scenario/recipe.h"
#include "burr/volume/grid.h"

namespace CLI {
class App;
}

namespace burr::app {

struct DicomOptions {
  std::string study_of, uid_root, by, algorithm, kind;
  bool no_patient = false;
  [[nodiscard]] bool any() const {
    return no_patient || !(study_of + uid_root + by + algorithm + kind).empty();
  }
};
void add_dicom_options(CLI::App& command, DicomOptions& options);

[[nodiscard]] bool is_dicom_path(const std::string& path);

// source: the scan that the labels were made from, if it was read with ReadOptions::study; may be nullptr. labels: the
// segments to be, for their codes and their place.
[[nodiscard]] Result<io::SegOptions> seg_options(const DicomOptions& options,
                                                 const scenario::BoneRecipe& recipe,
                                                 const io::Scan* source, const io::Scan& labels,
                                                 Progress& progress);

// The labels of a scan as they are, with the names of the table, if the recipe has one.
[[nodiscard]] Result<io::Scan> own_labels(io::Scan scan, const scenario::BoneRecipe& recipe);

// Prints what was written. voxel_mm3: of the labels.
void tell_segments(const std::string& out, const std::vector<io::SegSegment>& segments,
                   const std::vector<std::string>& notices, double voxel_mm3, const char* part,
                   bool json);

}  // namespace burr::app
