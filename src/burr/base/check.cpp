#include "burr/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace burr::base {

void check_failed(const char* what, const char* file, int line) noexcept {
  std::fprintf(stderr, "burr: internal error: %s is false (%s:%d); please report it\n", what, file,
               line);
  std::abort();
}

}  // namespace burr::base
