// tests/support/test_places.h - where the checkout and the build lie.
//
// One source alone is compiled with these paths (test_places.cpp). All others are the same in every folder, so a compiler's
// cache finds them again.
#pragma once

#include <string>

namespace burr::test {

// Absolute paths without a slash at the end. Any thread; also before main().
std::string source_dir();
std::string build_dir();  // of the kind of build that runs: .../build/release

}  // namespace burr::test
