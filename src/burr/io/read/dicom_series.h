// io/read/dicom_series.h - the files of a DICOM folder, sorted into series, and the series divided
// into volumes: two phases, two kernels, two planes or two blocks of slices that share a series.
// Internal to io.
//
// Units: mm. Frame: LPS. Thread: one at a time. Errors and names: no patient data.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/dicom_header.h"
#include "burr/io/read/dicomdir.h"
#include "burr/io/read/read_options.h"
#include "burr/io/scan.h"

namespace burr::io {

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
  std::size_t joined = 0;  // of so many series of one picture each; 0: it is one series
  std::set<std::pair<std::string, std::string>> places;  // folder and ending of its files
  [[nodiscard]] const DicomHeader& first() const { return files.front(); }
  [[nodiscard]] std::size_t pictures() const {
    std::size_t n = 0;
    for (const DicomHeader& file : files) n += static_cast<std::size_t>(file.frame_count);
    return n;
  }
};

[[nodiscard]] inline const DicomFrame& frame_of(const Series& series, const Slice& slice) {
  return series.files[slice.file].frames[static_cast<std::size_t>(slice.frame)];
}

// A file that is a slice by all signs, but cannot be read.
struct Unread {
  std::filesystem::path path;
  std::string series;  // UID; empty: not known
  std::string why;     // "cut off", "empty"
};

// A picture that a DICOMDIR lists.
struct Indexed {
  Listed listed;
  bool there = false;
  std::string series;  // UID in the file itself, if it is there and a slice
};

struct Found {
  std::vector<Series> series;
  std::vector<DicomHeader> segmentations;  // dicom_seg.h
  std::vector<DicomHeader> contour_sets;   // dicom_contours.h
  std::vector<Unread> unread;
  std::size_t others = 0;                        // files that are not slices
  std::map<std::string, std::size_t> others_of;  // of these, whole ones of each series
  std::vector<Indexed> listed;
  std::size_t leading_out = 0;  // links to files outside the folder
  std::string last_reason;      // why the last such file is not one
  Trouble last_trouble = Trouble::data;
};

// Folder and ending (".dcm", or none) of a file: slices of one series share them.
[[nodiscard]] std::pair<std::string, std::string> place_of(const std::filesystem::path& path);
// An error about a file in few words, for a list of files.
[[nodiscard]] std::string briefly(const std::filesystem::path& path, std::string reason);

// Reads the headers of a file, or of all files in a folder.
[[nodiscard]] Result<Found> find_series(const std::filesystem::path& path, Progress& progress);

// How the order of the slices is known.
enum class Order {
  positions,  // Image Position (Patient)
  locations,  // Slice Location
  numbers,    // Instance Number and number of the frame
};

// One volume of a series.
struct Volume {
  std::size_t series = 0;
  Order order = Order::positions;
  std::vector<Slice> slices;   // one for each place, along the normal
  std::string part;            // "phase 2 of 3", "block 1 of 2"; empty: the only one
  std::size_t same_place = 0;  // slices left out because another one lies at their place
  std::size_t copies = 0;      // files left out because they are copies
  std::size_t left_out = 0;    // pictures of another size or orientation
  bool mixed = false;          // several slices at each place, and nothing tells them apart
  bool no_stack = false;       // all slices at one place
};

[[nodiscard]] std::vector<Volume> volumes_of(const std::vector<Series>& all);

// The series' own statement; 0: there is none.
[[nodiscard]] double thickness_mm(const Series& series, const Slice& slice);

// For people and programs: kind, number of slices, thickness, plane, kernel, phase. The description
// is free text that may contain a name, so it is left out.
[[nodiscard]] std::string one_line(const Series& series, const Volume& volume, std::size_t place);

// The volume that the options name, or else the best one. A notice lists all.
[[nodiscard]] Result<std::size_t> choose(const Found& found, const std::vector<Volume>& volumes,
                                         const ReadOptions& options, const std::string& file,
                                         Scan& scan);

}  // namespace burr::io
