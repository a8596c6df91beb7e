// rt/reserved.h - a large array whose addresses are reserved at once and whose memory is taken
// ahead of use, page by page.
//
//     ReservedArray<KeptBrick> kept(bricks);  // addresses for all, memory for none
//     kept.commit(2048);                     // the first 2048 now have memory
//     kept[n] = ...                          // the tick; another thread calls commit(n + 2048)
//
// In the worst case the tick needs far more memory than it ever uses in practice. A vector would
// take all of it at the start, and a growing vector would allocate inside the tick. Here the
// addresses never change, and another thread takes the pages before the tick reaches them. If that
// thread is late, the tick waits while the kernel clears a page; nothing else differs.
//
// All bytes are zero at first. If the kernel cannot take pages in advance (Linux before 5.14), all
// pages are taken at construction. Thread: elements as in any array; commit() on one thread at a
// time, which need not be the thread that uses the elements. Errors: std::bad_alloc when the
// addresses (not the memory) are refused.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "burr/rt/rt.h"

namespace burr::rt {

// The untyped part: whole pages.
class ReservedBytes {
 public:
  ReservedBytes() = default;
  explicit ReservedBytes(std::size_t bytes);
  ~ReservedBytes();
  ReservedBytes(const ReservedBytes&) = delete;
  ReservedBytes& operator=(const ReservedBytes&) = delete;

  [[nodiscard]] std::byte* data() const BURR_RT { return data_; }
  void commit(std::size_t bytes);   // [0, bytes) have memory when it returns
  void grow(std::size_t bytes);     // reserves more addresses; the content moves
  void decommit(std::size_t from);  // [from, end) become zero and take no memory
  [[nodiscard]] std::size_t committed() const { return committed_; }

 private:
  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0, committed_ = 0;
};

template <class T>
class ReservedArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  ReservedArray() = default;
  explicit ReservedArray(std::size_t count) : bytes_(count * sizeof(T)), count_(count) {}

  [[nodiscard]] T* data() BURR_RT { return reinterpret_cast<T*>(bytes_.data()); }
  [[nodiscard]] const T* data() const BURR_RT { return reinterpret_cast<const T*>(bytes_.data()); }
  [[nodiscard]] T* begin() BURR_RT { return data(); }
  [[nodiscard]] const T* begin() const BURR_RT { return data(); }
  [[nodiscard]] std::size_t size() const BURR_RT { return count_; }
  [[nodiscard]] bool empty() const BURR_RT { return count_ == 0; }
  [[nodiscard]] T& operator[](std::size_t at) BURR_RT { return data()[at]; }
  [[nodiscard]] const T& operator[](std::size_t at) const BURR_RT { return data()[at]; }

  // When this returns, the first `count` elements (or all, if there are fewer) have memory.
  void commit(std::size_t count) { bytes_.commit((count < count_ ? count : count_) * sizeof(T)); }
  // Before the session only: reserves room for more. Elements move, so pointers to them become
  // invalid.
  void grow(std::size_t count) {
    if (count <= count_) return;
    bytes_.grow(count * sizeof(T));
    count_ = count;
  }
  // Before the session only: the elements from `first` on become zero and take no memory until they
  // are used again.
  void decommit(std::size_t first) { bytes_.decommit(first * sizeof(T)); }

 private:
  ReservedBytes bytes_;
  std::size_t count_ = 0;
};

}  // namespace burr::rt
