// io/read/nrrd_shape.h - what the axes of an NRRD file are: three of space, and perhaps one of segments or
// of volumes. Internal to io. Thread: any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/io/read/nrrd_header.h"
#include "burr/io/read/samples.h"

namespace burr::io {

struct NrrdShape {
  std::vector<std::int64_t> sizes;  // of the three axes kept
  std::vector<std::size_t> axes;    // which of the file's axes they are
  std::int64_t layers = 1;          // of a segmentation
  bool layers_first = false;        // the layers of a voxel follow each other in the file
  std::int64_t volumes = 1;         // times, directions or channels
  std::int64_t before_volumes = 1;  // product of the sizes of the axes before theirs
};

// Error: the axes are not those of a volume.
[[nodiscard]] Result<NrrdShape> nrrd_shape(const NrrdHeader& header, const std::string& file,
                                           bool segmentation);

// One "(x,y,z)" or "none" for each axis that the field "space directions" names.
[[nodiscard]] std::vector<std::string> nrrd_directions(const NrrdHeader& header);

// The number type of that name; false: burr does not read it.
[[nodiscard]] bool nrrd_type(const std::string& name, SampleType& type);

}  // namespace burr::io
