// base/handle.h - an open file descriptor, closed by its owner.
//
// Thread: one at a time.
#pragma once

#include <utility>

namespace burr::base {

// Its number is never below 10: those are free for what a helper is started with.
class Handle {
 public:
  Handle() = default;
  explicit Handle(int number);
  Handle(Handle&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { reset(); }
  void reset();
  [[nodiscard]] int get() const { return number_; }
  [[nodiscard]] bool open() const { return number_ >= 0; }

 private:
  int number_ = -1;
};

}  // namespace burr::base
