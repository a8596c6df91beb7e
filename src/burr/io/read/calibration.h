// io/read/calibration.h - whether the values of a scan are Hounsfield units, and which voxels were
// never measured. One rule for DICOM, NIfTI, NRRD and MetaImage: what a header says is believed only
// as far as the numbers bear it out. Internal to io.
//
// Hounsfield units are: what the header calls so, unless the numbers contradict (bulk beyond what a
// body holds; air and soft tissue 1000 apart but shifted; a picture of 8 bit); and what no header
// names, if there is air near -1000, or soft tissue near 40 beside voxels that were never measured.
// Units: those of the file. Thread: any.
#pragma once

#include <cstddef>
#include <string>

#include "burr/base/result.h"
#include "burr/io/scan.h"

namespace burr::io {

// What the header says.
struct Claim {
  bool hounsfield = false;        // the values are HU
  bool can_be_hounsfield = true;  // false: another kind of picture (MR), or a table was not applied
  bool clip_below_air = false;    // HU below -1024 become -1024, as DICOM has always been read here
  std::size_t padded = 0;         // voxels that the header calls padding; NaN in the scan
  std::size_t broken = 0;         // values that are not finite; NaN in the scan
  // Stored values are whole numbers of a type that holds `period` of them; 0: not known.
  double period = 0, slope = 1, intercept = 0;
};

// Judges scan.values, in which voxels that were not measured are NaN. Sets scan.hounsfield and
// scan.outside, mends numbers whose sign was mixed up, gives voxels without a measurement a value,
// and says all this in notices. Error: no voxel holds a number.
[[nodiscard]] Status calibrate(Scan& scan, const Claim& claim);

}  // namespace burr::io
