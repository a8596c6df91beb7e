// DICOM segmentations as in PS3.3 A.51 (Segmentation IOD) and C.8.20 (Segmentation modules).
#include "burr/io/read/dicom_seg.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "burr/base/printable.h"
#include "burr/io/read/dicom_seg_frames.h"
#include "burr/io/read/geometry.h"
#include "burr/io/read/label_lists.h"
#include "burr/io/read/samples.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using math::Vec3;

constexpr const char* kBits = "1.2.840.10008.5.1.4.1.1.66.4";
constexpr const char* kLabelMap = "1.2.840.10008.5.1.4.1.1.66.7";
constexpr std::size_t kMostLabels = 255;

enum class Kind { binary, fractional, label_map, unknown };

Kind kind_of(const DicomHeader& h) {
  const std::string& type = h.segmentation_type;
  if (type == "LABELMAP" || (type.empty() && h.sop_class == kLabelMap)) return Kind::label_map;
  if (type == "FRACTIONAL") return Kind::fractional;
  if (type == "BINARY" || (type.empty() && h.bits_allocated == 1)) return Kind::binary;
  return Kind::unknown;
}

std::string segments_in_words(std::size_t count) {
  return count == 1 ? "one segment" : fmt::format("{} segments", count);
}

// ---- segments

Label label_of(const DicomSegment& segment) {
  Label label;
  label.value = segment.number;
  label.name = segment.label;
  label.colour = segment.has_colour ? srgb_of_dicom_lab(segment.lab) : volume::Tissue{}.colour;
  label.meaning = meaning_of_code(segment.scheme, segment.code, segment.meaning);
  return label;
}

// The names of the file, one for each number.
std::vector<Label> names_of(const DicomHeader& h, Scan& scan) {
  std::vector<Label> out;
  std::set<int> seen;
  for (const DicomSegment& segment : h.segments) {
    if (segment.number < 1) continue;
    if (seen.insert(segment.number).second)
      out.push_back(label_of(segment));
    else
      scan.notices.push_back(
          fmt::format("Two segments have the number {}: the first name is taken.", segment.number));
  }
  return out;
}

// Segment numbers in the file as labels up to 255, with a notice where they differ.
std::map<int, std::uint8_t> short_numbers(const std::set<int>& file, Scan& scan) {
  std::map<int, std::uint8_t> out;
  std::set<int> taken;
  for (const int number : file)
    if (number <= static_cast<int>(kMostLabels)) taken.insert(number);
  int free = 1, changed = 0;
  for (const int number : file) {
    if (number <= static_cast<int>(kMostLabels)) {
      out[number] = static_cast<std::uint8_t>(number);
      continue;
    }
    while (taken.count(free) != 0) ++free;
    taken.insert(free);
    out[number] = static_cast<std::uint8_t>(free);
    ++changed;
  }
  if (changed > 0)
    scan.notices.push_back(
        fmt::format("burr numbers labels up to 255, so {} of the file has a new number.",
                    changed == 1 ? "one segment" : fmt::format("each of {} segments", changed)));
  return out;
}

// Which segment each frame shows.
Result<std::vector<int>> segments_of_frames(const DicomHeader& h, const std::string& file,
                                            Scan& scan) {
  std::vector<int> out;
  std::size_t silent = 0;
  for (const DicomFrame& frame : h.frames) {
    out.push_back(frame.segment);
    silent += frame.segment < 1 ? 1 : 0;
  }
  if (silent == 0) return out;
  if (silent < out.size())
    return error(
        fmt::format("{}: {} of its {} frames do not say which segment they show "
                    "(Referenced Segment Number); export the segmentation again",
                    file, silent, out.size()));
  if (h.segments.size() > 1)
    return error(
        fmt::format("{}: holds {} segments, but its frames do not say which of them they "
                    "show (Referenced Segment Number); export the segmentation again",
                    file, h.segments.size()));
  const int only =
      h.segments.empty() || h.segments.front().number < 1 ? 1 : h.segments.front().number;
  std::fill(out.begin(), out.end(), only);
  scan.notices.emplace_back(
      "The frames do not say which segment they show: all are taken for one segment.");
  return out;
}

