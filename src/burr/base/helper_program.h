// base/helper_program.h - a program of ours that does a part of the work in a process of its own.
//
//     const std::string reader = helper_program("burr-read", "BURR_READ");
//
// Thread: any.
#pragma once

#include <string>

namespace burr::base {

// Its path: where the environment variable says, else beside the library (a build tree), else where
// an installation has its helpers; empty: nowhere.
[[nodiscard]] std::string helper_program(const char* name, const char* variable);

}  // namespace burr::base
