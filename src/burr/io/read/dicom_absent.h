// io/read/dicom_absent.h - files that something says should be there: a DICOMDIR, the parts of a
// concatenation, and the numbers in the headers (Images in Acquisition, Number of Series Related
// Instances, Number of Frames). What they say is compared with what lies there. Internal to io.
//
// Thread: any. Names: no patient data.
#pragma once

#include <cstddef>
#include <string>

#include "burr/io/read/dicom_series.h"
#include "burr/io/scan.h"

namespace burr::io {

struct Looked {
  std::size_t unread = 0;  // files of the series that are there and cannot be read
  bool folder = true;      // false: one file was given, so the others need not be there
};

// Asks where files of the volume's series are absent. Only the surest of the statements is passed
// on, because they all speak of the same files.
void say_absent(const Found& found, const Series& series, const Volume& volume,
                const Looked& looked, const std::string& file, Scan& scan);

}  // namespace burr::io
