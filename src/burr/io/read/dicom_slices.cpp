#include "burr/io/read/dicom_slices.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <new>
#include <thread>

#include "burr/io/read/archive.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/calibration.h"
#include "burr/io/read/dicom_absent.h"
#include "burr/io/read/dicom_header.h"
#include "burr/io/read/dicom_seg.h"
#include "burr/io/read/dicom_series.h"
#include "burr/io/read/dicom_stack.h"
#include "burr/io/read/geometry.h"
#include "burr/io/read/inverted.h"
#include "burr/io/read/modality.h"
#include "burr/io/read/readers.h"
#include "burr/io/read/samples.h"

namespace burr::io {
namespace {

using math::Vec3;

constexpr int kWorkers = 2;

// What the reading of slices leaves to be said.
struct Reading {
  std::vector<Unread> unread;  // files whose pixels could not be read
  std::vector<bool> lost;      // (slices)
  std::size_t beyond = 0;      // pixels with bits beyond Bits Stored
  int bits_stored = 0;
  std::size_t padded = 0;  // voxels that are padding; NaN where the values are checked
};

// How stored numbers become values.
struct Rescale {
  double slope = 1, intercept = 0;
};
Rescale rescale_of(const DicomFrame& frame, bool check_values) {
  if (check_values && !frame.has_rescale && frame.has_lone_intercept)
    return {1, frame.lone_intercept};
  return {frame.slope, frame.intercept};
}

// Sorts along the normal; says how the order is known, and refuses what has none.
Status order(const Series& series, Volume& volume, const std::string& file, Scan& scan) {
  std::vector<Slice>& slices = volume.slices;
  if (volume.no_stack)
    return error(fmt::format(
        "{}: all {} pictures lie at the same place (Image Position) and state no Slice Location; "
        "they are no volume but pictures of one slice, choose another series or other files",
        file, slices.size()));
  if (volume.mixed && volume.order == Order::numbers)
    return error(
        fmt::format("{}: the pictures have neither positions (Image Position Patient) nor "
                    "numbers of their own; their order cannot be known",
                    file));
  if (volume.mixed)
    return error(fmt::format(
        "{}: {} of {} pictures lie where another one lies, and nothing in the files tells the two "
        "volumes apart (acquisition, phase, time, kernel, number); give burr a folder that holds "
        "the files of one of them",
        file, volume.same_place, slices.size()));
  if (volume.copies > 0)
    scan.notices.push_back(
        fmt::format("{} files are copies of others and were left out.", volume.copies));
  if (volume.left_out > 0)
    scan.notices.push_back(
        fmt::format("{} of {} pictures have another size or orientation and were left "
                    "out.",
                    volume.left_out, series.pictures()));
  if (volume.same_place > 0)
    scan.notices.push_back(
        fmt::format("{} pictures are at the position of another one ({} positions); the first at "
                    "each position is used.",
                    volume.same_place, slices.size()));
  if (volume.order == Order::locations && slices.size() > 1)
    scan.notices.emplace_back(
        "The pictures have no positions of their own: placed by their Slice Location. Whether the "
        "first or the last slice is at the head is not stated; compare it with the patient.");
  if (volume.order != Order::numbers) return fine();

  const double stated = thickness_mm(series, slices.front()), gap = stated > 0 ? stated : 1.0;
  for (std::size_t k = 0; k < slices.size(); ++k) slices[k].along_mm = gap * static_cast<double>(k);
  if (slices.size() < 2) return fine();
  const bool stated_once = frame_of(series, slices.front()).has_position &&
                           series.files[slices.front().file].frame_count > 1;
  if (stated > 0 && stated_once)
    scan.notices.push_back(
        fmt::format("The file states the position of one frame only: the frames lie in their "
                    "order, {:.3g} mm apart (Spacing Between Slices or Slice Thickness).",
                    gap));
  else if (stated > 0)
    scan.notices.push_back(fmt::format(
        "The pictures have no positions: they are ordered by their numbers, {:.3g} mm apart.",
        gap));
  else
    scan.ask(Ask::spacing,
             fmt::format("{}: states neither positions of its slices nor their thickness, so their "
                         "distance is not known (taken for 1 mm)",
                         file));
  return fine();
}

// A file with many frames is decoded once, by one worker.
std::vector<std::pair<std::size_t, std::vector<std::size_t>>> by_file(
    const std::vector<Slice>& slices) {
  std::map<std::size_t, std::vector<std::size_t>> files;
  for (std::size_t k = 0; k < slices.size(); ++k) files[slices[k].file].push_back(k);
  return {files.begin(), files.end()};
}

template <class Work>
Status guarded(const std::filesystem::path& path, Work work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return error(
        fmt::format("{}: reading it needs more memory than allowed; if you trust it, allow more "
                    "with `read_memory_mb`",
                    short_name(path)));
  } catch (const std::exception& problem) {
    return error(fmt::format("{}: cannot be decompressed: {}", short_name(path), problem.what()));
  }
}

// Reads the voxels of all slices, each with its own rescaling.
Status read_slices(const Series& series, const std::vector<Slice>& slices, bool check_values,
                   Scan& scan, Reading& reading, Progress& progress) {
  const std::size_t pixels =
      static_cast<std::size_t>(scan.size.x()) * static_cast<std::size_t>(scan.size.y());
  scan.values.assign(pixels * slices.size(), 0.0F);
  std::atomic<std::size_t> next{0}, done{0};
  std::atomic<bool> stop{false};
  std::atomic<std::size_t> padded{0}, below{0}, beyond{0};
  reading.lost.assign(slices.size(), false);
  std::mutex lock;
  Status outcome = fine();

  const auto work = by_file(slices);
  Status first_lost = fine();
  const auto one_file = [&](std::size_t index) -> Status {
    const DicomHeader& h = series.files[work[index].first];
    std::size_t over = 0;
    auto stored = read_dicom_pixels(h, &over);
    if (!stored && stored.error().trouble == Trouble::data && work.size() > 1) {
      const std::lock_guard guard(lock);
      for (const std::size_t k : work[index].second) reading.lost[k] = true;
      if (reading.unread.empty()) first_lost = stored.error();
      reading.unread.push_back({h.path, series.uid, briefly(h.path, stored.error().text)});
      return fine();
    }
    if (!stored) return stored.error();
    beyond += over;
    for (const std::size_t k : work[index].second) {
      const DicomFrame& frame = frame_of(series, slices[k]);
      const std::int32_t* from =
          stored->data() + pixels * static_cast<std::size_t>(slices[k].frame);
      float* to = scan.values.data() + pixels * k;
      const Rescale rescale = rescale_of(frame, check_values);
      const float padding = check_values ? std::numeric_limits<float>::quiet_NaN() : -1024.0F;
      std::size_t holes = 0, low = 0;
      for (std::size_t v = 0; v < pixels; ++v) {
        const std::int64_t value = h.is_signed || h.bits_stored < 32
                                       ? std::int64_t{from[v]}
                                       : std::int64_t{static_cast<std::uint32_t>(from[v])};
        if (h.has_padding && value >= h.padding && value <= h.padding_end) {
          to[v] = padding;
          ++holes;
          continue;
        }
        to[v] = static_cast<float>(static_cast<double>(value) * rescale.slope + rescale.intercept);
        if (scan.hounsfield && to[v] < -1024.0F) {
          to[v] = -1024.0F;
          ++low;
        }
      }
      padded += holes;
      below += low;
    }
    done += work[index].second.size();
    return fine();
  };
  const auto worker = [&](bool reports) {
    while (!stop) {
      const std::size_t index = next++;
      if (index >= work.size()) return;
      const Status status =
          guarded(series.files[work[index].first].path, [&] { return one_file(index); });
      if (!status) {
        const std::lock_guard guard(lock);
        if (outcome.ok()) outcome = status.error();
        stop = true;
      }
      if (!reports) continue;
      progress.report(static_cast<double>(done) / static_cast<double>(slices.size()),
                      "reading slices");
      if (progress.cancelled()) {
        const std::lock_guard guard(lock);
        outcome = error(Trouble::interrupted, "reading was stopped");
        stop = true;
      }
    }
  };
  std::thread second;
  if (work.size() > 1 && kWorkers > 1 && std::thread::hardware_concurrency() > 1)
    second = std::thread([&] { worker(false); });
  worker(true);
  if (second.joinable()) second.join();
  if (!outcome) return outcome;
  if (reading.unread.size() == work.size()) return first_lost;
  reading.beyond = beyond;
  reading.bits_stored = series.files[slices.front().file].bits_stored;
  reading.padded = padded;
  if (check_values) return fine();
  if (padded > 0)
    scan.notices.push_back(
        fmt::format("{} voxels were padding and are now air (-1024 HU).", padded.load()));
  if (below > 0)
    scan.notices.push_back(fmt::format(
        "{} voxels were below -1024 HU (outside the scanner's field of view) and are now -1024 HU.",
        below.load()));
  return fine();
}

// Takes out the slices whose files could not be read.
void drop_lost(const std::vector<bool>& lost, std::vector<Slice>& slices, Scan& scan) {
  const std::size_t pixels =
      static_cast<std::size_t>(scan.size.x()) * static_cast<std::size_t>(scan.size.y());
  std::size_t kept = 0;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    if (lost[k]) continue;
    if (kept != k) {
      slices[kept] = slices[k];
      std::copy_n(scan.values.data() + pixels * k, pixels, scan.values.data() + pixels * kept);
    }
    ++kept;
  }
  slices.resize(kept);
  scan.size.z() = static_cast<int>(kept);
  scan.values.resize(pixels * kept);
}

