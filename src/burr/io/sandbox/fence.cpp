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
    return "scans cannot be read: burr-read is not beside libburr.so; install burr again or name "
           "it in BURR_READ";
  std::string words = "scans are read in a process of their own, with limits of processor time";
  words += state.memory_limit ? " and memory" : " (not of memory: this is a sanitized build)";
  words += state.landlock > 0
               ? fmt::format("; other files are closed to it (Landlock {})", state.landlock)
               : "; this kernel has no Landlock to close other files to it";
  words += state.seccomp ? ", network and programs too (seccomp)"
                         : ", and no seccomp to close network and programs";
  return words;
}

std::string fence_words() { return fence_words(fence_state()); }

}  // namespace burr::io
