#include "burr/io/read/samples.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "burr/io/read/calibration.h"
#include "burr/io/read/label_numbers.h"

namespace burr::io {
namespace {

using label_numbers::kLargestLabel;
using label_numbers::kMostLabels;
using label_numbers::kWhole;

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

bool VoxelSink::all_are_among(const std::vector<Label>& labels) const {
  std::vector<std::int64_t> there;
  if (wide_) {
    const WholeNumbers whole = broken_ == 0 ? whole_numbers(values_) : WholeNumbers{};
    if (whole.all.empty() || !whole.labels()) return false;
    there = whole.all;
  } else {
    std::array<bool, 256> present{};
    for (const std::uint8_t b : bytes_) present[b] = true;
    for (std::size_t v = 0; v < present.size(); ++v)
      if (present[v]) there.push_back(static_cast<std::int64_t>(v));
  }
  return std::all_of(there.begin(), there.end(), [&](std::int64_t value) {
    return value == 0 || std::any_of(labels.begin(), labels.end(),
                                     [&](const Label& one) { return one.value == value; });
  });
}

// Wide values that are labels all the same: above 255, or floats beside whole numbers.
Result<bool> VoxelSink::wide_labels(Scan& scan, bool labels_for_sure) {
  const WholeNumbers whole = broken_ == 0 ? whole_numbers(values_) : WholeNumbers{};
  if (labels_for_sure) {
    if (broken_ > 0 || whole.off > 1 || whole.negative)
      return error("a label is not a whole number from 0 up; save the labels as whole numbers");
    if (whole.all.size() > kMostLabels + 1)
      return error(
          "there are more than 255 different labels, and burr reads at most 255; merge "
          "some of them");
    if (!whole.labels())
      return error(
          fmt::format("a label is above {}; give the labels smaller numbers", kLargestLabel));
  }
  if (whole.all.size() > kMostLabels + 1 && broken_ == 0 && flat_whole_numbers(values_))
    return error(
        "the values look like more than 255 different labels, and burr reads at most 255; "
        "merge some of them");
  if (!whole.complete || whole.all.empty() || whole.negative || whole.all.size() > kMostLabels + 1)
    return false;
  if (!labels_for_sure && (whole.all.size() < 2 || whole.all.front() != 0)) return false;
  const std::vector<std::uint8_t> numbers = short_numbers(whole.all);
  Voxels<std::uint8_t> bytes;
  bytes.reserve(values_.size());
  for (const float value : values_) {
    const auto number = static_cast<std::int64_t>(std::round(double{value}));
    const auto place = std::lower_bound(whole.all.begin(), whole.all.end(), number);
    if (place == whole.all.end()) return false;  // values_ ended early
    bytes.push_back(numbers[static_cast<std::size_t>(place - whole.all.begin())]);
  }
  if (!labels_for_sure && !looks_like_labels(bytes, 256)) return false;
  if (!whole.labels()) {
    scan.notices.push_back(fmt::format(
        "The values are few and near to whole numbers (off by up to {:.2g}), as in a label map "
        "that was scaled, but they are read as grey values; if they are labels, round them to "
        "whole "
        "numbers and save the file again.",
        whole.off * kWhole));
    return false;
  }
  if (whole.off > 0)
    scan.notices.emplace_back(
        "The values are whole numbers to within 0.001: they are rounded and read as labels.");
  renumber_names(scan, whole.all, numbers);
  drop_long_numbers(scan);
  scan.labels = std::move(bytes);
  Voxels<float>().swap(values_);
  scan.hounsfield = false;
  return true;
}

Status VoxelSink::finish(Scan& scan, bool labels_for_sure, bool check_values) {
  if (wide_ && (labels_for_sure || !scan.hounsfield)) {
    const auto labels = wide_labels(scan, labels_for_sure);
    if (!labels) return labels.error();
    if (*labels) return fine();
  }
  drop_long_numbers(scan);
  if (!wide_ && (labels_for_sure || looks_like_labels(bytes_, 128))) {
    scan.labels = std::move(bytes_);
    scan.hounsfield = false;
    return fine();
  }
  if (!wide_) widen();
  if (!check_values) return finish_unchecked(scan);
  scan.values = std::move(values_);
  Claim claim;
  claim.broken = broken_;
  claim.period = 65536;
  return calibrate(scan, claim);
}

// As before 2026-11-26.
Status VoxelSink::finish_unchecked(Scan& scan) {
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

Status VoxelSink::finish_layers(Scan& scan, std::size_t layers, bool layers_first,
                                const std::vector<int>& layer_of_name) {
  const std::size_t voxels = count_ / layers;
  struct Segment {
    std::size_t layer = 0, count = 0;
    std::int64_t value = 0;
    std::uint8_t number = 0;
  };
  std::vector<Segment> all;  // few, so they are searched one after the other
  const auto value_at = [&](std::size_t voxel, std::size_t layer) {
    const std::size_t at = layers_first ? voxel * layers + layer : layer * voxels + voxel;
    return wide_ ? double{values_[at]} : static_cast<double>(bytes_[at]);
  };
  // the last one found is mostly the next one too
  std::vector<std::size_t> before(layers, 0);
  const auto find = [&](std::size_t layer, std::int64_t value) -> Segment& {
    std::size_t& at = before[layer];
    if (at < all.size() && all[at].layer == layer && all[at].value == value) return all[at];
    for (at = 0; at < all.size(); ++at)
      if (all[at].layer == layer && all[at].value == value) return all[at];
    return all.emplace_back(Segment{layer, 0, value, 0});
  };
  for (std::size_t voxel = 0; voxel < voxels; ++voxel)
    for (std::size_t layer = 0; layer < layers; ++layer) {
      const double value = value_at(voxel, layer);
      if (value == 0) continue;
      if (!(value > 0 && value <= static_cast<double>(kLargestLabel)) ||
          std::abs(value - std::round(value)) > kWhole)
        return error("a label is not a whole number from 0 up; save the labels as whole numbers");
      ++find(layer, static_cast<std::int64_t>(std::round(value))).count;
      if (all.size() > kMostLabels)
        return error(
            "there are more than 255 different labels, and burr reads at most 255; merge "
            "some of them");
    }
  std::sort(all.begin(), all.end(), [](const Segment& a, const Segment& b) {
    return a.layer != b.layer ? a.layer < b.layer : a.value < b.value;
  });
  std::vector<Label> names;
  for (std::size_t n = 0; n < all.size(); ++n) {
    all[n].number = static_cast<std::uint8_t>(n + 1);
    Label name{.value = static_cast<int>(n + 1), .name = "", .colour = volume::Tissue{}.colour};
    for (std::size_t l = 0; l < scan.label_names.size() && l < layer_of_name.size(); ++l)
      if (scan.label_names[l].value == all[n].value &&
          layer_of_name[l] == static_cast<int>(all[n].layer))
        name = scan.label_names[l];
    name.value = static_cast<int>(n + 1);
    names.push_back(std::move(name));
  }
  std::size_t shared = 0;
  scan.labels.assign(voxels, 0);
  for (std::size_t voxel = 0; voxel < voxels; ++voxel) {
    std::size_t best = 0, there = 0;
    for (std::size_t layer = 0; layer < layers; ++layer) {
      const double value = value_at(voxel, layer);
      if (value == 0) continue;
      const Segment& one = find(layer, static_cast<std::int64_t>(std::round(value)));
      if (++there > 1 && one.count > best) continue;
      best = one.count;
      scan.labels[voxel] = one.number;
    }
    shared += there > 1 ? 1 : 0;
  }
  scan.label_names = std::move(names);
  scan.hounsfield = false;
  scan.notices.push_back(fmt::format(
      "The segments lie in {} layers: they are numbered 1 to {} here. Where they overlap, in {} "
      "voxels, the smaller one stays.",
      layers, all.size(), shared));
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
