#include "burr/io/fence.h"

#include <dlfcn.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "burr/io/fence_walls.h"

#if !defined(BURR_LIBEXEC_FROM_LIB)
#define BURR_LIBEXEC_FROM_LIB "../libexec/burr"
#endif

namespace burr::io {
namespace {

// beside the library (a build tree), or where an installation has its helpers
std::string find_reader() {
  if (const char* named = std::getenv("BURR_READ"); named != nullptr && *named != '\0')
    return ::access(named, X_OK) == 0 ? named : "";
  Dl_info here{};
  if (::dladdr(reinterpret_cast<const void*>(&find_reader), &here) == 0) return {};
  std::error_code trouble;
  auto library = std::filesystem::canonical(here.dli_fname, trouble);
  if (trouble) return {};
  for (const char* place : {"burr-read", BURR_LIBEXEC_FROM_LIB "/burr-read"}) {
    const std::string reader = (library.parent_path() / place).lexically_normal().string();
    if (::access(reader.c_str(), X_OK) == 0) return reader;
  }
  return {};
}

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
