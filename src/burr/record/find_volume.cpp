#include "burr/record/find_volume.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>

#include "burr/base/hash.h"
#include "burr/base/plain_file.h"
#include "burr/record/mcap/mcap_bytes.h"
#include "burr/record/scan_list.h"

namespace burr::record {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kEnd = std::size_t{1} << 14;  // bytes read from each end
constexpr std::size_t kMostFiles = 20'000;          // of a folder; more is not a series
constexpr std::size_t kMostCandidates = 5'000;
constexpr int kLevels = 2;

std::uint64_t hash_bytes(std::uint64_t hash, ByteSpan bytes) {
  std::size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, 8);
    hash = base::mix(hash, word);
  }
  std::uint64_t rest = 0;
  if (at < bytes.size()) std::memcpy(&rest, bytes.data() + at, bytes.size() - at);
  return base::mix(hash, rest);
}

bool written_by_us(const fs::path& path) {
  static const std::set<std::string> kOurs = {".mcap", ".part", ".png", ".stl",  ".ply",
                                              ".obj",  ".3mf",  ".glb", ".json", ".csv"};
  return kOurs.contains(path.extension().string());
}

bool hidden(const fs::path& path) { return path.filename().string().starts_with('.'); }

Result<std::uint64_t> fingerprint_of_file(const std::string& path) {
  if (const Status plain = base::check_plain_file(path); !plain) return plain.error();
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat about {};
  if (file < 0 || ::fstat(file, &about) != 0) {
    const int code = errno;
    if (file >= 0) ::close(file);
    return error(Trouble::io, fmt::format("{}: cannot be read: {}", path, std::strerror(code)));
  }
  const auto size = static_cast<std::uint64_t>(about.st_size);
  std::uint64_t hash = base::mix(0, size);
  std::vector<std::uint8_t> bytes(kEnd);
  bool good = true;
  for (const std::uint64_t offset : {std::uint64_t{0}, size > kEnd ? size - kEnd : 0}) {
    const auto want = static_cast<std::size_t>(std::min<std::uint64_t>(kEnd, size - offset));
    std::size_t done = 0;
    while (done < want) {
      const ssize_t n =
          ::pread(file, bytes.data() + done, want - done, static_cast<off_t>(offset + done));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) break;
      done += static_cast<std::size_t>(n);
    }
    good = good && done == want;
    hash = hash_bytes(hash, ByteSpan(bytes).first(done));
  }
  ::close(file);
  if (!good) return error(Trouble::io, path + ": cannot be read completely; copy it again");
  return hash == 0 ? 1 : hash;
}

// names in a folder, sorted; empty when it cannot be listed
std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code problem;
  for (fs::directory_iterator at(folder, fs::directory_options::skip_permission_denied, problem),
       end;
       !problem && at != end; at.increment(problem)) {
    if (!hidden(at->path())) found.push_back(at->path());
    if (found.size() > kMostFiles) break;
  }
  std::sort(found.begin(), found.end());
  return found;
}

bool looks_like_a_volume(const fs::path& path) {
  static const std::set<std::string> kVolumes = {".nii", ".gz",  ".bz2", ".nrrd", ".nhdr", ".mha",
                                                 ".mhd", ".dcm", ".zip", ".yaml", ""};
  return kVolumes.contains(path.extension().string());
}

// adds the folder itself, the volumes in it, and the same for its subfolders
void gather(const fs::path& folder, int levels, std::vector<fs::path>& candidates) {
  if (candidates.size() >= kMostCandidates) return;
  candidates.push_back(folder);
  for (const fs::path& entry : entries(folder)) {
    if (candidates.size() >= kMostCandidates) return;
    std::error_code problem;
    if (fs::is_directory(entry, problem)) {
      if (levels > 0) gather(entry, levels - 1, candidates);
    } else if (fs::is_regular_file(entry, problem) && looks_like_a_volume(entry)) {
      candidates.push_back(entry);
    }
  }
}

