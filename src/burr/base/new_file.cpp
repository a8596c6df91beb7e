#include "burr/base/new_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "burr/base/inputs.h"
#include "burr/base/plain_file.h"

namespace burr::base {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 20;

std::string reason(int number) {
  switch (number) {
    case ENOSPC:
    case EDQUOT:
      return "the disk is full; free some space or choose another folder";
    case EACCES:
    case EPERM:
    case EROFS:
      return "no permission to write in this folder; choose another folder";
    case ENOENT:
    case ENOTDIR:
      return "the folder does not exist; create it first";
    default:
      return std::strerror(number);
  }
}

// Writes everything; returns 0 or errno.
int write_all(int file, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t done = ::write(file, data, size);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return errno;
    data += done;
    size -= static_cast<std::size_t>(done);
  }
  return 0;
}

}  // namespace

Result<NewFile> NewFile::create(const std::string& path, unsigned mode) {
  // follow a link, so that it stays a link
  std::error_code ignored;
  std::filesystem::path place = path;
  if (std::filesystem::is_symlink(place, ignored))
    place = std::filesystem::weakly_canonical(place, ignored);
  if (path.empty())
    return error(Trouble::io, "the name of the file to write is empty; give a name");
  if (const Status plain = check_plain_file(place.string(), path); !plain) return plain.error();
  if (const Status allowed = check_not_input(place.string()); !allowed) return allowed.error();

  // a name that no one else uses: a crashed run may have left a file with our process number
  static std::atomic<unsigned> count = 0;
  std::string name;
  int file = -1;
  for (int attempt = 0; attempt < 100 && file < 0; ++attempt) {
    name = place.string() + ".part-" + std::to_string(::getpid()) + "-" + std::to_string(++count);
    file = ::open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, mode);
    if (file < 0 && errno != EEXIST) break;
  }
  if (file < 0) return error(Trouble::io, path + ": cannot be created: " + reason(errno));
  return NewFile(place.string(), name, file);
}

NewFile::NewFile(std::string place, std::string beside, int file)
    : place_(std::move(place)), beside_(std::move(beside)), file_(file) {
  buffer_.reserve(kBuffer);
}

NewFile::NewFile(NewFile&& other) noexcept
    : place_(std::move(other.place_)),
      beside_(std::move(other.beside_)),
      file_(std::exchange(other.file_, -1)),
      trouble_(other.trouble_),
      size_(other.size_),
      buffer_(std::move(other.buffer_)) {}

NewFile::~NewFile() {
  if (file_ < 0) return;
  ::close(file_);
  ::unlink(beside_.c_str());
}

void NewFile::flush() {
  if (trouble_ == 0) trouble_ = write_all(file_, buffer_.data(), buffer_.size());
  size_ += buffer_.size();
  buffer_.clear();
}

void NewFile::write(const void* data, std::size_t size) {
  BURR_CHECK(file_ >= 0);
  if (buffer_.size() + size > kBuffer) flush();
  const char* bytes = static_cast<const char*>(data);
  if (size > kBuffer) {
    if (trouble_ == 0) trouble_ = write_all(file_, bytes, size);
    size_ += size;
    return;
  }
  buffer_.insert(buffer_.end(), bytes, bytes + size);
}

void NewFile::write_at(std::size_t offset, const void* data, std::size_t size) {
  BURR_CHECK(file_ >= 0);
  flush();
  BURR_CHECK(offset + size <= size_);
  if (trouble_ != 0) return;
  const ssize_t done = ::pwrite(file_, data, size, static_cast<off_t>(offset));
  if (done != static_cast<ssize_t>(size)) trouble_ = done < 0 ? errno : EIO;
}

Error NewFile::failed(const char* doing) const {
  return error(Trouble::io, place_ + ": cannot be " + doing + ": " + reason(trouble_));
}

Status NewFile::put_in_place() {
  BURR_CHECK(file_ >= 0);
  flush();
  // some file systems report only now that the disk is full
  if (trouble_ == 0 && ::fsync(file_) != 0 && errno != EINVAL) trouble_ = errno;
  if (trouble_ != 0) return failed("written");
  if (::rename(beside_.c_str(), place_.c_str()) != 0) {
    trouble_ = errno;
    return failed("renamed to its final name");
  }
  ::close(std::exchange(file_, -1));
  return fine();
}

}  // namespace burr::base