// The files of this series that could not be read: all are counted, the first few named. Returns how
// many there are.
std::size_t say_unread(const Found& found, const Series& series, const Reading& reading,
                       const std::string& file, Scan& scan) {
  std::vector<Unread> own = reading.unread;
  const bool only_one = found.series.size() == 1;
  std::size_t elsewhere = 0;
  for (const Unread& unread : found.unread) {
    const bool beside = series.places.count(place_of(unread.path)) != 0;
    const bool member = unread.series.empty()
                            ? beside
                            : unread.series == series.uid || (series.joined > 0 && beside);
    if (member)
      own.push_back(unread);
    else if (!unread.series.empty() || only_one)
      ++elsewhere;
  }
  if (elsewhere > 0)
    scan.notices.push_back(
        fmt::format("{} other files in the folder are damaged or cannot be read.", elsewhere));
  if (own.empty()) return 0;
  std::sort(own.begin(), own.end(),
            [](const Unread& a, const Unread& b) { return a.path < b.path; });
  constexpr std::size_t kNamed = 5;
  std::string names;
  for (std::size_t n = 0; n < std::min(own.size(), kNamed); ++n)
    names += fmt::format("{}{}: {}", n > 0 ? ", " : "", short_name(own[n].path), own[n].why);
  if (own.size() > kNamed) names += fmt::format(", and {} more", own.size() - kNamed);
  const std::size_t all = series.files.size() + own.size() - reading.unread.size();
  scan.ask(Ask::missing, fmt::format("{}: {} of {} files could not be read, so slices are missing, "
                                     "perhaps at an end of the scan ({})",
                                     file, own.size(), all, names));
  return own.size();
}

