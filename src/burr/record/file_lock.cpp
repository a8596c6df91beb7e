#include "burr/record/file_lock.h"

#include <sys/file.h>

#include <cerrno>

namespace burr::record {

FileLock lock(int file) noexcept {
  int result = 0;
  do result = ::flock(file, LOCK_EX | LOCK_NB);
  while (result != 0 && errno == EINTR);
  if (result == 0) return FileLock::taken;
  // whatever else a file system answers: it gives no lock
  return errno == EWOULDBLOCK ? FileLock::of_another : FileLock::none;
}

}  // namespace burr::record
