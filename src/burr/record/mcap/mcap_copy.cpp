// A copy of a recording that is still being written (McapWriter::copy_to).
#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <tuple>

#include "burr/base/disk_words.h"
#include "burr/base/plain_file.h"
#include "burr/record/mcap/mcap_writer.h"

namespace burr::record {
namespace {

Error trouble(const std::string& shown, const char* doing) {
  return error(Trouble::io,
               fmt::format("{}: cannot {}: {}", shown, doing, base::disk_trouble(errno)));
}

}  // namespace

Status McapWriter::copy_bytes_to(int file) const {
  std::vector<std::uint8_t> some(std::size_t{1} << 16);
  for (std::uint64_t at = 0; at < size_;) {
    const auto some_more =
        static_cast<std::size_t>(std::min<std::uint64_t>(some.size(), size_ - at));
    const ssize_t read = ::pread(file_, some.data(), some_more, static_cast<off_t>(at));
    if (read < 0 && errno == EINTR) continue;
    if (read < 0) return trouble(shown_, "be read back");
    if (read == 0)
      return error(Trouble::io,
                   shown_ + ": was shortened by another program while it was being recorded");
    for (ssize_t done = 0; done < read;) {
      const ssize_t n = ::write(file, some.data() + done, static_cast<std::size_t>(read - done));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return trouble(shown_, "be copied");
      done += n;
    }
    at += static_cast<std::uint64_t>(read);
  }
  return fine();
}

Status McapWriter::copy_to(const std::string& path, const std::string& shown) {
  if (Status plain = base::check_plain_file(path, shown); !plain) return plain;
  // for this user alone, as the recording itself
  const int copy = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (copy < 0) return trouble(shown, "be written");
  Status done = copy_bytes_to(copy);
  if (done.ok()) {  // for so long this is the writer of the copy; what it knows of the file is true of both
    const auto mine = std::tuple(file_, shown_, failed_, indexed_, size_, crc_, message_counts_);
    file_ = copy;
    shown_ = shown;
    done = append_end();
    std::tie(file_, shown_, failed_, indexed_, size_, crc_, message_counts_) = mine;
  }
  if (::close(copy) != 0 && done.ok()) done = trouble(shown, "be closed");
  if (!done.ok()) ::unlink(path.c_str());
  return done;
}

}  // namespace burr::record
