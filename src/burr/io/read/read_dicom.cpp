// Makes one upright stack of evenly spaced slices from a DICOM folder or file.
#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <new>
#include <numeric>
#include <system_error>
#include <thread>

#include "burr/base/printable.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/dicom_header.h"
#include "burr/io/read/geometry.h"
#include "burr/io/read/readers.h"
#include "burr/io/read/samples.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using math::Mat3;
using math::Vec3;

constexpr std::size_t kMostFiles = 100000;
constexpr int kDeepestFolder = 10;
constexpr int kWorkers = 2;

// One slice: a frame of a file.
struct Slice {
  std::size_t file = 0;  // index in the series' files
  int frame = 0;         // index in the file
  double along_mm = 0;   // position along the normal
};

struct Series {
  std::string uid;
  std::vector<DicomHeader> files;
  int number = 0;
  [[nodiscard]] const DicomHeader& first() const { return files.front(); }
  [[nodiscard]] std::size_t pictures() const {
    std::size_t n = 0;
    for (const DicomHeader& file : files) n += static_cast<std::size_t>(file.frame_count);
    return n;
  }
};

bool has(const std::string& text, const char* part) {
  return lower(text).find(part) != std::string::npos;
}

// Why a file is not a slice of grey values; empty: it is one.
std::string not_a_slice(const DicomHeader& h) {
  if (!h.has_pixels) return "it holds no picture";
  const std::string& syntax = h.transfer_syntax;
  const bool plain = syntax.empty() || syntax == "1.2.840.10008.1.2" ||
                     syntax == "1.2.840.10008.1.2.1" || syntax == "1.2.840.10008.1.2.2" ||
                     syntax == "1.2.840.10008.1.2.1.99";
  if (plain == h.encapsulated)
    return plain ? "its pixels are compressed, although the transfer syntax says that they are not"
                 : "its pixels are not compressed, although the transfer syntax says that they are";
  if (h.float_pixels) return "it holds floating-point pixels, not a scan";
  if (h.rows < 1 || h.columns < 1) return "it holds no picture (Rows or Columns missing)";
  if (h.samples != 1) return "it is a colour picture; burr reads grey values";
  if (has(h.photometric, "palette"))
    return "it is a colour picture with a palette; burr reads grey values";
  if (h.bits_allocated == 1) return "it is a DICOM segmentation; convert it to .seg.nrrd";
  if (h.bits_allocated != 8 && h.bits_allocated != 16 && h.bits_allocated != 32)
    return fmt::format("Bits Allocated is {}, but burr reads 8, 16 or 32", h.bits_allocated);
  if (h.bits_stored < 1 || h.bits_stored > h.bits_allocated || h.high_bit >= h.bits_allocated ||
      h.high_bit < h.bits_stored - 1)
    return fmt::format(
        "Bits Stored is {} of {} allocated bits, or High Bit does not fit; the header is wrong",
        h.bits_stored, h.bits_allocated);
  const auto pixels = static_cast<std::uint64_t>(h.rows) * static_cast<std::uint64_t>(h.columns) *
                      static_cast<std::uint64_t>(h.frame_count);
  const std::uint64_t bytes = pixels * static_cast<std::uint64_t>(h.bits_allocated / 8);
  if (!h.encapsulated && bytes > h.pixels_length)
    return fmt::format("Pixel Data has {} bytes, but {} are needed; the file is cut off",
                       h.pixels_length, bytes);
  for (const DicomFrame& frame : h.frames)
    if (!(std::abs(frame.slope) < 1e6 && std::abs(frame.intercept) < 1e9))
      return fmt::format("a Rescale Slope of {:g} or an Intercept of {:g} is out of range",
                         frame.slope, frame.intercept);
  // JPEG 2000 of an empty picture is tiny, but not as tiny as that
  if (h.encapsulated && (bytes > h.pixels_length * 20000 || bytes > (std::uint64_t{1} << 33)))
    return fmt::format("{} bytes of compressed pixels cannot hold {} pixels", h.pixels_length,
                       pixels);
  return {};
}

