// io/read/samples.h - turns the bytes of a file into voxels of a scan, for every number type.
//
// Small whole numbers (0..255) stay bytes as long as there is nothing else, so that a label map of
// 512^3 takes 128 MiB and not 512. The first other value turns all of them into floats. Internal to
// io.
// Thread: one per sink. Errors: one sentence.
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

// The number type and its scale.
struct SampleFormat {
  SampleType type = SampleType::i16;
  bool big_endian = false;
  double slope = 1, intercept = 0;
};

// Takes voxels in order and stores them in the smallest type that fits.
class VoxelSink {
 public:
  explicit VoxelSink(std::size_t count) : count_(count) {}

  void add(const float* values, std::size_t n);
  void add_bytes(const std::uint8_t* values, std::size_t n);
  // Whether the values are whole numbers from 0 up and each above 0 is the value of one of these.
  [[nodiscard]] bool all_are_among(const std::vector<Label>& labels) const;
  // Moves the voxels into the scan: as values, or as labels if the numbers look like labels or
  // `labels_for_sure` is set. Values are calibrated (calibration.h), unless check_values is false:
  // then by the rules of before 2026-11-26. Labels above 255 get numbers up to 255, in scan.label_names too, and
  // whole numbers within 0.001 are rounded; both with a notice. Values that are not finite or beyond
  // 1e30 become air, with a notice.
  [[nodiscard]] Status finish(Scan& scan, bool labels_for_sure, bool check_values = true);

  // The same for a segmentation whose segments lie in `layers` layers; layer_of_name: the layer of
  // each of scan.label_names. Where segments overlap, the one with fewer voxels stays, of two equal
  // ones the later; a notice states in how many voxels.
  [[nodiscard]] Status finish_layers(Scan& scan, std::size_t layers, bool layers_first,
                                     const std::vector<int>& layer_of_name);

 private:
  void widen();
  [[nodiscard]] Status finish_unchecked(Scan& scan);
  [[nodiscard]] Result<bool> wide_labels(Scan& scan, bool labels_for_sure);

  std::size_t count_;
  Voxels<std::uint8_t> bytes_;
  Voxels<float> values_;
  bool wide_ = false;
  std::size_t broken_ = 0;  // values that are not finite, or beyond any scanner's range
};

// Reads `count` samples into the sink.
[[nodiscard]] Status read_samples(ByteSource& source, const SampleFormat& format, std::size_t count,
                                  VoxelSink& sink, Progress& progress);

// Largest number of voxels that is read; more is refused, and the error suggests --roi.
inline constexpr std::int64_t kMostVoxels = std::int64_t{1} << 31;

// The product of the sizes. Error: a size below 1, or a product above kMostVoxels.
[[nodiscard]] Result<std::size_t> voxel_count(std::string_view file, std::int64_t nx,
                                              std::int64_t ny, std::int64_t nz);

}  // namespace burr::io
