// io/sandbox/fence_walls.h - the walls a reader puts around itself before it looks at the first byte of a
// file: limits of the system, Landlock, seccomp. There is no way back. A header of this room only.
#pragma once

#include <cstdint>
#include <filesystem>

#include "burr/io/read/read_scan.h"

namespace burr::io {

struct FenceLimits {
  std::uint64_t memory = 0;  // address space  [byte]
  double seconds = 0;        // of processor time of all threads together
};

// By how large the file, the folder, or what may lie beside a header is; or as the options say.
[[nodiscard]] FenceLimits fence_limits(const std::filesystem::path& path,
                                       const ReadOptions& options);

// What this computer offers.
[[nodiscard]] int landlock_version();  // 0: none
[[nodiscard]] bool seccomp_offered();
#if defined(BURR_SANITIZED)
inline constexpr bool kMemoryLimit = false;  // sanitizers map terabytes they never touch
#else
inline constexpr bool kMemoryLimit = true;
#endif

// Closes this process up, as far as the kernel can: after it only `path`, or for a header its
// folder, can be opened, and only for reading. Call with one thread, before anything is read.
// False: a wall that the kernel offers could not be put up.
[[nodiscard]] bool raise_walls(const std::filesystem::path& path, const FenceLimits& limits);

}  // namespace burr::io
