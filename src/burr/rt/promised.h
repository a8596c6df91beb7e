// rt/promised.h - a long array whose room is promised at once and taken from the system ahead of
// its use, page by page.
//
//     Promised<KeptBrick> kept(bricks);  // addresses for all, memory for none
//     kept.have(2048);                       // the first 2048 are there now
//     kept[n] = ...                          // the tick; meanwhile a helper calls have(n + 2048)
//
// What the tick might need in the worst case is far more than what it ever uses. A vector would
// take all of it; growing one would allocate in the tick. Here the addresses never change, and a
// helper thread takes the pages before the tick comes to them. Should the helper be late, the tick
// waits for the kernel to clear a page; nothing else is different.
//
// Bytes are zero at first. Where the kernel cannot take pages ahead (Linux before 5.14) all of them
// are taken at construction. Thread: elements as in any array; have() on one thread at a time,
// which may be another than the one that uses the elements. Errors: std::bad_alloc when the
// addresses, not the memory, are refused.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "burr/rt/rt.h"

namespace burr::rt {

// Untyped, whole pages.
class PromisedBytes {
 public:
  PromisedBytes() = default;
  explicit PromisedBytes(std::size_t bytes);
  ~PromisedBytes();
  PromisedBytes(const PromisedBytes&) = delete;
  PromisedBytes& operator=(const PromisedBytes&) = delete;

  [[nodiscard]] std::byte* data() const BURR_RT { return data_; }
  void have(std::size_t bytes);      // [0, bytes) are there
  void grow(std::size_t bytes);      // more addresses; what is there moves
  void give_back(std::size_t from);  // [from, end) are zero again and take no memory
  [[nodiscard]] std::size_t had() const { return had_; }

 private:
  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0, had_ = 0;
};

template <class T>
class Promised {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  Promised() = default;
  explicit Promised(std::size_t count) : bytes_(count * sizeof(T)), count_(count) {}

  [[nodiscard]] T* data() BURR_RT { return reinterpret_cast<T*>(bytes_.data()); }
  [[nodiscard]] const T* data() const BURR_RT { return reinterpret_cast<const T*>(bytes_.data()); }
  [[nodiscard]] T* begin() BURR_RT { return data(); }
  [[nodiscard]] const T* begin() const BURR_RT { return data(); }
  [[nodiscard]] std::size_t size() const BURR_RT { return count_; }
  [[nodiscard]] bool empty() const BURR_RT { return count_ == 0; }
  [[nodiscard]] T& operator[](std::size_t at) BURR_RT { return data()[at]; }
  [[nodiscard]] const T& operator[](std::size_t at) const BURR_RT { return data()[at]; }

  // The first `count` elements (all, if there are fewer) are in memory when this returns.
  void have(std::size_t count) { bytes_.have((count < count_ ? count : count_) * sizeof(T)); }
  // Before the session: room for more; elements move, pointers to them end.
  void grow(std::size_t count) {
    if (count <= count_) return;
    bytes_.grow(count * sizeof(T));
    count_ = count;
  }
  // Before the session: the elements from `first` on are zero and take no memory until used again.
  void give_back(std::size_t first) { bytes_.give_back(first * sizeof(T)); }

 private:
  PromisedBytes bytes_;
  std::size_t count_ = 0;
};

}  // namespace burr::rt
