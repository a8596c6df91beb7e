// io/read/picture_scale.h - what the description of a TIFF file says of the stack: ImageJ's lines
// (https://imagej.net/ij/source/ij/io/FileSaver.java) or OME-XML (https://docs.openmicroscopy.org/ome-model).
// Internal to io. Thread: any.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "burr/io/read/tiff.h"
#include "burr/math/vec3.h"

namespace burr::io {

struct PictureScale {
  std::string by;                            // "ImageJ" or "OME"; empty: it describes nothing
  math::Vec3 voxel_mm = math::Vec3::Zero();  // 0: not stated
  // Stored numbers become slope * number + intercept.
  double slope = 1, intercept = 0;
  // Of how many channels, slices and times the pages are, and how they follow each other, the
  // fastest first ("czt").
  std::int64_t channels = 1, slices = 0, times = 1;
  std::string order = "czt";

  [[nodiscard]] std::int64_t volumes() const { return channels * times; }
  // The page of this slice in the volume with this index.
  [[nodiscard]] std::int64_t page_of(std::int64_t volume, std::int64_t slice) const;
};

[[nodiscard]] PictureScale picture_scale(const TiffWords& words);

}  // namespace burr::io
