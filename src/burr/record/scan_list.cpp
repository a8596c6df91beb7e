#include "burr/record/scan_list.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string_view>
#include <system_error>
#include <thread>

#include "burr/base/new_file.h"
#include "burr/base/places.h"
#include "burr/base/text_file.h"

namespace burr::record {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostScans = 1000;
constexpr std::uintmax_t kLargestFile = 8U << 20;       // [byte]
constexpr int kTries = 150;                             // for the lock ...
constexpr auto kPause = std::chrono::milliseconds(20);  // ... with this pause between them

// "0x" and 16 hexadecimal digits, as hex() writes them
bool read_hex(std::string_view text, std::uint64_t& value) {
  if (text.size() != 18 || !text.starts_with("0x")) return false;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + 2, end, value, 16);
  return read.ec == std::errc() && read.ptr == end;
}

// A line is: fingerprint, content, path. Other lines are left out.
std::vector<RememberedScan> read_list(const std::string& list) {
  std::vector<RememberedScan> scans;
  std::error_code nobody_asks;
  if (list.empty() || !fs::is_regular_file(list, nobody_asks)) return scans;
  const auto text = base::text_of_file(list, kLargestFile, "a list of scans");
  if (!text) return scans;
  std::string_view rest = *text;
  while (!rest.empty() && scans.size() < kMostScans) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    RememberedScan scan;
    constexpr std::size_t kPath = 2 * 19;  // where it begins
    if (line.size() <= kPath || line[18] != ' ' || line[37] != ' ' || line[kPath] != '/') continue;
    if (!read_hex(line.substr(0, 18), scan.fingerprint)) continue;
    if (!read_hex(line.substr(19, 18), scan.content_hash)) continue;
    scan.path = line.substr(kPath);
    scans.push_back(std::move(scan));
  }
  return scans;
}

Status write_list(const std::string& list, const std::vector<RememberedScan>& scans) {
  auto file = base::NewFile::create(list);
  if (!file) return file.error();
  file->write(
      "# Scans that recordings were made from, the newest first: fingerprint, content, path.\n"
      "# burr uses it to find the scan of a recording. You may delete this file.\n");
  for (const RememberedScan& scan : scans)
    file->write(
        fmt::format("{} {} {}\n", hex(scan.fingerprint), hex(scan.content_hash), scan.path));
  return file->put_in_place();
}

// One process at a time. The lock ends with the object, and with the process.
class Lock {
 public:
  explicit Lock(const std::string& list)
      : file_(::open((list + ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600)) {
    // another process holds it for milliseconds; one that hangs must not hold up a session
    for (int n = 0; file_ >= 0 && !held_ && n < kTries; ++n) {
      held_ = ::flock(file_, LOCK_EX | LOCK_NB) == 0;
      if (!held_ && errno != EWOULDBLOCK && errno != EINTR) break;
      if (!held_) std::this_thread::sleep_for(kPause);
    }
    trouble_ = held_ ? 0 : errno;
  }
  ~Lock() {
    if (file_ >= 0) ::close(file_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  [[nodiscard]] bool held() const { return held_; }
  [[nodiscard]] int trouble() const { return trouble_; }

 private:
  int file_ = -1, trouble_ = 0;
  bool held_ = false;
};

// change: returns false if the list is to stay as it is
Status change(const std::string& list,
              const std::function<bool(std::vector<RememberedScan>&)>& with) {
  const fs::path folder = fs::path(list).parent_path();
  std::error_code trouble;
  fs::create_directories(folder, trouble);
  if (!trouble) fs::permissions(folder, fs::perms::owner_all, trouble);
  if (trouble)
    return error(Trouble::io, fmt::format("{}: cannot be made ({}); the place of the scan is not "
                                          "remembered",
                                          folder.string(), trouble.message()));
  const Lock lock(list);
  if (!lock.held())
    return error(Trouble::io, fmt::format("{}: cannot be locked ({}); the place of the scan is not "
                                          "remembered",
                                          list, std::strerror(lock.trouble())));
  std::vector<RememberedScan> scans = read_list(list);
  return with(scans) ? write_list(list, scans) : fine();
}

}  // namespace

std::string scan_list(const fs::path& state) {
  const char* wish = std::getenv("BURR_REMEMBER_SCANS");
  if (state.empty() || (wish != nullptr && std::string_view(wish) == "0")) return {};
  return (state / "scans.txt").string();
}

Status remember_scan(const std::string& list, const RememberedScan& scan) {
  if (list.empty() || scan.fingerprint == 0) return fine();
  RememberedScan one = scan;
  std::error_code trouble;
  one.path = fs::absolute(scan.path, trouble).lexically_normal().string();
  if (trouble || one.path.find('\n') != std::string::npos)
    return error(Trouble::io,
                 "the scan's path cannot be kept in a line of text; its place is not "
                 "remembered");
  return change(list, [&one](std::vector<RememberedScan>& scans) {
    // what the path held before is gone; other bones of the same scan stay
    std::erase_if(scans, [&one](const RememberedScan& old) {
      return old.path == one.path &&
             (old.fingerprint != one.fingerprint || old.content_hash == one.content_hash);
    });
    scans.insert(scans.begin(), one);
    if (scans.size() > kMostScans) scans.resize(kMostScans);
    return true;
  });
}

std::string scan_list() { return scan_list(users_places().state); }

std::vector<std::string> remembered(const std::string& list, const VolumeInfo& wanted) {
  std::vector<RememberedScan> scans = read_list(list);
  if (wanted.source_fingerprint == 0) return {};
  std::erase_if(scans, [&wanted](const RememberedScan& scan) {
    return scan.fingerprint != wanted.source_fingerprint;
  });
  // a fingerprint reads only the ends of a file, so the same bone comes first
  std::stable_partition(scans.begin(), scans.end(), [&wanted](const RememberedScan& scan) {
    return scan.content_hash == wanted.content_hash;
  });
  std::vector<std::string> paths;
  for (const RememberedScan& scan : scans)
    if (std::find(paths.begin(), paths.end(), scan.path) == paths.end()) paths.push_back(scan.path);
  return paths;
}

Status forget_scan(const std::string& list, const std::string& path) {
  std::error_code nobody_asks;
  if (list.empty() || !fs::exists(list, nobody_asks)) return fine();
  return change(list, [&path](std::vector<RememberedScan>& scans) {
    return std::erase_if(scans, [&path](const RememberedScan& one) { return one.path == path; }) >
           0;
  });
}

}  // namespace burr::record
