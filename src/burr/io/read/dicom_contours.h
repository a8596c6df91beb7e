// io/read/dicom_contours.h - the contours of a DICOM structure set (RTSTRUCT, PS3.3 A.19), as they are stored. Internal
// to io. contour_voxels.h makes voxels of them.
//
// Units: mm. Frame: LPS. Thread: any. Errors and names: no patient data.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/io/read/dicom_header.h"
#include "burr/io/scan.h"

namespace burr::io {

struct Contour {
  std::string type;    // CLOSED_PLANAR, POINT ...
  double slab_mm = 0;  // Contour Slab Thickness; 0: not stated
  std::vector<math::Vec3> points;
};

struct ContouredStructure {
  int number = 0;  // ROI Number
  Label label;     // name, colour, and what its code or its type says
  std::string frame_of_reference;
  std::vector<Contour> contours;
};

struct ContourSet {
  std::vector<ContouredStructure> structures;  // also those without contours
  std::vector<std::string> series;             // UIDs of the series that it refers to
};

[[nodiscard]] bool is_contour_set(const DicomHeader& header);

// Error: damaged, or a contour whose numbers are no points.
[[nodiscard]] Result<ContourSet> read_contours(const DicomHeader& header);

}  // namespace burr::io
