#include "burr/base/disk_words.h"

#include <cerrno>
#include <cstring>
#include <utility>

namespace burr::base {
namespace {

constexpr const char* kFull = "free some space or choose another disk";
constexpr const char* kForbidden = "choose a folder that you may write to";
constexpr const char* kGone =
    "the disk or its server is gone; connect it again or choose another disk";
constexpr const char* kBusy = "another program uses it; end that program or choose another name";
constexpr const char* kCannot = "this file system cannot do that; choose another disk";

constexpr std::pair<int, const char*> kRemedies[] = {
    {ENOSPC, kFull},
    {EDQUOT, kFull},
    {EACCES, kForbidden},
    {EPERM, kForbidden},
    {EROFS, kForbidden},
    {EFBIG, "raise the limit on file size (ulimit -f), or choose a disk that takes larger files"},
    {EIO, "the disk is faulty or was taken away; choose another disk"},
    {ENOENT, "create the folder first"},
    {ENOTDIR, "create the folder first"},
    {EISDIR, "give the name of a file"},
    {ENAMETOOLONG, "choose a shorter name"},
    {ELOOP, "choose a name that is no link"},
    {EMFILE, "close what is open, or raise the limit on open files (ulimit -n)"},
    {ENFILE, "end other programs"},
    {ENOMEM, "end other programs"},
    {ENOBUFS, "end other programs"},
    {EBUSY, kBusy},
    {ETXTBSY, kBusy},
    {ENODEV, kGone},
    {ENXIO, kGone},
    {ESTALE, kGone},
    {ENOTCONN, kGone},
    {ETIMEDOUT, kGone},
    {EHOSTDOWN, kGone},
    {EHOSTUNREACH, kGone},
    {EREMOTEIO, kGone},
    {EINVAL, kCannot},
    {ENOSYS, kCannot},
    {EOPNOTSUPP, kCannot},
};

}  // namespace

std::string disk_trouble(int number) {
  std::string words = std::strerror(number);
  for (const auto& [known, remedy] : kRemedies)
    if (known == number) return words + "; " + remedy;
  return words;
}

bool not_offered(int number) noexcept {
  return number == ENOLCK || number == ENOSYS || number == EOPNOTSUPP || number == EINVAL;
}

}  // namespace burr::base
