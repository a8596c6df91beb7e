#include "burr/record/rename_and_sync.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "burr/base/disk_words.h"
#include "burr/record/file_lock.h"

namespace burr::record {

Status rename_and_sync(const std::string& beside, const std::string& path) {
  if (std::rename(beside.c_str(), path.c_str()) != 0)
    return error(Trouble::io, path + ": cannot take this name: " + base::disk_trouble(errno));
  std::string folder = std::filesystem::path(path).parent_path().string();
  if (folder.empty()) folder = ".";
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file >= 0) {
    // not every file system supports this; the file itself is safe either way
    static_cast<void>(::fsync(file));
    ::close(file);
  }
  return fine();
}

bool being_written(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool locked = lock(file) == FileLock::of_another;
  ::close(file);
  return locked;
}

}  // namespace burr::record
