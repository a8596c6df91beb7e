#include "commands/shell_limits.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/resource.h>

#include <algorithm>
#include <utility>

namespace burr::app {
namespace {

constexpr rlim_t kKiB = 1024;
// Least: with half of it, commands crash or fail. Good: below it, the limit is raised if possible.
// Usual: what systems give.
constexpr rlim_t kLeastStack = 512 * kKiB, kGoodStack = 1024 * kKiB, kUsualStack = 8192 * kKiB;
constexpr rlim_t kLeastFiles = 32, kGoodFiles = 256, kUsualFiles = 1024;

// Returns the limit that holds now.
template <class Resource>  // whatever type the C library gives these names
rlim_t raise(Resource what, rlim_t good, rlim_t usual) {
  rlimit limit = {};
  if (::getrlimit(what, &limit) != 0 || limit.rlim_cur >= good) return usual;
  limit.rlim_cur = std::min(usual, limit.rlim_max);
  if (limit.rlim_cur < good) {  // with the right to do so, above the hard limit
    const rlimit higher = {usual, usual};
    if (::setrlimit(what, &higher) == 0) return usual;
  }
  static_cast<void>(::setrlimit(what, &limit));
  static_cast<void>(::getrlimit(what, &limit));
  return limit.rlim_cur;
}

}  // namespace

Status raise_limits() {
  const rlim_t stack = raise(RLIMIT_STACK, kGoodStack, kUsualStack);
  if (stack < kLeastStack)
    return error(
        fmt::format("the limit on the stack is {} KiB (ulimit -s), and burr needs {} KiB: "
                    "raise it with `ulimit -s {}`, in a new shell if it is refused",
                    stack / kKiB, kLeastStack / kKiB, kUsualStack / kKiB));
  // the C library took the stack of a thread from the limit before main() began
  pthread_attr_t usual;
  std::size_t size = 0;
  if (::pthread_getattr_default_np(&usual) == 0) {
    if (::pthread_attr_getstacksize(&usual, &size) == 0 && size < kGoodStack &&
        ::pthread_attr_setstacksize(&usual, kUsualStack) == 0)
      static_cast<void>(::pthread_setattr_default_np(&usual));
    ::pthread_attr_destroy(&usual);
  }
  const rlim_t files = raise(RLIMIT_NOFILE, kGoodFiles, kUsualFiles);
  if (files < kLeastFiles)
    return error(Trouble::io,
                 fmt::format("the limit on open files is {} (ulimit -n), and burr needs {}: raise "
                             "it with `ulimit -n {}`, in a new shell if it is refused",
                             files, kLeastFiles, kUsualFiles));
  return fine();
}

}  // namespace burr::app
