// io/read/read_options.h - which part of a file is read, and within which limits.
//
// Plain struct. Units in names.
#pragma once

#include <string>

#include "burr/math/vec3.h"

namespace burr::io {

struct ReadOptions {
  // Of a DICOM folder: Series Instance UID, or its beginning, or the number shown by info ("#2"), or an
  // energy ("70 keV"); empty: the best one. Of a file of several volumes: a number ("2" or "#2").
  std::string series;
  math::Vec3 spacing_mm = {0, 0, 0};  // all > 0: overrides the file
  // What the header says of its values is checked against them (calibration.h). false: as burr read
  // scans before 2026-11-26, for the recordings of that time.
  bool check_values = true;
  // Inverted values are turned, and what should be there is compared with what is there. false: as
  // burr read scans before 2026-11-29, for the recordings of that time.
  bool check_scan = true;
  // Limits of the fence; 0: chosen from the size of the files. They are far above what reading
  // needs; only a damaged or hostile file, or a very strongly compressed one, reaches them.
  double seconds = 0;    // of processor time; also the longest time without progress [s]
  double memory_mb = 0;  // of address space [MiB]
  bool study = false;    // patient and study are read too (dicom_study.h)
};

}  // namespace burr::io
