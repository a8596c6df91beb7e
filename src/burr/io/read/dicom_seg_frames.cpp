#include "burr/io/read/dicom_seg_frames.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <set>

#include "burr/io/read/bytes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using math::Vec3;

// Whether all places are whole multiples of the gap; off: the largest distance from one, in gaps.
bool even(const std::vector<double>& places, double gap, double& off) {
  constexpr double kOff = 0.1;
  off = 0;
  for (const double place : places)
    off = std::max(off, std::abs(place / gap - std::round(place / gap)));
  return off <= kOff;
}

// The distance between slices: as stated, else the smallest one between two frames, or, where they
// are few and far apart, the thickness. 0: the places fit no even stack.
double gap_of(const DicomHeader& h, const std::vector<double>& places, Scan& scan) {
  double least = places[1] - places[0], off = 0;
  for (std::size_t n = 1; n < places.size(); ++n)
    least = std::min(least, places[n] - places[n - 1]);
  int neighbours = 0;
  for (std::size_t n = 1; n < places.size(); ++n)
    neighbours += places[n] - places[n - 1] < 1.05 * least ? 1 : 0;
  const double stated = h.between_slices_mm, thick = h.frames.front().thickness_mm;
  if (stated > 0 && stated < 1.05 * least && even(places, stated, off)) return stated;
  constexpr int kFew = 3;
  if (thick > 0 && least > 1.5 * thick && neighbours < kFew && even(places, thick, off)) {
    scan.notices.push_back(fmt::format(
        "No two frames lie nearer to each other than {:.4g} mm; the slices are taken to be {:.4g} "
        "mm apart, as thick as the file states them, and empty where there is no frame.",
        least, thick));
    return thick;
  }
  if (!even(places, least, off)) return 0;
  return places.back() / std::round(places.back() / least);  // the ends say it best
}

// Checks that all frames lie in parallel planes with the same pixels.
Status alike(const DicomHeader& h, const std::string& file) {
  const DicomFrame& first = h.frames.front();
  for (const DicomFrame& frame : h.frames) {
    if (!frame.has_position)
      return error(
          fmt::format("{}: a frame states no position (Plane Position), so its place is not known; "
                      "export the segmentation again",
                      file));
    if (!frame.has_orientation)
      return error(
          fmt::format("{}: its frames state no orientation (Plane Orientation), so their place is "
                      "not known; export the segmentation again",
                      file));
    constexpr double kAlike = 1e-3;
    if ((frame.row - first.row).norm() > kAlike || (frame.column - first.column).norm() > kAlike)
      return error(fmt::format(
          "{}: its frames lie in planes of different directions, which is no volume; {}", file,
          kSegExportAgain));
    if (std::abs(frame.row_gap_mm / first.row_gap_mm - 1) > kAlike ||
        std::abs(frame.column_gap_mm / first.column_gap_mm - 1) > kAlike)
      return error(
          fmt::format("{}: its frames have pixels of different sizes; {}", file, kSegExportAgain));
  }
  return fine();
}

}  // namespace

std::uint64_t pixels_of(const DicomHeader& h) {
  return static_cast<std::uint64_t>(h.rows) * static_cast<std::uint64_t>(h.columns) *
         static_cast<std::uint64_t>(h.frame_count);
}

