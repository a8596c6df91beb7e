#include "burr/base/inputs.h"

#include <sys/stat.h>

#include <filesystem>
#include <mutex>
#include <set>
#include <system_error>
#include <tuple>

namespace burr::base {
namespace {

struct Identity {
  dev_t device = 0;
  ino_t inode = 0;
  bool operator<(const Identity& other) const {
    return std::tie(device, inode) < std::tie(other.device, other.inode);
  }
  bool operator==(const Identity& other) const {
    return device == other.device && inode == other.inode;
  }
};

bool identify(const std::string& path, Identity& identity, bool& regular) {
  struct stat found = {};
  if (path.empty() || ::stat(path.c_str(), &found) != 0) return false;
  identity = {found.st_dev, found.st_ino};
  regular = S_ISREG(found.st_mode);
  return true;
}

// The name is kept too: once the file is gone, its inode may belong to another file.
struct Noted {
  std::mutex mutex;
  std::set<std::pair<Identity, std::string>> files;
};
Noted& noted() {
  static Noted all;
  return all;
}

}  // namespace

bool same_file(const std::string& a, const std::string& b) {
  Identity one, other;
  bool regular = false;
  return identify(a, one, regular) && identify(b, other, regular) && one == other;
}

bool lies_in(const std::string& path, const std::string& folder) {
  Identity wanted, above;
  bool regular = false;
  if (!identify(folder, wanted, regular) || regular) return false;
  std::error_code trouble;
  std::filesystem::path place = std::filesystem::canonical(path, trouble);
  if (trouble) return false;
  while (place.has_relative_path()) {
    place = place.parent_path();
    if (identify(place.string(), above, regular) && above == wanted) return true;
  }
  return false;
}

void note_input(const std::string& path) {
  Identity identity;
  bool regular = false;
  if (!identify(path, identity, regular) || !regular) return;
  std::error_code trouble;
  const auto place = std::filesystem::canonical(path, trouble);
  if (trouble) return;
  const std::lock_guard lock(noted().mutex);
  noted().files.emplace(identity, place.string());
}

Status check_not_input(const std::string& path) {
  Identity identity, now;
  bool regular = false;
  if (!identify(path, identity, regular) || !regular) return fine();
  const std::lock_guard lock(noted().mutex);
  for (auto one = noted().files.lower_bound({identity, ""});
       one != noted().files.end() && one->first == identity; ++one)
    if (identify(one->second, now, regular) && now == identity)
      return error(Trouble::usage,
                   path +
                       ": burr has read this file and does not write over it; choose another "
                       "name");
  return fine();
}

}  // namespace burr::base
