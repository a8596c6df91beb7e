#include "support/test_places.h"

namespace burr::test {

std::string source_dir() { return BURR_SOURCE_DIR; }
std::string build_dir() { return BURR_BUILD_DIR; }

}  // namespace burr::test
