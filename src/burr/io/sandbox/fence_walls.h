// io/sandbox/fence_walls.h - the limits that a reader puts on its own process before it reads the
// first byte of a file: rlimits, Landlock, seccomp. They cannot be taken back. For use of this room
// only.
#pragma once

#include <cstdint>
#include <filesystem>

#include "burr/io/read/read_options.h"

namespace burr::io {

struct FenceLimits {
  std::uint64_t memory = 0;  // address space [byte]
  double seconds = 0;        // of processor time of all threads together
};

// Limits from the size of the file, of the folder, or of what may lie beside a header; or those of
// the options.
[[nodiscard]] FenceLimits fence_limits(const std::filesystem::path& path,
                                       const ReadOptions& options);

// Of a mesh, which has at most kLargestMesh bytes: the same for all.
[[nodiscard]] FenceLimits fence_limits_of_mesh();

// What this computer supports.
[[nodiscard]] int landlock_version();  // 0: not supported
[[nodiscard]] bool seccomp_offered();
#if defined(BURR_SANITIZED)
inline constexpr bool kMemoryLimit = false;  // false with sanitizers, which map terabytes that they
                                             // never touch
#else
inline constexpr bool kMemoryLimit = true;
#endif

// Limits this process as far as the kernel can. Afterwards only `path`, for a header its folder, for
// an ADF the folder of its pictures, can be opened, and only for reading. Call it with one thread, before anything is read. False: the
// kernel supports a limit but could not set it.
[[nodiscard]] bool raise_walls(const std::filesystem::path& path, const FenceLimits& limits);

}  // namespace burr::io
