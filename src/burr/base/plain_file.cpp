#include "burr/base/plain_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "burr/base/printable.h"

namespace burr::base {
namespace {

constexpr std::size_t kLongestPath = 1024;

std::string name_of(const std::string& path, const std::string& shown) {
  return printable(shown.empty() ? path : shown, kLongestPath);
}

}  // namespace

std::string no_plain_file(mode_t mode) {
  const char* what = S_ISREG(mode)    ? nullptr
                     : S_ISFIFO(mode) ? "a pipe"
                     : S_ISSOCK(mode) ? "a socket"
                     : S_ISDIR(mode)  ? "a folder"
                                      : "a device";
  if (what == nullptr) return {};
  return std::string("is ") + what + ", not a file; give the name of a file";
}

Status check_plain_file(const std::string& path, const std::string& shown) {
  struct stat facts = {};
  if (path.empty() || ::stat(path.c_str(), &facts) != 0) return fine();
  const std::string wrong = no_plain_file(facts.st_mode);
  if (wrong.empty()) return fine();
  return error(Trouble::io, name_of(path, shown) + ": " + wrong);
}

Result<Handle> open_plain_file(const std::string& path, const std::string& shown) {
  // before opening: merely opening a device can have an effect
  if (const Status plain = check_plain_file(path, shown); !plain) return plain.error();
  // O_NONBLOCK: if it has become a pipe since, opening does not wait for a writer
  Handle file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct stat facts = {};
  if (!file.open() || ::fstat(file.get(), &facts) != 0)
    return error(Trouble::io, name_of(path, shown) + ": cannot be read: " + std::strerror(errno));
  if (const std::string wrong = no_plain_file(facts.st_mode); !wrong.empty())
    return error(Trouble::io, name_of(path, shown) + ": " + wrong);
  return file;
}

Result<std::string> bytes_of(const Handle& file, std::size_t most, const std::string& shown) {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  std::string bytes;
  while (bytes.size() < most) {
    const std::size_t have = bytes.size(), part = std::min(kBlock, most - have);
    bytes.resize(have + part);
    const ssize_t got = ::read(file.get(), bytes.data() + have, part);
    const int reason = errno;
    bytes.resize(have + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got < 0 && reason == EINTR) continue;
    if (got < 0)
      return error(Trouble::io,
                   printable(shown, kLongestPath) + ": cannot be read: " + std::strerror(reason));
    if (got == 0) break;
  }
  return bytes;
}

}  // namespace burr::base
