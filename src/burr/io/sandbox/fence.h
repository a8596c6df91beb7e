// io/sandbox/fence.h - the fence around reading: a scan is parsed in a separate process
// (`burr-read`), so that a damaged or hostile file can end that process and nothing else.
//
//   always    limits on memory, processor time, open files and written bytes (none at all); a
//             reader without progress is ended; if the caller dies, the reader dies
//   Landlock  no file outside the given file or folder can be opened, nothing can be written
//   seccomp   no network, no other program, no other process, no opening for writing
//
// The last two only where the kernel supports them. io::read_scan uses the fence by itself; this
// header only says how complete it is on this computer. burr-read is looked for in the environment
// variable BURR_READ, then beside libburr.so, then in libexec/burr of the same installation.
// Thread: any.
#pragma once

#include <string>

namespace burr::io {

struct FenceState {
  std::string reader;         // path of burr-read; empty: not found, no scan can be read
  int landlock = 0;           // version of the kernel's interface; 0: not supported
  bool seccomp = false;       // system calls can be filtered
  bool memory_limit = false;  // false in builds with AddressSanitizer, which maps terabytes
};

[[nodiscard]] FenceState fence_state();

// The state as one sentence for the user.
[[nodiscard]] std::string fence_words(const FenceState& state);
[[nodiscard]] std::string fence_words();

}  // namespace burr::io
