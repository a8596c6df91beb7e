// io/read/dicom_seg_frames.h - the frames of a DICOM segmentation: where each lies, and its pixels as
// bits. Internal to io. Units: mm. Frame: LPS. Thread: any. Errors: no patient data.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/dicom_header.h"
#include "burr/io/read/geometry.h"
#include "burr/io/scan.h"

namespace burr::io {

// What helps where burr does not read a segmentation; the end of a sentence.
inline constexpr const char* kSegExportAgain = "convert it to .seg.nrrd in 3D Slicer";

[[nodiscard]] std::uint64_t pixels_of(const DicomHeader& segmentation);

// The grid in which each frame is one slice.
struct SegStack {
  Affine affine;
  int slices = 1;
  std::vector<int> slice_of;  // (frames)
  int empty = 0;              // slices without a frame
};

// Error: the frames lie in no even stack. What is assumed becomes a notice or a question of the scan.
[[nodiscard]] Result<SegStack> seg_stack_of(const DicomHeader& h, const std::string& file,
                                            Scan& scan);

// One bit for each pixel of all frames, one after another, as BINARY stores them.
class SegBits {
 public:
  SegBits() = default;
  explicit SegBits(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}
  explicit SegBits(std::uint64_t count) : bytes_(static_cast<std::size_t>((count + 7) / 8)) {}

  void set(std::uint64_t at) { bytes_[at >> 3] |= static_cast<std::uint8_t>(1U << (at & 7)); }
  [[nodiscard]] bool at(std::uint64_t n) const { return (bytes_[n >> 3] >> (n & 7) & 1) != 0; }
  // Calls f(n - from) for each bit that is set, in order.
  template <class F>
  void each(std::uint64_t from, std::uint64_t to, F&& f) const {
    for (std::uint64_t n = from; n < to;) {
      if ((n & 7) == 0 && bytes_[n >> 3] == 0) {
        n += 8;
        continue;
      }
      if (at(n)) f(static_cast<std::size_t>(n - from));
      ++n;
    }
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

// threshold: the least value of a pixel of FRACTIONAL that counts as inside.
[[nodiscard]] Result<SegBits> read_seg_bits(const DicomHeader& h, const std::string& file,
                                            int threshold, Progress& progress);

}  // namespace burr::io