struct Found {
  std::vector<Series> series;
  std::size_t others = 0;       // files that are not slices
  std::size_t leading_out = 0;  // links to files outside the folder
  std::string last_reason;      // why the last such file is not one
  Trouble last_trouble = Trouble::data;
};

void sort_in(Found& found, DicomHeader header) {
  const std::string reason = not_a_slice(header);
  if (!reason.empty()) {
    ++found.others;
    found.last_reason = fmt::format("{}: {}", short_name(header.path), reason);
    return;
  }
  for (Series& series : found.series)
    if (series.uid == header.series) {
      series.files.push_back(std::move(header));
      return;
    }
  Series fresh;
  fresh.uid = header.series;
  fresh.number = header.series_number;
  fresh.files.push_back(std::move(header));
  found.series.push_back(std::move(fresh));
}

bool lies_in(const std::filesystem::path& root, const std::filesystem::path& link) {
  std::error_code trouble;
  const auto target = std::filesystem::canonical(link, trouble);
  if (trouble) return true;  // a dead link
  const auto rest = target.lexically_relative(root);
  return !rest.empty() && *rest.begin() != "..";
}

Result<Found> search(const std::filesystem::path& path, Progress& progress) {
  Found found;
  std::error_code trouble;
  std::vector<std::filesystem::path> paths;
  if (std::filesystem::is_directory(path, trouble)) {
    const auto root = std::filesystem::canonical(path, trouble);
    auto walk = std::filesystem::recursive_directory_iterator(
        path, std::filesystem::directory_options::skip_permission_denied, trouble);
    for (; !trouble && walk != std::filesystem::recursive_directory_iterator();
         walk.increment(trouble)) {
      if (walk.depth() >= kDeepestFolder) walk.disable_recursion_pending();
      std::error_code kind;
      if (walk->is_symlink(kind)) {  // a slice with two names counts once; links that lead out of
                                     // the folder are not followed
        if (!lies_in(root, walk->path())) ++found.leading_out;
        continue;
      }
      if (!walk->is_regular_file(kind)) continue;
      paths.push_back(walk->path());
      if (paths.size() > kMostFiles)
        return error(fmt::format("{}: holds more than {} files; give the folder of one study",
                                 short_name(path), kMostFiles));
    }
    std::sort(paths.begin(), paths.end());  // the order on disk means nothing
    if (paths.empty() && found.leading_out > 0)
      return error(
          fmt::format("{}: holds only links that lead out of it; give the folder that holds the "
                      "files, or copy them",
                      short_name(path)));
    if (paths.empty())
      return error(fmt::format("{}: the folder holds no files; give the folder of the scan",
                               short_name(path)));
  } else {
    paths.push_back(path);
  }
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (i % 32 == 0) {
      progress.report(static_cast<double>(i) / static_cast<double>(paths.size()),
                      "searching the files");
      if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
    }
    if (short_name(paths[i]) == "DICOMDIR" && paths.size() > 1)
      continue;  // an index, often out of date
    auto header = read_dicom_header(paths[i]);
    if (header) {
      sort_in(found, std::move(*header));
    } else {
      ++found.others;
      found.last_reason = header.error().text;
      found.last_trouble = header.error().trouble;
    }
  }
  return found;
}

bool scout(const DicomHeader& h) {
  return has(h.image_type, "localizer") || has(h.description, "scout") ||
         has(h.description, "topogram") || has(h.description, "surview");
}

bool bone_kernel(const DicomHeader& h) {
  const std::string kernel = lower(h.kernel);
  if (has(h.description, "bone") || has(h.description, "knochen") ||
      kernel.find("bone") != std::string::npos)
    return true;
  // Siemens B60..B80, H60..H70; GE EDGE; Canon FC30, FC81; Philips D, E, YA, YB
  return kernel.find("edge") != std::string::npos || kernel.rfind("b6", 0) == 0 ||
         kernel.rfind("b7", 0) == 0 || kernel.rfind("h6", 0) == 0 || kernel.rfind("h7", 0) == 0 ||
         kernel.rfind("hr6", 0) == 0 || kernel.rfind("br6", 0) == 0 ||
         kernel.rfind("fc3", 0) == 0 || kernel.rfind("fc8", 0) == 0 || kernel == "ya" ||
         kernel == "yb" || kernel == "d" || kernel == "e";
}

