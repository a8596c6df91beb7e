#include "burr/io/read/beside.h"

#include <fmt/core.h>

#include <algorithm>
#include <system_error>
#include <vector>

#include "burr/base/printable.h"
#include "burr/io/read/archive.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/letters.h"

namespace burr::io {
namespace {

namespace fs = std::filesystem;

// The last part of a name with folders; the name itself, if it has none.
std::string last_part(const std::string& name) {
  const std::string slashed = with_slashes(name);
  const std::size_t slash = slashed.rfind('/');
  if (slash != std::string::npos) return name.substr(slash + 1);
  const bool drive = name.size() > 2 && name[1] == ':';  // "D:jaw.raw"
  return drive ? name.substr(2) : name;
}

bool plain(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos;
}

std::vector<fs::path> files_beside(const fs::path& header) {
  const fs::path folder = header.parent_path();
  std::vector<fs::path> found;
  if (const auto packed = archive_around(header)) {
    for (const fs::path& path : *packed)
      if (path.parent_path() == folder) found.push_back(path);
    return found;
  }
  constexpr std::size_t kMost = 100000;
  std::error_code trouble;
  for (fs::directory_iterator at(folder.empty() ? fs::path(".") : folder, trouble), end;
       !trouble && at != end && found.size() < kMost; at.increment(trouble)) {
    std::error_code kind;
    if (fs::is_regular_file(at->symlink_status(kind)) && !kind)
      found.push_back(folder / at->path().filename());
  }
  return found;
}

}  // namespace

bool file_is_there(const fs::path& path) {
  if (const auto packed = archive_around(path))
    return std::find(packed->begin(), packed->end(), path) != packed->end();
  std::error_code trouble;
  return fs::is_regular_file(fs::symlink_status(path, trouble));
}

std::optional<fs::path> find_beside(const fs::path& header, const std::string& name) {
  if (!plain(name)) return std::nullopt;
  const fs::path exact = header.parent_path() / name;
  if (file_is_there(exact)) return exact;
  std::optional<fs::path> found;
  for (const fs::path& path : files_beside(header))
    if (same_name(path.filename().string(), name)) {
      if (found) return std::nullopt;
      found = path;
    }
  return found;
}

Result<DataFile> data_file_beside(const fs::path& header, const std::string& name) {
  std::string own = name;
  while (own.rfind("./", 0) == 0) own.erase(0, 2);
  if (plain(own) && file_is_there(header.parent_path() / own))
    return DataFile{header.parent_path() / own, ""};
  const std::string last = last_part(own);
  const bool moved = last != own;
  if (const auto found = find_beside(header, last)) {
    const std::string taken = short_name(*found);
    return DataFile{
        *found, moved ? fmt::format("The header names its data file in another folder; {} beside "
                                    "the header was read.",
                                    taken)
                      : fmt::format("The header names its data file {}; {} beside the header was "
                                    "read.",
                                    base::printable(utf8_of_name(last), 255), taken)};
  }
  if (moved || !plain(own))
    return error(
        fmt::format("{}: its data file must be in the same folder, but the header names another "
                    "place; move the file beside the header",
                    short_name(header)));
  return DataFile{header.parent_path() / own, ""};
}

}  // namespace burr::io
