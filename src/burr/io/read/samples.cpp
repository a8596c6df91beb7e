#include "burr/io/read/samples.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace burr::io {
namespace {

// Beyond the values of any scanner; results computed from values up to this (weighted sums of a
// cubic along three axes) stay finite in a float.
constexpr float kLargestValue = 1e30F;

template <class T>
T load(const std::uint8_t* bytes, bool swap) {
  std::array<std::uint8_t, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (swap) std::reverse(raw.begin(), raw.end());
  T value;
  std::memcpy(&value, raw.data(), sizeof(T));
  return value;
}

template <class T>
void convert(const std::uint8_t* bytes, std::size_t n, const SampleFormat& format, float* out) {
  const bool swap = format.big_endian == (std::endian::native == std::endian::little);
  const bool plain = format.slope == 1 && format.intercept == 0;
  for (std::size_t i = 0; i < n; ++i) {
    const T value = load<T>(bytes + i * sizeof(T), swap);
    out[i] = plain
                 ? static_cast<float>(value)
                 : static_cast<float>(static_cast<double>(value) * format.slope + format.intercept);
  }
}

void convert(const std::uint8_t* bytes, std::size_t n, const SampleFormat& format, float* out) {
  switch (format.type) {
    case SampleType::u8:
      return convert<std::uint8_t>(bytes, n, format, out);
    case SampleType::i8:
      return convert<std::int8_t>(bytes, n, format, out);
    case SampleType::u16:
      return convert<std::uint16_t>(bytes, n, format, out);
    case SampleType::i16:
      return convert<std::int16_t>(bytes, n, format, out);
    case SampleType::u32:
      return convert<std::uint32_t>(bytes, n, format, out);
    case SampleType::i32:
      return convert<std::int32_t>(bytes, n, format, out);
    case SampleType::u64:
      return convert<std::uint64_t>(bytes, n, format, out);
    case SampleType::i64:
      return convert<std::int64_t>(bytes, n, format, out);
    case SampleType::f32:
      return convert<float>(bytes, n, format, out);
    case SampleType::f64:
      return convert<double>(bytes, n, format, out);
  }
}

// Labels are flat: few different numbers, and most voxels have the number of their neighbour. Grey
// values, even of 8 bit, change from voxel to voxel inside the body.
bool looks_like_labels(const Voxels<std::uint8_t>& bytes) {
  std::array<std::size_t, 256> count{};
  for (const std::uint8_t b : bytes) ++count[b];
  const auto different =
      std::count_if(count.begin(), count.end(), [](std::size_t n) { return n > 0; });
  if (different <= 2) return different == 2;
  if (different > 128) return false;
  std::size_t pairs = 0, same = 0;
  for (std::size_t v = 1; v < bytes.size(); ++v) {
    if (bytes[v] == 0 && bytes[v - 1] == 0) continue;
    ++pairs;
    same += bytes[v] == bytes[v - 1] ? 1 : 0;
  }
  return pairs > 200 && 10 * same > 7 * pairs;
}

}  // namespace

std::size_t bytes_of(SampleType type) {
  switch (type) {
    case SampleType::u8:
    case SampleType::i8:
      return 1;
    case SampleType::u16:
    case SampleType::i16:
      return 2;
    case SampleType::u32:
    case SampleType::i32:
    case SampleType::f32:
      return 4;
    case SampleType::u64:
    case SampleType::i64:
    case SampleType::f64:
      return 8;
  }
  return 1;
}

void VoxelSink::widen() {
  values_.reserve(count_);
  values_.assign(bytes_.begin(), bytes_.end());
  Voxels<std::uint8_t>().swap(bytes_);
  wide_ = true;
}

