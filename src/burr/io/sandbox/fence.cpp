#include "burr/io/sandbox/fence.h"

#include <fmt/core.h>

#include "burr/base/helper_program.h"
#include "burr/io/sandbox/fence_walls.h"

namespace burr::io {
namespace {

std::string find_reader() { return base::helper_program("burr-read", "BURR_READ"); }

}  // namespace

FenceState fence_state() {
  return {find_reader(), landlock_version(), seccomp_offered(), kMemoryLimit};
}

std::string fence_words(const FenceState& state) {
  if (state.reader.empty())
    return "scans cannot be read: burr-read is not beside libburr.so; install burr again or give "
           "its path in BURR_READ";
  std::string words = "scans are read in a separate process with limits on processor time";
  words +=
      state.memory_limit ? " and memory" : " (not on memory, because this is a sanitized build)";
  words += state.landlock > 0
               ? fmt::format("; it can open no other files (Landlock {})", state.landlock)
               : "; it can open other files, because this kernel has no Landlock";
  words +=
      state.seccomp
          ? ", and can neither use the network nor start programs (seccomp)"
          : ", and it can use the network and start programs, because this kernel has no seccomp";
  return words;
}

std::string fence_words() { return fence_words(fence_state()); }

}  // namespace burr::io