double thickness_mm(const Series& series) {
  const DicomHeader& h = series.first();
  if (h.between_slices_mm > 0) return h.between_slices_mm;
  return h.frames.front().thickness_mm > 0 ? h.frames.front().thickness_mm : 5.0;
}

// The series that a surgeon would mean has the highest value: CT, a stack and no scout, thin
// slices, many of them, a bone kernel.
double worth(const Series& series) {
  const DicomHeader& h = series.first();
  double sum = 0;
  if (h.modality == "CT") sum += 100;
  if (series.pictures() >= 4) sum += 60;
  if (scout(h) || has(h.image_type, "secondary") || has(h.image_type, "screen")) sum -= 80;
  sum += 12 * std::log2(static_cast<double>(series.pictures()) + 1);
  sum -= 12 * std::log2(std::clamp(thickness_mm(series), 0.05, 20.0));
  if (bone_kernel(h)) sum += 10;
  return sum;
}

// For people and programs. The description is free text that may contain a name, so it is left out.
std::string one_line(const Series& series, std::size_t place) {
  const DicomHeader& h = series.first();
  return fmt::format("#{}: {} {} pictures {} x {}, {:.3g} mm{}{}", place + 1,
                     h.modality.empty() ? "unknown kind," : base::printable(h.modality, 16) + ",",
                     series.pictures(), h.columns, h.rows, thickness_mm(series),
                     scout(h) ? ", scout" : "", bone_kernel(h) ? ", bone kernel" : "");
}

Result<std::size_t> choose(const Found& found, const ReadOptions& options, const std::string& file,
                           Scan& scan) {
  const std::vector<Series>& all = found.series;
  std::string list;
  for (std::size_t s = 0; s < all.size(); ++s) list += (s > 0 ? "; " : "") + one_line(all[s], s);
  if (!options.series.empty()) {
    std::int64_t place = 0;
    if (options.series[0] == '#' && to_number(std::string_view(options.series).substr(1), place) &&
        place >= 1 && place <= static_cast<std::int64_t>(all.size()))
      return static_cast<std::size_t>(place - 1);
    std::vector<std::size_t> fits;
    for (std::size_t s = 0; s < all.size(); ++s)
      if (all[s].uid.rfind(options.series, 0) == 0) fits.push_back(s);
    if (fits.size() == 1) return fits.front();
    return error(Trouble::usage, fmt::format("{}: {} series match --series \"{}\"; there are {}",
                                             file, fits.size(), options.series, list));
  }
  std::size_t best = 0;
  for (std::size_t s = 1; s < all.size(); ++s)
    if (worth(all[s]) > worth(all[best])) best = s;
  if (all.size() > 1)
    scan.notices.push_back(
        fmt::format("{} series found ({}); #{} is used, choose another with --series.", all.size(),
                    list, best + 1));
  return best;
}

