#include "burr/io/read/dicom_stack.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "burr/io/read/geometry.h"

namespace burr::io {
namespace {

using math::Vec3;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Every second slice, or every third, is missing: the file states a distance of the slices of which
// the real one is a multiple, or the slices are thin and their numbers leave out as many. 0: no.
int stated_multiple(const Series& series, const std::vector<Slice>& slices, double gap) {
  const DicomHeader& first = series.files[slices.front().file];
  const auto multiple_of = [&](double of) {
    const double times = of > 0 ? gap / of : 0;
    const double whole = std::round(times);
    return whole >= 2 && whole <= 16 && std::abs(times - whole) < 0.02 * whole
               ? static_cast<int>(whole)
               : 0;
  };
  if (const int times = multiple_of(first.between_slices_mm); times > 0) return times;
  const int times = multiple_of(frame_of(series, slices.front()).thickness_mm);
  if (times == 0 || first.frame_count > 1) return 0;
  const auto number = [&](std::size_t k) { return series.files[slices[k].file].instance; };
  for (std::size_t k = 1; k < slices.size(); ++k)
    if (std::abs(number(k) - number(k - 1)) != times) return 0;
  // the numbers between them may be another volume of this series
  for (const DicomHeader& file : series.files)
    if (std::abs(file.instance - number(0)) % times != 0) return 0;
  return times;
}

// Slices that are missing between others.
void ask_for_missing(const Series& series, const std::vector<Slice>& slices,
                     const std::vector<double>& gaps, double usual, const std::string& file,
                     Scan& scan) {
  if (const Holes found = holes_in(gaps, usual); found.missing > 0)
    scan.ask(Ask::absent,
             fmt::format(
                 "{}: {} {} missing between others ({}; {:.3g} mm is usual), and burr would "
                 "fill the {} from the slices beside {}",
                 file, found.missing, found.missing == 1 ? "slice is" : "slices are", found.where,
                 usual, found.holes == 1 ? "hole" : "holes", found.holes == 1 ? "it" : "them"));
  else if (const int times = stated_multiple(series, slices, usual); times > 0)
    scan.ask(Ask::absent,
             fmt::format("{}: its slices lie {:.3g} mm apart, {} times as far as the files say, so "
                         "only one of {} slices may be here",
                         file, usual, times, times));
}

}  // namespace

std::string imager_offer(const DicomFrame& frame) {
  if (frame.imager_gap_mm[0] == 0) return {};
  const double y = frame.imager_gap_mm[0], x = frame.imager_gap_mm[1];
  std::string text =
      fmt::format("; its Imager Pixel Spacing, at the detector, is {:.4g} x {:.4g} mm", x, y);
  if (frame.magnification > 0)
    text += fmt::format(", which is {:.4g} x {:.4g} mm in the patient (magnification {:.4g})",
                        x / frame.magnification, y / frame.magnification, frame.magnification);
  return text;
}

Holes holes_in(const std::vector<double>& gaps, double usual) {
  Holes out;
  constexpr std::size_t kNamed = 5, kOtherDistance = 3;
  constexpr double kWhole = 0.1;  // of a usual gap
  const auto lost = [&](double gap) {
    const double times = gap / usual, whole = std::round(times);
    return whole >= 2 && std::abs(times - whole) < kWhole ? static_cast<std::size_t>(whole) - 1
                                                          : std::size_t{0};
  };
  for (std::size_t k = 0; k < gaps.size();) {
    const std::size_t here = lost(gaps[k]);
    std::size_t end = k + 1;
    while (here > 0 && end < gaps.size() && lost(gaps[end]) == here) ++end;
    if (here > 0 && end - k < kOtherDistance)
      for (std::size_t n = k; n < end; ++n) {
        out.missing += here;
        if (++out.holes <= kNamed)
          out.where += fmt::format("{}{} between slices {} and {} ({:.3g} mm)",
                                   out.holes > 1 ? ", " : "", here, n + 1, n + 2, gaps[n]);
      }
    k = end;
  }
  if (out.holes > kNamed) out.where += " and more";
  return out;
}

Status stack(const Series& series, const std::vector<Slice>& slices, const Stacking& how,
             const std::string& file, Scan& scan, Progress& progress) {
  const std::size_t n = slices.size();
  if (n == 1) {
    const double thickness = thickness_mm(series, slices.front());
    scan.spacing_mm.z() = thickness > 0 ? thickness : 5.0;
    return fine();
  }
  const DicomFrame& first = frame_of(series, slices.front());
  std::vector<SlicePlace> places(n);
  std::vector<double> gaps;
  double widest_shift = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const DicomFrame& frame = frame_of(series, slices[k]);
    places[k].z_mm = slices[k].along_mm - slices.front().along_mm;
    if (how.order == Order::positions) {
      const Vec3 off = frame.position_mm - first.position_mm;
      places[k].x_mm = off.dot(first.row);
      places[k].y_mm = off.dot(first.column);
    }
    widest_shift = std::max(widest_shift, std::hypot(places[k].x_mm, places[k].y_mm));
    if (k > 0) gaps.push_back(places[k].z_mm - places[k - 1].z_mm);
  }
  const double gap = median(gaps);
  const double even = places.back().z_mm / static_cast<double>(n - 1);
  if (!(gap > 1e-3) || places.back().z_mm > 5000)
    return error(fmt::format(
        "{}: the slices are {:.3g} mm apart, which is not possible; choose another series", file,
        gap));

  // even to a hundredth of a gap, because headers round positions
  std::string where;
  int uneven = 0;
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    if (std::abs(gaps[k] - gap) <= std::max(0.02 * gap, 0.011)) continue;
    if (++uneven <= 5)
      where +=
          fmt::format("{}{} and {} ({:.3g} mm)", where.empty() ? "" : ", ", k + 1, k + 2, gaps[k]);
  }
  const bool drifting = uneven == 0 && std::abs(even - gap) > 0.02 * gap;
  if (uneven > 0 && *std::max_element(gaps.begin(), gaps.end()) > 25 * gap)
    return error(
        fmt::format("{}: slices are missing: a gap of {:.3g} mm where {:.3g} mm is usual; copy the "
                    "files again or choose another series",
                    file, *std::max_element(gaps.begin(), gaps.end()), gap));
  // slices that could not be read are asked for already
  if (how.check_scan && how.order != Order::numbers && scan.questions.empty())
    ask_for_missing(series, slices, gaps, gap, file, scan);
  scan.spacing_mm.z() = even;
  const double finest = std::min(scan.spacing_mm.x(), scan.spacing_mm.y());
  const bool shifted = widest_shift > 0.05 * finest;
  if (!shifted && uneven == 0 && !drifting) return fine();

  if (uneven > 0)
    scan.notices.push_back(
        fmt::format("The slices are unevenly spaced: {} of {} gaps are not {:.3g} mm, between "
                    "slices {}{}; they were resampled to an even spacing.",
                    uneven, gaps.size(), gap, where, uneven > 5 ? " and others" : ""));
  if (shifted) {
    const double lean =
        std::atan2(std::hypot(places.back().x_mm, places.back().y_mm), places.back().z_mm);
    scan.notices.push_back(
        fmt::format("The slices are shifted against each other (gantry tilt of {:.1f} degrees); "
                    "they were resampled upright.",
                    lean * 180 / M_PI));
  }
  const double wanted = uneven > 0 ? gap : even;
  if (!shifted)
    for (SlicePlace& place : places) place.x_mm = place.y_mm = 0;
  return resample_upright(scan, places, wanted, progress);
}

}  // namespace burr::io
