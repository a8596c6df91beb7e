// io/read/read_options.h - what of a file is read, and within which limits.
#pragma once

#include <string>

#include "burr/math/vec3.h"

namespace burr::io {

struct ReadOptions {
  std::string series;                 // Series Instance UID or how it begins, or the number
                                      // shown by info ("#2"); empty: the best one
  math::Vec3 spacing_mm = {0, 0, 0};  // all > 0: overrides the file
  // Limits of the fence; 0: by how large the files are. They are far above what reading takes, so
  // only a file that lies, or a very strongly packed one, meets them.
  double seconds = 0;    // of processor time; also the longest it may stand still
  double memory_mb = 0;  // of address space
};

}  // namespace burr::io