// What the segments of the file leave to be said, and the names of those that have frames.
void take_names(const DicomHeader& h, const std::map<int, std::uint8_t>& numbers, Scan& scan) {
  std::string without, unnamed;
  std::set<int> named;
  for (Label& label : names_of(h, scan)) {
    const auto found = numbers.find(label.value);
    named.insert(label.value);
    if (found == numbers.end()) {
      without += fmt::format("{}{} ({})", without.empty() ? "" : ", ", label.value,
                             base::printable(label.name));
      continue;
    }
    if (label.value != found->second) label.in_file = label.value;
    label.value = found->second;
    scan.label_names.push_back(std::move(label));
  }
  for (const auto& [file, number] : numbers) {
    if (named.count(file) != 0) continue;
    if (!h.segments.empty()) unnamed += fmt::format("{}{}", unnamed.empty() ? "" : ", ", file);
    if (file == number) continue;
    Label label{.value = number, .name = "", .colour = volume::Tissue{}.colour};
    label.in_file = file;
    scan.label_names.push_back(std::move(label));
  }
  constexpr std::size_t kLongest = 300;
  if (!without.empty())
    scan.notices.push_back(fmt::format("No frame shows these segments, so they are empty: {}.",
                                       without.substr(0, kLongest)));
  if (!unnamed.empty())
    scan.notices.push_back(
        fmt::format("The file has frames of segments that it does not describe; they have no name: "
                    "{}.",
                    unnamed.substr(0, kLongest)));
}

// Paints the segments into the labels, the large ones first, so that the smaller one stays.
class Painter {
 public:
  Painter(const DicomHeader& h, const SegStack& stack, const SegBits& bits,
          std::vector<int> segments)
      : stack_(stack),
        bits_(bits),
        segments_(std::move(segments)),
        slice_(static_cast<std::uint64_t>(h.rows) * static_cast<std::uint64_t>(h.columns)) {
    for (std::size_t f = 0; f < segments_.size(); ++f) frames_[segments_[f]].push_back(f);
  }

  // Returns in how many voxels segments overlap. numbers: label of each segment.
  Result<std::size_t> paint(const std::map<int, std::uint8_t>& numbers, Scan& scan,
                            Progress& progress) {
    std::vector<std::pair<std::size_t, int>> order;  // voxels, segment
    for (const auto& [segment, frames] : frames_) {
      std::size_t count = 0;
      for (const std::size_t f : frames) each(f, [&](std::size_t) { ++count; });
      order.emplace_back(count, segment);
    }
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    SegBits shared(scan.labels.size());
    std::size_t overlap = 0, done = 0;
    for (const auto& [count, segment] : order) {
      const std::uint8_t number = numbers.at(segment);
      for (const std::size_t f : frames_.at(segment)) {
        const std::uint64_t start = static_cast<std::uint64_t>(stack_.slice_of[f]) * slice_;
        each(f, [&](std::size_t pixel) {
          const std::size_t voxel = static_cast<std::size_t>(start) + pixel;
          std::uint8_t& label = scan.labels[voxel];
          if (label != 0 && label != number && !shared.at(voxel)) {
            shared.set(voxel);
            ++overlap;
          }
          label = number;
        });
        if (++done % 64 == 0) {
          progress.report(
              0.5 + 0.5 * static_cast<double>(done) / static_cast<double>(segments_.size()),
              "reading");
          if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
        }
      }
    }
    return overlap;
  }

 private:
  template <class F>
  void each(std::size_t frame, F&& f) const {
    bits_.each(frame * slice_, (frame + 1) * slice_, f);
  }

  const SegStack& stack_;
  const SegBits& bits_;
  std::vector<int> segments_;
  std::uint64_t slice_;
  std::map<int, std::vector<std::size_t>> frames_;
};