// What the header says of the values.
Claim claim_of(const DicomHeader& h, const DicomFrame& first, bool check_values) {
  const Rescale rescale = rescale_of(first, check_values);
  const bool rescaled = first.has_rescale || (check_values && first.has_lone_intercept);
  Claim claim;
  claim.hounsfield = (h.modality == "CT" || h.modality.empty()) && !h.has_modality_lut &&
                     (rescaled || h.rescale_type == "HU") &&
                     (h.rescale_type.empty() || h.rescale_type == "HU");
  const std::array<const char*, 9> by_rays = {"CT", "", "OT", "XA", "RF", "DX", "PX", "IO", "SC"};
  claim.can_be_hounsfield =
      !h.has_modality_lut && std::find(by_rays.begin(), by_rays.end(), h.modality) != by_rays.end();
  claim.clip_below_air = true;
  claim.slope = rescale.slope;
  claim.intercept = rescale.intercept;
  if (!h.float_pixels && h.bits_stored >= 10 && h.bits_stored <= 16)
    claim.period = std::exp2(h.bits_stored);
  return claim;
}

Status judge(Claim claim, const Reading& reading, const std::string& file, Scan& scan) {
  claim.padded = reading.padded;
  if (Status status = calibrate(scan, claim); !status)
    return error(fmt::format("{}: {}", file, status.error().text));
  return fine();
}

