// io/read/nrrd_header.h - the text of an NRRD header: its fields, its keys, its data files and, of a
// .seg.nrrd, its segments. Internal to io. Thread: any.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/io/scan.h"

namespace burr::io {

struct NrrdHeader {
  std::map<std::string, std::string> fields;  // by lower-case name without spaces
  std::map<std::string, std::string> keys;    // key:=value, as in the file
  std::vector<std::string> file_list;         // after "data file: LIST"
  std::size_t end = 0;                        // where attached data begins
};

// Error: it does not begin as NRRD, or a line is none of a header. file: its name for errors.
[[nodiscard]] Result<NrrdHeader> parse_nrrd(const std::string& text, const std::string& file);

// The names of all data files; empty: the data is in the header's own file. Where a name is not exactly
// that of a file, a notice says which was taken.
[[nodiscard]] Result<std::vector<std::filesystem::path>> nrrd_data_files(
    const NrrdHeader& header, const std::filesystem::path& path, std::vector<std::string>& notices);

struct NrrdSegments {
  std::vector<Label> labels;  // their values as in the file
  std::vector<int> layers;    // of each
  std::vector<bool> bare;     // it names neither value nor layer, as in older files: one layer each
};

// Segment0_Name:=... of a .seg.nrrd
[[nodiscard]] NrrdSegments nrrd_segments(const NrrdHeader& header,
                                         std::vector<std::string>& notices);

}  // namespace burr::io
