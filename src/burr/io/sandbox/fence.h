// io/sandbox/fence.h - the fence around reading: what parses a scan runs in a process of its own
// (`burr-read`), so that a damaged or hostile file can end that process and nothing else.
//
//   always      memory, processor time, number of open files and (none at all) of written bytes are
//               limited; a reader that stands still is ended; if the caller dies, the reader dies
//   Landlock    files outside the given file or folder cannot be opened, nothing can be written
//   seccomp     no network, no other program, no other process, no opening for writing
//
// The last two where the kernel has them. io::read_scan goes through the fence by itself; this
// header only tells how high it is here. Where `burr-read` is looked for: the environment variable
// BURR_READ, then beside libburr.so, then in libexec/burr of the same installation.
// Thread: any.
#pragma once

#include <string>

namespace burr::io {

struct FenceState {
  std::string reader;         // path of burr-read; empty: not found, and no scan can be read
  int landlock = 0;           // version of the kernel's interface; 0: it has none
  bool seccomp = false;       // system calls can be filtered
  bool memory_limit = false;  // false in builds with AddressSanitizer, which maps terabytes
};

[[nodiscard]] FenceState fence_state();

// The same as one sentence, for people.
[[nodiscard]] std::string fence_words(const FenceState& state);
[[nodiscard]] std::string fence_words();

}  // namespace burr::io