// The pictures of one size and orientation; the rest of a series is left out or refused.
Result<std::vector<Slice>> same_kind(const Series& series, const std::string& file, Scan& scan) {
  struct Kind {
    int rows, columns;
    Vec3 row, column;
    double row_gap, column_gap;
    std::vector<Slice> slices;
  };
  std::vector<Kind> kinds;
  for (std::size_t f = 0; f < series.files.size(); ++f) {
    const DicomHeader& h = series.files[f];
    for (int n = 0; n < h.frame_count; ++n) {
      const DicomFrame& frame = h.frames[static_cast<std::size_t>(n)];
      const auto fits = [&](const Kind& k) {
        return k.rows == h.rows && k.columns == h.columns && (k.row - frame.row).norm() < 2e-3 &&
               (k.column - frame.column).norm() < 2e-3 &&
               std::abs(k.row_gap - frame.row_gap_mm) < 1e-3 * k.row_gap &&
               std::abs(k.column_gap - frame.column_gap_mm) < 1e-3 * k.column_gap;
      };
      auto kind = std::find_if(kinds.begin(), kinds.end(), fits);
      if (kind == kinds.end()) {
        kinds.push_back({h.rows,
                         h.columns,
                         frame.row,
                         frame.column,
                         frame.row_gap_mm,
                         frame.column_gap_mm,
                         {}});
        kind = kinds.end() - 1;
      }
      kind->slices.push_back({f, n, 0});
    }
  }
  const auto most = std::max_element(kinds.begin(), kinds.end(), [](const Kind& a, const Kind& b) {
    return a.slices.size() < b.slices.size();
  });
  const std::size_t rest = series.pictures() - most->slices.size();
  if (rest > 0 && 5 * rest > series.pictures())
    return error(
        fmt::format("{}: the pictures of this series have {} different orientations or sizes, so "
                    "it is not a volume (perhaps a scout); choose another with --series",
                    file, kinds.size()));
  if (rest > 0)
    scan.notices.push_back(
        fmt::format("{} of {} pictures have another size or orientation and were left "
                    "out.",
                    rest, series.pictures()));
  return most->slices;
}

const DicomFrame& frame_of(const Series& series, const Slice& slice) {
  return series.files[slice.file].frames[static_cast<std::size_t>(slice.frame)];
}

// Sorts along the normal and keeps one picture per position.
Status order(const Series& series, std::vector<Slice>& slices, const std::string& file,
             Scan& scan) {
  const DicomFrame& first = frame_of(series, slices.front());
  const Vec3 normal = first.row.cross(first.column);
  const bool placed = std::all_of(slices.begin(), slices.end(),
                                  [&](const Slice& s) { return frame_of(series, s).has_position; });
  if (!placed) {
    const bool numbered =
        slices.size() == 1 || std::any_of(slices.begin(), slices.end(), [&](const Slice& s) {
          return series.files[s.file].instance != series.files[slices.front().file].instance ||
                 s.frame != slices.front().frame;
        });
    if (!numbered)
      return error(
          fmt::format("{}: the pictures have neither positions (Image Position Patient) nor "
                      "numbers, so their order is unknown; export the series again",
                      file));
    std::stable_sort(slices.begin(), slices.end(), [&](const Slice& a, const Slice& b) {
      const int na = series.files[a.file].instance, nb = series.files[b.file].instance;
      return na != nb ? na < nb : a.frame < b.frame;
    });
    const double gap = thickness_mm(series);
    for (std::size_t k = 0; k < slices.size(); ++k)
      slices[k].along_mm = gap * static_cast<double>(k);
    if (slices.size() > 1)
      scan.notices.push_back(fmt::format(
          "The pictures have no positions: they are ordered by their numbers, {:.3g} mm apart.",
          gap));
    return fine();
  }
  for (Slice& s : slices) s.along_mm = normal.dot(frame_of(series, s).position_mm);
  std::stable_sort(slices.begin(), slices.end(), [&](const Slice& a, const Slice& b) {
    if (std::abs(a.along_mm - b.along_mm) > 1e-4) return a.along_mm < b.along_mm;
    return series.files[a.file].instance < series.files[b.file].instance;
  });
  const std::size_t before = slices.size();
  slices.erase(std::unique(slices.begin(), slices.end(),
                           [](const Slice& a, const Slice& b) {
                             return std::abs(a.along_mm - b.along_mm) < 1e-3;
                           }),
               slices.end());
  if (before > 1 && slices.size() == 1)
    return error(
        fmt::format("{}: all {} pictures are at the same position, so they are not a volume; "
                    "choose another series",
                    file, before));
  if (slices.size() < before)
    scan.notices.push_back(
        fmt::format("{} pictures are at the position of another one ({} positions); the first at "
                    "each position is used.",
                    before - slices.size(), slices.size()));
  return fine();
}

