// base/check.h - a mistake of ours is loud and early: prints where, and aborts.
#pragma once

namespace burr::base {
[[noreturn]] void check_failed(const char* what, const char* file, int line) noexcept;
}

// Stays on in release builds; cheap conditions only. In the tick: preconditions only, never on
// data.
#define BURR_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::burr::base::check_failed(#condition, __FILE__, __LINE__))
