// base/check.h - a programming error prints where it happened and aborts the program at once.
#pragma once

namespace burr::base {
[[noreturn]] void check_failed(const char* what, const char* file, int line) noexcept;
}

// Active in release builds too, so use it for cheap conditions only. Inside the tick: check
// preconditions only, never data.
#define BURR_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::burr::base::check_failed(#condition, __FILE__, __LINE__))
