#include "burr/base/version.h"

namespace burr::base {

const char* version() noexcept { return BURR_VERSION; }

const char* build() noexcept {
#if defined(__clang__)
#define BURR_COMPILER "clang++ " __clang_version__
#else
#define BURR_COMPILER "g++ " __VERSION__
#endif
#if defined(BURR_SANITIZED)
  return BURR_COMPILER ", sanitized";
#elif defined(__OPTIMIZE__)
  return BURR_COMPILER ", optimised";
#else
  return BURR_COMPILER ", not optimised";
#endif
}

}  // namespace burr::base