void VoxelSink::add(const float* values, std::size_t n) {
  if (!wide_) {
    std::size_t i = 0;
    if (bytes_.capacity() < count_) bytes_.reserve(count_);
    for (; i < n; ++i) {
      const float value = values[i];
      if (!(value >= 0 && value <= 255)) break;
      const auto byte = static_cast<std::uint8_t>(value);
      if (static_cast<float>(byte) != value) break;
      bytes_.push_back(byte);
    }
    values += i;
    n -= i;
    if (n == 0) return;
    widen();
  }
  for (std::size_t i = 0; i < n; ++i) {
    const bool good = std::abs(values[i]) <= kLargestValue;  // false for a NaN too
    broken_ += good ? 0 : 1;
    values_.push_back(good ? values[i] : std::numeric_limits<float>::quiet_NaN());
  }
}

void VoxelSink::add_bytes(const std::uint8_t* values, std::size_t n) {
  if (!wide_) {
    if (bytes_.capacity() < count_) bytes_.reserve(count_);
    bytes_.insert(bytes_.end(), values, values + n);
  } else {
    values_.insert(values_.end(), values, values + n);
  }
}

Status VoxelSink::finish(Scan& scan, bool labels_for_sure) {
  if (!wide_ && (labels_for_sure || looks_like_labels(bytes_))) {
    scan.labels = std::move(bytes_);
    scan.hounsfield = false;
    return fine();
  }
  if (labels_for_sure)
    return error(
        "a label is not a whole number from 0 to 255; burr reads at most 255 labels, renumber "
        "them");
  if (!wide_) widen();

  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float value : values_) {
    if (std::isnan(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low <= high)) return error("no voxel holds a number");

  // the other formats do not name their unit; CT is recognized by its air and its metal
  if (!scan.hounsfield && low <= -900 && low >= -3100 && high >= 300 && high <= 8000) {
    scan.hounsfield = true;
    scan.notices.push_back(fmt::format(
        "The values range from {:.0f} to {:.0f}, as in a CT: Hounsfield units are assumed.", low,
        high));
  }
  if (broken_ > 0) {
    const float air = scan.hounsfield ? -1024.0F : low;
    for (float& value : values_)
      if (std::isnan(value)) value = air;
    scan.notices.push_back(fmt::format(
        "{} voxels hold no finite number, or one beyond {:.0e}; they are now air ({:.0f}).",
        broken_, kLargestValue, air));
  }
  scan.values = std::move(values_);
  return fine();
}

Status read_samples(ByteSource& source, const SampleFormat& format, std::size_t count,
                    VoxelSink& sink, Progress& progress) {
  constexpr std::size_t kChunk = std::size_t{1} << 17;
  const std::size_t width = bytes_of(format.type);
  const bool plain_bytes =
      format.type == SampleType::u8 && format.slope == 1 && format.intercept == 0;
  std::vector<std::uint8_t> raw(std::min(count, kChunk) * width);
  std::vector<float> values(plain_bytes ? 0 : std::min(count, kChunk));
  for (std::size_t done = 0; done < count;) {
    const std::size_t n = std::min(kChunk, count - done);
    if (Status status = read_exactly(source, raw.data(), n * width); !status) return status;
    if (plain_bytes) {
      sink.add_bytes(raw.data(), n);
    } else {
      convert(raw.data(), n, format, values.data());
      sink.add(values.data(), n);
    }
    done += n;
    progress.report(static_cast<double>(done) / static_cast<double>(count), "reading");
    if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
  }
  return fine();
}

Result<std::size_t> voxel_count(std::string_view file, std::int64_t nx, std::int64_t ny,
                                std::int64_t nz) {
  if (nx < 1 || ny < 1 || nz < 1)
    return error(
        fmt::format("{}: a size of {} x {} x {} voxels is not possible; the header is wrong", file,
                    nx, ny, nz));
  constexpr std::int64_t kLongest = 32768;
  if (nx > kLongest || ny > kLongest || nz > kLongest || nx * ny > kMostVoxels / nz)
    return error(fmt::format(
        "{}: {} x {} x {} voxels are more than burr reads (2^31); crop or shrink it first", file,
        nx, ny, nz));
  return static_cast<std::size_t>(nx * ny * nz);
}

}  // namespace burr::io
