// record/file_lock.h - a lock on an open file, which ends with its process. Some file systems have none:
// NFS without its lock service, Lustre mounted without them, some that a program offers.
//
// Thread: any.
#pragma once

namespace burr::record {

enum class FileLock {
  taken,
  of_another,  // another process, or another opening of the file, has it
  none,        // the file system has no locks
};

// Does not wait. file: open.
[[nodiscard]] FileLock lock(int file) noexcept;

}  // namespace burr::record
