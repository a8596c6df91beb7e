// io/read/samples.h - bytes of a file become voxels of a scan, whatever number type they have.
//
// Small whole numbers (0..255) stay bytes as long as there is nothing else, so that a label map of
// 512^3 takes 128 MiB and not 512; the first other value turns all into floats. Private to io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/bytes.h"
#include "burr/io/scan.h"

namespace burr::io {

enum class SampleType { u8, i8, u16, i16, u32, i32, u64, i64, f32, f64 };
[[nodiscard]] std::size_t bytes_of(SampleType type);

// What the bytes mean.
struct SampleFormat {
  SampleType type = SampleType::i16;
  bool big_endian = false;
  double slope = 1, intercept = 0;
};

// Takes voxels in order and keeps them as small as they are.
class VoxelSink {
 public:
  explicit VoxelSink(std::size_t count) : count_(count) {}

  void add(const float* values, std::size_t n);
  void add_bytes(const std::uint8_t* values, std::size_t n);
  // Into the scan: values, or labels where the numbers look like labels (or `labels_for_sure`).
  // Not-a-number, infinity and what is beyond 1e30 become air, with a notice.
  [[nodiscard]] Status finish(Scan& scan, bool labels_for_sure);

 private:
  void widen();

  std::size_t count_;
  Voxels<std::uint8_t> bytes_;
  Voxels<float> values_;
  bool wide_ = false;
  std::size_t broken_ = 0;  // not a number, infinite, or beyond any scanner's number
};

// Reads `count` samples into the sink.
[[nodiscard]] Status read_samples(ByteSource& source, const SampleFormat& format, std::size_t count,
                                  VoxelSink& sink, Progress& progress);

// Largest number of voxels that is read at all; more is refused with a sentence that names --roi's
// limits.
inline constexpr std::int64_t kMostVoxels = std::int64_t{1} << 31;

// Product of the sizes, or an error: none may be below 1, all together at most kMostVoxels.
[[nodiscard]] Result<std::size_t> voxel_count(std::string_view file, std::int64_t nx,
                                              std::int64_t ny, std::int64_t nz);

}  // namespace burr::io
