// io/read/label_numbers.h - whether values are labels, though they came as bytes, floats or wide numbers; and the numbers
// up to 255 that burr gives them.
//
// Thread: any; functions without state. Internal to io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/io/scan.h"
#include "burr/io/voxels.h"

namespace burr::io {

// Labels are flat: few different numbers, and most voxels have the number of their neighbour. Grey
// values, even of 8 bit, change from voxel to voxel inside the body.
[[nodiscard]] bool looks_like_labels(const Voxels<std::uint8_t>& bytes,
                                     std::ptrdiff_t most_different);

namespace label_numbers {

inline constexpr std::size_t kMostLabels = 255;
// Whole numbers that went through a float, a scale or a resampling that changed nothing else.
inline constexpr double kWhole = 1e-3;
// whole numbers are exact up to here
inline constexpr std::int64_t kLargestLabel = std::int64_t{1} << 24;

}  // namespace label_numbers

// The whole numbers that the values are, or nearly are.
struct WholeNumbers {
  std::vector<std::int64_t> all;  // sorted; one more than kMostLabels + 1 where there are too many
  double off = 0;                 // largest distance from a whole number, over its tolerance
  bool negative = false;
  bool complete = false;  // all values were looked at: none is far from a whole number
  [[nodiscard]] bool labels() const {
    return off <= 1 && !negative && all.size() <= label_numbers::kMostLabels + 1 &&
           all.back() <= label_numbers::kLargestLabel;
  }
};

[[nodiscard]] WholeNumbers whole_numbers(const Voxels<float>& values);

// Whole numbers from 0 up that are the same in nearly all neighbours, as labels are however many.
// The largest number does not count: a scan that is cut off there is flat too.
[[nodiscard]] bool flat_whole_numbers(const Voxels<float>& values);

// The numbers 1..255 that stand for the file's labels: those up to 255 keep theirs, the others get
// the lowest that are free.
[[nodiscard]] std::vector<std::uint8_t> short_numbers(const std::vector<std::int64_t>& file);

// Names of values above 255, where no voxel has such a value.
void drop_long_numbers(Scan& scan);

// Names follow their labels to the new numbers; labels without a name get an entry that knows the
// number in the file.
void renumber_names(Scan& scan, const std::vector<std::int64_t>& file,
                    const std::vector<std::uint8_t>& numbers);

}  // namespace burr::io
