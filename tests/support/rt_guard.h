// tests/support/rt_guard.h - counts heap calls and mutex locks on this thread while it exists.
//
//     const test::RtGuard guard;  ...  EXPECT_EQ(guard.allocations(), 0);
//
// In sanitizer builds it counts nothing, because they bring their own malloc.
#pragma once

namespace burr::test {

class RtGuard {
 public:
  RtGuard() noexcept;
  ~RtGuard();
  RtGuard(const RtGuard&) = delete;
  RtGuard& operator=(const RtGuard&) = delete;

  [[nodiscard]] long allocations()
      const noexcept;  // malloc, calloc, realloc, free, aligned_alloc, posix_memalign ...
  [[nodiscard]] long locks() const noexcept;
  [[nodiscard]] static bool watching() noexcept;  // false in sanitizer builds
};

}  // namespace burr::test