// Reads the voxels of all slices, each with its own rescaling.
Status read_slices(const Series& series, const std::vector<Slice>& slices, Scan& scan,
                   Progress& progress) {
  const std::size_t pixels =
      static_cast<std::size_t>(scan.size.x()) * static_cast<std::size_t>(scan.size.y());
  scan.values.assign(pixels * slices.size(), 0.0F);
  std::atomic<std::size_t> next{0}, done{0};
  std::atomic<bool> stop{false};
  std::atomic<std::size_t> padded{0}, below{0};
  std::mutex lock;
  Status outcome = fine();

  // a file with many frames is decoded once, by one worker
  std::map<std::size_t, std::vector<std::size_t>> by_file;
  for (std::size_t k = 0; k < slices.size(); ++k) by_file[slices[k].file].push_back(k);
  std::vector<std::pair<std::size_t, std::vector<std::size_t>>> work(by_file.begin(),
                                                                     by_file.end());

  const auto one_file = [&](std::size_t index) -> Status {
    const DicomHeader& h = series.files[work[index].first];
    auto stored = read_dicom_pixels(h);
    if (!stored) return stored.error();
    for (const std::size_t k : work[index].second) {
      const DicomFrame& frame = frame_of(series, slices[k]);
      const std::int32_t* from =
          stored->data() + pixels * static_cast<std::size_t>(slices[k].frame);
      float* to = scan.values.data() + pixels * k;
      std::size_t holes = 0, low = 0;
      for (std::size_t v = 0; v < pixels; ++v) {
        const std::int64_t value = h.is_signed || h.bits_stored < 32
                                       ? std::int64_t{from[v]}
                                       : std::int64_t{static_cast<std::uint32_t>(from[v])};
        if (h.has_padding && value >= h.padding && value <= h.padding_end) {
          to[v] = -1024.0F;
          ++holes;
          continue;
        }
        to[v] = static_cast<float>(static_cast<double>(value) * frame.slope + frame.intercept);
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
      Status status = fine();
      try {
        status = one_file(index);
      } catch (const std::bad_alloc&) {
        status =
            error(fmt::format("{}: reading it needs more memory than allowed; if you trust it, "
                              "allow more with --read-memory-mb",
                              short_name(series.files[work[index].first].path)));
      } catch (const std::exception& problem) {
        status =
            error(fmt::format("{}: cannot be decompressed: {}",
                              short_name(series.files[work[index].first].path), problem.what()));
      }
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
  if (work.size() > 1 && kWorkers > 1) second = std::thread([&] { worker(false); });
  worker(true);
  if (second.joinable()) second.join();
  if (!outcome) return outcome;
  if (padded > 0)
    scan.notices.push_back(
        fmt::format("{} voxels were padding and are now air (-1024 HU).", padded.load()));
  if (below > 0)
    scan.notices.push_back(fmt::format(
        "{} voxels were below -1024 HU (outside the scanner's field of view) and are now -1024 HU.",
        below.load()));
  return fine();
}

// The position of each slice relative to the first; a notice says what is uneven.
Status stack(const Series& series, const std::vector<Slice>& slices, const std::string& file,
             Scan& scan, Progress& progress) {
  const std::size_t n = slices.size();
  if (n == 1) {
    scan.spacing_mm.z() = thickness_mm(series);
    return fine();
  }
  const DicomFrame& first = frame_of(series, slices.front());
  std::vector<SlicePlace> places(n);
  std::vector<double> gaps;
  double widest_shift = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const DicomFrame& frame = frame_of(series, slices[k]);
    places[k].z_mm = slices[k].along_mm - slices.front().along_mm;
    if (frame.has_position && first.has_position) {
      const Vec3 off = frame.position_mm - first.position_mm;
      places[k].x_mm = off.dot(first.row);
      places[k].y_mm = off.dot(first.column);
    }
    widest_shift = std::max(widest_shift, std::hypot(places[k].x_mm, places[k].y_mm));
    if (k > 0) gaps.push_back(places[k].z_mm - places[k - 1].z_mm);
  }
  std::vector<double> sorted = gaps;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double gap = sorted[sorted.size() / 2];
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
  if (gap > 20 || (uneven > 0 && *std::max_element(gaps.begin(), gaps.end()) > 25 * gap))
    return error(
        fmt::format("{}: slices are missing: a gap of {:.3g} mm where {:.3g} mm is usual; choose "
                    "another series",
                    file, *std::max_element(gaps.begin(), gaps.end()), gap));
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

}  // namespace

Result<Scan> read_dicom(const std::filesystem::path& path, const ReadOptions& options,
                        Progress& progress) {
  const std::string file = short_name(path);
  auto found = search(path, progress);
  if (!found) return found.error();
  if (found->series.empty()) {
    if (found->others == 1 && !found->last_reason.empty())
      return error(found->last_trouble, found->last_reason);
    return error(fmt::format("{}: none of its {} files is a slice of a scan (for example {})", file,
                             found->others, found->last_reason));
  }
  Scan scan;
  scan.format = "DICOM";
  if (found->leading_out > 0)
    scan.notices.push_back(
        fmt::format("{} links lead out of the folder and were not followed.", found->leading_out));
  auto chosen = choose(*found, options, file, scan);
  if (!chosen) return chosen.error();
  // more than anyone would look through; beyond this, choose with --series
  constexpr std::size_t kListed = 1000;
  if (found->series.size() > 1 && found->series.size() <= kListed) {
    for (std::size_t s = 0; s < found->series.size(); ++s)
      scan.series.push_back(one_line(found->series[s], s));
    scan.series_taken = static_cast<int>(*chosen);
  }
  const Series& series = found->series[*chosen];
  const DicomHeader& h = series.first();

  auto slices = same_kind(series, file, scan);
  if (!slices) return slices.error();
  if (Status status = order(series, *slices, file, scan); !status) return status.error();
  const DicomFrame& first = frame_of(series, slices->front());
  const DicomHeader& shape = series.files[slices->front().file];
  auto count =
      voxel_count(file, shape.columns, shape.rows, static_cast<std::int64_t>(slices->size()));
  if (!count) return count.error();
  scan.size = {shape.columns, shape.rows, static_cast<int>(slices->size())};
  scan.hounsfield = (h.modality == "CT" || h.modality.empty()) && !h.has_modality_lut &&
                    (first.has_rescale || h.rescale_type == "HU") &&
                    (h.rescale_type.empty() || h.rescale_type == "HU");
  if (h.has_modality_lut)
    scan.notices.emplace_back(
        "The file has a table of values (Modality LUT); burr does not apply it, so the values are "
        "not HU.");
  if (!first.has_spacing)
    scan.notices.emplace_back(
        "The file states no Pixel Spacing: 1 mm is assumed; see --spacing-mm.");
  if (!first.has_orientation)
    scan.notices.emplace_back("The file states no usable orientation: axial slices are assumed.");
  if (h.photometric == "MONOCHROME1")
    scan.notices.emplace_back("The picture is inverted (MONOCHROME1): dark is dense here.");

  if (Status status = read_slices(series, *slices, scan, progress); !status) return status.error();
  scan.spacing_mm = {first.column_gap_mm, first.row_gap_mm, 1};
  scan.axes.col(0) = first.row;
  scan.axes.col(1) = first.column;
  scan.axes.col(2) = first.row.cross(first.column);
  scan.origin_mm = first.position_mm;
  if (Status status = stack(series, *slices, file, scan, progress); !status) return status.error();
  if (slices->size() == 1)
    scan.notices.emplace_back(
        "There is only one slice, which is not a volume; give the folder of the series.");

  Affine affine;
  affine.step = scan.axes * scan.spacing_mm.asDiagonal();
  affine.origin = scan.origin_mm;
  if (Status status = place(scan, affine, options.spacing_mm, file, progress); !status)
    return status.error();
  return scan;
}

}  // namespace burr::io
