// io/read/dicomdir.h - the list of a DICOMDIR (PS3.3 F.3): which pictures should lie beside it, and
// to which series each belongs. Internal to io.
//
// The file may come from a stranger: no length and no offset is trusted, records that lead to each
// other in a circle are visited once, and there is a limit to their number.
// Thread: any. Errors and names: no patient data; records of patients are not kept.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "burr/io/read/bytes.h"

namespace burr::io {

// One picture that the index names.
struct Listed {
  std::string series;          // UID
  std::string instance;        // SOP Instance UID
  std::filesystem::path file;  // below the folder of the DICOMDIR; empty: it names none
};

// Of bytes of a whole DICOMDIR. Empty: it names no picture, or cannot be read.
[[nodiscard]] std::vector<Listed> listed_in(const std::vector<std::uint8_t>& bytes);

// The same of a file.
[[nodiscard]] std::vector<Listed> read_dicomdir(const std::filesystem::path& path);

}  // namespace burr::io