Result<SegStack> seg_stack_of(const DicomHeader& h, const std::string& file, Scan& scan) {
  if (Status status = alike(h, file); !status) return status.error();
  const DicomFrame& first = h.frames.front();
  const Vec3 normal = first.row.cross(first.column);
  std::vector<double> along, places;
  for (const DicomFrame& frame : h.frames) along.push_back(normal.dot(frame.position_mm));
  places = along;
  std::sort(places.begin(), places.end());
  constexpr double kSamePlace = 1e-3;  // [mm]
  places.erase(std::unique(places.begin(), places.end(),
                           [](double a, double b) { return b - a < kSamePlace; }),
               places.end());
  const double start = places.front();
  for (double& place : places) place -= start;

  SegStack stack;
  double gap = std::max(h.between_slices_mm, 0.0);
  if (places.size() > 1) {
    gap = gap_of(h, places, scan);
    if (!(gap > 0))
      return error(
          fmt::format("{}: its slices are not evenly spaced, so the shape between them is "
                      "not known; {}",
                      file, kSegExportAgain));
  } else if (gap == 0) {
    gap = first.thickness_mm;
    if (gap == 0) {
      gap = 1;
      scan.ask(Ask::spacing,
               fmt::format("{}: states no thickness of its one slice (taken for 1 mm)", file));
    }
  }
  if (!first.has_spacing)
    scan.ask(Ask::spacing, fmt::format("{}: states no Pixel Spacing (taken for 1 mm)", file));
  if (!(places.back() / gap < 32768))
    return error(
        fmt::format("{}: its frames are {:.4g} mm apart, too far for slices of {:.4g} mm; "
                    "{}",
                    file, places.back(), gap, kSegExportAgain));
  stack.slices = static_cast<int>(std::lround(places.back() / gap)) + 1;
  std::set<int> there;
  for (const double place : along) {
    stack.slice_of.push_back(static_cast<int>(std::lround((place - start) / gap)));
    there.insert(stack.slice_of.back());
  }
  stack.empty = stack.slices - static_cast<int>(there.size());

  // from the lowest frame to the highest; a stack may lean
  const auto low =
      static_cast<std::size_t>(std::min_element(along.begin(), along.end()) - along.begin());
  const auto high =
      static_cast<std::size_t>(std::max_element(along.begin(), along.end()) - along.begin());
  const Vec3 from = h.frames[low].position_mm;
  Vec3 step = normal * gap;
  if (stack.slices > 1) step = (h.frames[high].position_mm - from) / (stack.slices - 1);
  const double pixel = std::min(first.row_gap_mm, first.column_gap_mm);
  for (std::size_t f = 0; f < h.frames.size(); ++f) {
    const Vec3 off = h.frames[f].position_mm - from - step * stack.slice_of[f];
    if (std::max(std::abs(off.dot(first.row)), std::abs(off.dot(first.column))) > 0.25 * pixel)
      return error(
          fmt::format("{}: its frames are shifted against each other, as in pictures that "
                      "were cut into tiles; {}",
                      file, kSegExportAgain));
  }
  stack.affine.step.col(0) = first.row * first.column_gap_mm;
  stack.affine.step.col(1) = first.column * first.row_gap_mm;
  stack.affine.step.col(2) = step;
  stack.affine.origin = from;
  return stack;
}

Result<SegBits> read_seg_bits(const DicomHeader& h, const std::string& file, int threshold,
                              Progress& progress) {
  const auto failed = [&](const Status& status) {
    return error(status.error().trouble, fmt::format("{}: {}", file, status.error().text));
  };
  const std::uint64_t pixels = pixels_of(h);
  if (h.encapsulated && h.bits_allocated == 1) {  // frames that begin at a byte each
    const std::uint64_t slice = pixels / static_cast<std::uint64_t>(h.frame_count),
                        frame_bytes = (slice + 7) / 8;
    auto bytes = inflate_dicom_frames(h, static_cast<std::size_t>(frame_bytes));
    if (!bytes) return bytes.error();
    const SegBits frames(std::move(*bytes));
    if (slice % 8 == 0) return frames;
    SegBits bits(pixels);
    for (std::uint64_t f = 0; f < static_cast<std::uint64_t>(h.frame_count); ++f)
      frames.each(8 * f * frame_bytes, 8 * f * frame_bytes + slice,
                  [&](std::size_t n) { bits.set(f * slice + n); });
    return bits;
  }
  if (h.encapsulated) {
    auto values = read_dicom_pixels(h);
    if (!values) return values.error();
    SegBits bits(pixels);
    for (std::uint64_t n = 0; n < pixels; ++n)
      if ((*values)[n] >= threshold) bits.set(n);
    return bits;
  }
  auto source = open_dicom_pixels(h);
  if (!source) return source.error();
  if (h.bits_allocated == 1) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>((pixels + 7) / 8));
    if (Status status = read_exactly(**source, bytes.data(), bytes.size()); !status)
      return failed(status);
    return SegBits(std::move(bytes));
  }
  SegBits bits(pixels);
  std::vector<std::uint8_t> block(std::size_t{1} << 16);
  for (std::uint64_t done = 0; done < pixels;) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), pixels - done));
    if (Status status = read_exactly(**source, block.data(), n); !status) return failed(status);
    for (std::size_t i = 0; i < n; ++i)
      if (block[i] >= threshold) bits.set(done + i);
    done += n;
    progress.report(0.5 * static_cast<double>(done) / static_cast<double>(pixels), "reading");
    if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
  }
  return bits;
}

}  // namespace burr::io
