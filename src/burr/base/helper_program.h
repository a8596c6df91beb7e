// base/helper_program.h - finds and starts a program of burr that does part of the work in a separate process.
//
//     const std::string reader = helper_program("burr-read", "BURR_READ");
//     pid_t child = -1;
//     const int reason = start_helper(reader, "burr-read", {{socket, 3}, {kNothing, STDOUT_FILENO}}, child);
//
// Thread: any.
#pragma once

#include <sys/types.h>

#include <initializer_list>
#include <string>

namespace burr::base {

// The path of the program `name`. If the environment variable `variable` is set, only that path is
// tried. Otherwise: the folder of the library (a build tree), then the libexec folder of the
// installation. Empty: no program that can be run was found.
[[nodiscard]] std::string helper_program(const char* name, const char* variable);

// A descriptor of the helper: `here` of this process, or kNothing for /dev/null, becomes `there`.
struct Passed {
  int here, there;
};
inline constexpr int kNothing = -1;

// Starts it, without arguments and with all signals as at the start of a program. The descriptors are made in the order of
// the list. Returns 0 and sets child, or returns the reason as errno has it.
[[nodiscard]] int start_helper(const std::string& program, const char* name,
                               std::initializer_list<Passed> passed, pid_t& child);

}  // namespace burr::base
