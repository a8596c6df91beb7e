// base/helper_program.h - finds a program of burr that does part of the work in a separate process.
//
//     const std::string reader = helper_program("burr-read", "BURR_READ");
//
// Thread: any.
#pragma once

#include <string>

namespace burr::base {

// The path of the program `name`. If the environment variable `variable` is set, only that path is
// tried. Otherwise: the folder of the library (a build tree), then the libexec folder of the
// installation. Empty: no program that can be run was found.
[[nodiscard]] std::string helper_program(const char* name, const char* variable);

}  // namespace burr::base
