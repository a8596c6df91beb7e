// tests/support/data.h - the shared test data: where it is, and what to do when it is missing.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/test_places.h"

namespace burr::test {

// ../shared/data beside the checkout
inline std::filesystem::path data_dir() {
  return std::filesystem::path(test::source_dir()).parent_path() / "shared" / "data";
}
inline bool data_required() {
  const char* required = std::getenv("BURR_REQUIRE_DATA");
  return required != nullptr && std::string(required) == "1";
}

}  // namespace burr::test

// First line of a test that needs a file of the shared data: skips without it, and fails where CI
// requires it.
#define BURR_NEEDS_DATA(relative)                                                               \
  do {                                                                                          \
    if (!std::filesystem::exists(burr::test::data_dir() / (relative))) {                        \
      ASSERT_FALSE(burr::test::data_required()) << "BURR_REQUIRE_DATA=1 but no " << (relative); \
      GTEST_SKIP() << "needs ../shared/data/" << (relative) << ", which is not here";           \
    }                                                                                           \
  } while (false)