Status read_binary(const DicomHeader& h, const SegStack& stack, const std::string& file, Scan& scan,
                   Progress& progress) {
  auto segments = segments_of_frames(h, file, scan);
  if (!segments) return segments.error();
  const std::set<int> there(segments->begin(), segments->end());
  if (there.size() > kMostLabels)
    return error(
        fmt::format("{}: its frames show {} segments, and burr reads at most 255; leave some of "
                    "them out and export again",
                    file, there.size()));
  int threshold = 1;
  if (kind_of(h) == Kind::fractional) {
    const int most = h.most_fractional > 0 ? h.most_fractional : 255;
    threshold = (most + 1) / 2;
    scan.notices.push_back(fmt::format(
        "The segmentation states a fraction for each voxel (FRACTIONAL): voxels of half "
        "or more ({} of {}{}) are inside, all others outside.",
        threshold, most,
        h.most_fractional > 0 ? "" : ", the file states no Maximum Fractional Value"));
  }
  const auto numbers = short_numbers(there, scan);
  auto bits = read_seg_bits(h, file, threshold, progress);
  if (!bits) return bits.error();
  take_names(h, numbers, scan);
  scan.labels.assign(static_cast<std::size_t>(scan.size.x()) *
                         static_cast<std::size_t>(scan.size.y()) *
                         static_cast<std::size_t>(scan.size.z()),
                     0);
  auto overlap = Painter(h, stack, *bits, std::move(*segments)).paint(numbers, scan, progress);
  if (!overlap) return overlap.error();
  if (*overlap > 0)
    scan.notices.push_back(
        fmt::format("Segments overlap in {} voxels: there the smaller one stays.", *overlap));
  return fine();
}

// The frames of a label map, in the order of the slices.
Status read_label_map(const DicomHeader& h, const SegStack& stack, const std::string& file,
                      Scan& scan, Progress& progress) {
  std::vector<int> frame_of(static_cast<std::size_t>(stack.slices), -1);
  for (std::size_t f = 0; f < stack.slice_of.size(); ++f) {
    int& frame = frame_of[static_cast<std::size_t>(stack.slice_of[f])];
    if (frame >= 0)
      return error(
          fmt::format("{}: two of its frames lie at the same place, and a label map has "
                      "only one for each slice; export the segmentation again",
                      file));
    frame = static_cast<int>(f);
  }
  auto values = read_dicom_pixels(h);
  if (!values) return values.error();
  const std::size_t slice = static_cast<std::size_t>(h.rows) * static_cast<std::size_t>(h.columns);
  const auto background = static_cast<std::int32_t>(h.has_padding ? h.padding : 0);
  const bool moved = background != 0;
  if (moved)
    scan.notices.push_back(
        fmt::format("The value {} is the background (Pixel Padding Value).", background));
  VoxelSink sink(slice * frame_of.size());
  std::vector<float> row(slice);
  for (std::size_t k = 0; k < frame_of.size(); ++k) {
    std::fill(row.begin(), row.end(), 0.0F);
    if (frame_of[k] >= 0) {
      const std::int32_t* from = values->data() + static_cast<std::size_t>(frame_of[k]) * slice;
      for (std::size_t n = 0; n < slice; ++n)
        row[n] = from[n] == background ? 0.0F : static_cast<float>(from[n]);
    }
    sink.add(row.data(), slice);
    progress.report(static_cast<double>(k + 1) / static_cast<double>(frame_of.size()), "reading");
    if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
  }
  for (Label& label : names_of(h, scan))
    if (label.value != background) scan.label_names.push_back(std::move(label));
  if (Status status = sink.finish(scan, true); !status)
    return error(fmt::format("{}: {}", file, status.error().text));
  return fine();
}

}  // namespace

bool is_segmentation(const DicomHeader& h) {
  return h.sop_class == kBits || h.sop_class == kLabelMap ||
         (h.bits_allocated == 1 && h.modality == "SEG");
}