// What the numbers of the header leave open.
void say_header(const Series& series, const std::vector<Slice>& slices, const std::string& file,
                Scan& scan) {
  const DicomFrame& first = frame_of(series, slices.front());
  const DicomHeader& h = series.files[slices.front().file];
  if (h.decimal_commas)
    scan.notices.emplace_back(
        "The file writes numbers with a decimal comma (\"0,5\"): read as decimal points.");
  if (!h.unreadable.empty())
    scan.notices.push_back(
        fmt::format("{} cannot be read as a number and was left out.", h.unreadable));
  if (!first.has_spacing && slices.size() > 1)
    scan.ask(Ask::spacing,
             fmt::format("{}: states no Pixel Spacing{} (taken for 1 mm){}", file,
                         h.unreadable.empty() ? "" : " that can be read", imager_offer(first)));
  else if (!first.has_spacing)
    scan.notices.emplace_back(
        "The file states no Pixel Spacing: 1 mm is assumed; see `spacing_mm`.");
  if (!first.has_orientation)
    scan.notices.emplace_back("The file states no usable orientation: axial slices are assumed.");
}

}  // namespace

Status read_dicom_volume(const Found& found, Volume volume, const ReadOptions& options,
                         const std::filesystem::path& path, Scan& scan, Progress& progress) {
  const std::string file = short_name(path);
  scan.format = "DICOM";
  const Series& series = found.series[volume.series];
  if (series.joined > 0)
    scan.notices.push_back(fmt::format(
        "{} series of one picture each were joined: their number, frame of reference, size and "
        "orientation agree, and they lie evenly spaced.",
        series.joined));
  std::vector<Slice>& slices = volume.slices;
  const DicomHeader& h = series.files[slices.front().file];

  if (Status status = order(series, volume, file, scan); !status) return status;
  auto count = voxel_count(file, h.columns, h.rows, static_cast<std::int64_t>(slices.size()));
  if (!count) return count.error();
  scan.size = {h.columns, h.rows, static_cast<int>(slices.size())};
  const Claim claim = claim_of(h, frame_of(series, slices.front()), options.check_values);
  scan.hounsfield = claim.hounsfield && !options.check_values;
  if (h.has_modality_lut)
    scan.notices.emplace_back(
        "The file has a table of values (Modality LUT); burr does not apply it, so the values are "
        "not HU.");
  say_header(series, slices, file, scan);
  if (h.inverted && !options.check_scan)
    scan.notices.emplace_back("The picture is inverted (MONOCHROME1): dark is dense here.");
  if (options.check_scan) take_modality(h.modality, h.sop_class, file, scan);

  Reading reading;
  if (Status status = read_slices(series, slices, options.check_values, scan, reading, progress);
      !status)
    return status;
  if (!reading.unread.empty()) drop_lost(reading.lost, slices, scan);
  if (options.check_values)
    if (Status status = judge(claim, reading, file, scan); !status) return status;
  if (h.inverted && options.check_scan) turn_inverted(scan, file);
  const std::size_t unread = say_unread(found, series, reading, file, scan);
  const bool folder = std::filesystem::is_directory(path) || files_in_archive(path);
  if (options.check_scan) say_absent(found, series, volume, {unread, folder}, file, scan);
  if (reading.beyond > 0)
    scan.notices.push_back(fmt::format(
        "{} pixels have bits beyond the {} that Bits Stored states; these bits were left out, as "
        "the standard says. If no overlay was drawn there, very dense parts (metal) are holes now.",
        reading.beyond, reading.bits_stored));
  const DicomFrame& first = frame_of(series, slices.front());
  scan.spacing_mm = {first.column_gap_mm, first.row_gap_mm, 1};
  scan.axes.col(0) = first.row;
  scan.axes.col(1) = first.column;
  scan.axes.col(2) = first.row.cross(first.column);
  scan.origin_mm = first.position_mm;
  if (Status status =
          stack(series, slices, {volume.order, options.check_scan}, file, scan, progress);
      !status)
    return status;
  if (slices.size() == 1)
    scan.notices.emplace_back(
        std::filesystem::is_directory(path)
            ? "Only one slice: a picture, not a volume; the folder holds no more slices of it."
            : "There is only one slice, which is not a volume; give the folder of the series.");

  Affine affine;
  affine.step = scan.axes * scan.spacing_mm.asDiagonal();
  affine.origin = scan.origin_mm;
  if (Status status = place(scan, affine, options.spacing_mm, file, progress); !status)
    return status;
  return fine();
}

}  // namespace burr::io