std::string described(const VolumeInfo& wanted) {
  return fmt::format("{} x {} x {} voxels of {:.4g} mm, content {}", wanted.grid.size.x(),
                     wanted.grid.size.y(), wanted.grid.size.z(), wanted.grid.voxel * 1e3,
                     hex(wanted.content_hash));
}

}  // namespace

Result<std::uint64_t> fingerprint(const std::string& path) {
  std::error_code problem;
  if (!fs::is_directory(path, problem)) return fingerprint_of_file(path);
  std::vector<std::uint64_t> prints;
  for (const fs::path& entry : entries(path)) {
    if (!fs::is_regular_file(entry, problem) || written_by_us(entry)) continue;
    const auto print = fingerprint_of_file(entry.string());
    if (!print) return print.error();
    prints.push_back(*print);
  }
  if (prints.empty())
    return error(Trouble::io, path + ": the folder holds no files; give the folder of the scan");
  std::sort(prints.begin(), prints.end());  // names and their order do not matter
  const std::uint64_t hash = base::mix(prints.size(), prints);
  return hash == 0 ? 1 : hash;
}

std::string volume_search_path() {
  const char* path = std::getenv("BURR_VOLUME_PATH");
  return path == nullptr ? "" : path;
}

Result<std::string> find_volume(const VolumeInfo& wanted, const VolumeHints& hints) {
  std::error_code problem;
  if (!hints.given.empty()) {
    if (fs::exists(hints.given, problem)) return hints.given;
    return error(Trouble::io,
                 hints.given + ": this file or folder does not exist; correct `volume`");
  }
  const Error lost = error(
      Trouble::io,
      fmt::format("the bone of this recording ({}) was not found; put its scan beside the "
                  "recording, give the scan with `volume`, or give its folder in BURR_VOLUME_PATH",
                  described(wanted)));
  if (wanted.source_fingerprint == 0) return lost;
  const auto is_it = [&wanted](const std::string& path) {
    const auto print = fingerprint(path);
    return print && *print == wanted.source_fingerprint;
  };

  std::vector<fs::path> candidates;
  for (std::size_t at = 0; at < hints.search_path.size();) {
    const std::size_t end = std::min(hints.search_path.find(':', at), hints.search_path.size());
    if (end > at) gather(hints.search_path.substr(at, end - at), kLevels, candidates);
    at = end + 1;
  }
  const fs::path beside = fs::path(hints.recording).parent_path();
  gather(beside.empty() ? fs::path(".") : beside, kLevels, candidates);
  for (const fs::path& candidate : candidates)
    if (is_it(candidate.string())) return candidate.string();

  for (const std::string& path : remembered(hints.list, wanted)) {
    if (is_it(path)) return path;
    static_cast<void>(forget_scan(hints.list, path));  // it may stay: it is checked each time
  }

  candidates.clear();
  gather(".", kLevels, candidates);
  for (const fs::path& candidate : candidates)
    if (is_it(candidate.string())) return candidate.string();
  return lost;
}

Status check_volume(const VolumeInfo& wanted, const volume::Bone& bone, const std::string& where) {
  const volume::Grid& grid = bone.grid();
  if (grid.size != wanted.grid.size || grid.voxel != wanted.grid.voxel)
    return error(fmt::format(
        "{}: this bone has {} x {} x {} voxels of {:.4g} mm, but the bone of the recording has {}; "
        "check that this is the right scan",
        where, grid.size.x(), grid.size.y(), grid.size.z(), grid.voxel * 1e3, described(wanted)));
  const std::uint64_t hash = bone.content_hash();
  if (hash != wanted.content_hash)
    return error(
        fmt::format("{}: this bone has content {}, but the bone of the recording has {}; check "
                    "that this is the right scan, imported by the same version of burr",
                    where, hex(hash), described(wanted)));
  return fine();
}

}  // namespace burr::record