std::string no_segmentation(const DicomHeader& h) {
  if (!h.damage.empty()) return fmt::format("is a damaged DICOM file: {}; copy it again", h.damage);
  if (!h.has_pixels)
    return "is a DICOM segmentation without pixels; it may be cut off, copy it again";
  if (h.rows < 1 || h.columns < 1 || h.samples != 1)
    return fmt::format(
        "is a DICOM segmentation whose size is not valid ({} x {} pixels of {} "
        "values); export it again",
        h.columns, h.rows, h.samples);
  const Kind kind = kind_of(h);
  const int bits = h.bits_allocated;
  if (kind == Kind::unknown)
    return fmt::format("is a DICOM segmentation of the type \"{}\", which burr does not read; {}",
                       base::printable(h.segmentation_type, 20), kSegExportAgain);
  const bool good = kind == Kind::binary       ? bits == 1 || bits == 8
                    : kind == Kind::fractional ? bits == 8
                                               : bits == 8 || bits == 16;
  if (!good)
    return fmt::format(
        "is a DICOM segmentation with {} bits a pixel, which does not fit its type; "
        "export it again",
        bits);
  if (bits > 1 && (h.bits_stored < 1 || h.bits_stored > bits || h.high_bit >= bits ||
                   h.high_bit < h.bits_stored - 1))
    return fmt::format(
        "is a DICOM segmentation whose Bits Stored ({}) or High Bit does not fit; "
        "export it again",
        h.bits_stored);
  const bool frames = h.transfer_syntax == kDeflatedFrames;
  if (bits == 1 && ((h.encapsulated && !frames) || h.big_endian))
    return fmt::format(
        "is a DICOM segmentation of single bits that are {}, which burr does not "
        "read; {}",
        h.encapsulated ? "compressed" : "stored big end first", kSegExportAgain);
  if (h.float_pixels)
    return fmt::format(
        "is a DICOM segmentation of floating-point pixels, which burr does not read; "
        "{}",
        kSegExportAgain);
  const std::uint64_t pixels = pixels_of(h), bytes = (pixels * static_cast<unsigned>(bits) + 7) / 8;
  if (!h.encapsulated && bytes > h.pixels_length)
    return fmt::format(
        "Pixel Data has {} bytes, but {} frames of {} x {} pixels need {}; the file "
        "is cut off, copy it again",
        h.pixels_length, h.frame_count, h.columns, h.rows, bytes);
  // runs of equal bytes pack at most 64 : 1 in RLE; the other codecs reach more
  if (h.encapsulated && (bytes > h.pixels_length * 20000 || bytes > (std::uint64_t{1} << 33)))
    return fmt::format("{} bytes of compressed pixels cannot hold {} pixels; copy it again",
                       h.pixels_length, pixels);
  if (h.other_frame_of_reference)
    return fmt::format(
        "is a DICOM segmentation with two frames of reference, so its parts do not "
        "lie in one space; export them as two files");
  return {};
}

std::string one_line(const DicomHeader& h, std::size_t place) {
  return fmt::format("#{}: segmentation (SEG), {} frames {} x {}, {}", place + 1, h.frame_count,
                     h.columns, h.rows,
                     h.segments.empty() ? std::string("segments not described")
                                        : segments_in_words(h.segments.size()));
}

Status read_segmentation(const DicomHeader& h, const ReadOptions& options, const std::string& file,
                         Scan& scan, Progress& progress) {
  scan.format = "DICOM segmentation";
  if (h.decimal_commas)
    scan.notices.emplace_back(
        "The file writes numbers with a decimal comma (\"0,5\"): read as decimal points.");
  auto stack = seg_stack_of(h, file, scan);
  if (!stack) return stack.error();
  if (auto count = voxel_count(file, h.columns, h.rows, stack->slices); !count)
    return count.error();
  scan.size = {h.columns, h.rows, stack->slices};
  if (stack->empty > 0)
    scan.notices.push_back(fmt::format("The file has no frame for {} of {} slices: they are empty.",
                                       stack->empty, stack->slices));
  Status status = kind_of(h) == Kind::label_map ? read_label_map(h, *stack, file, scan, progress)
                                                : read_binary(h, *stack, file, scan, progress);
  if (!status) return status;
  return place(scan, stack->affine, options.spacing_mm, file, progress);
}

std::array<float, 3> srgb_of_dicom_lab(const std::array<int, 3>& lab) {
  // the curve of CIELab and its inverse share these constants
  constexpr double kDelta = 6.0 / 29.0, kSteps = 65535.0;
  const double lightness = lab[0] / kSteps * 100, a = lab[1] / kSteps * 255 - 128,
               b = lab[2] / kSteps * 255 - 128;
  const double y = (lightness + 16) / 116;
  const auto inverse = [](double t) {
    return t > kDelta ? t * t * t : 3 * kDelta * kDelta * (t - 4.0 / 29.0);
  };
  const Vec3 xyz(0.96422 * inverse(y + a / 500), inverse(y), 0.82521 * inverse(y - b / 200));
  math::Mat3 linear;  // XYZ of D50 to linear sRGB, adapted by Bradford
  linear << 3.1338561, -1.6168667, -0.4906146, -0.9787684, 1.9161415, 0.0334540, 0.0719453,
      -0.2289914, 1.4052427;
  const Vec3 rgb = linear * xyz;
  std::array<float, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double v = std::clamp(rgb[static_cast<Eigen::Index>(c)], 0.0, 1.0);
    out[c] = static_cast<float>(v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
  }
  return out;
}

}  // namespace burr::io
