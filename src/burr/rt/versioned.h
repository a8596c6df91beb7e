// rt/versioned.h - a block of words that one thread rewrites and others read whole: a sequence
// lock.
//
// Guarantee: the writer is wait-free; a reader that met a writer is told so and may try again
// later. The words are relaxed atomics, so that ThreadSanitizer and the C++ memory model agree with
// it (H.-J. Boehm, "Can seqlocks get along with programming language memory models?", MSPC 2012).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "burr/rt/rt.h"

namespace burr::rt {

using Version = std::atomic<std::uint32_t>;  // odd while being written

// The one writer: words [0, count) of `shared` become those of `from`.
inline void versioned_write(Version& version, std::uint64_t* shared, const std::uint64_t* from,
                            std::size_t count) BURR_RT {
  const std::uint32_t before = version.load(std::memory_order_relaxed);
  version.store(before + 1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  for (std::size_t i = 0; i < count; ++i)
    std::atomic_ref<std::uint64_t>(shared[i]).store(from[i], std::memory_order_relaxed);
  version.store(before + 2, std::memory_order_release);
}

// Any reader: false when a writer was at it, `to` is then rubbish; try again.
inline bool versioned_read(const Version& version, const std::uint64_t* shared, std::uint64_t* to,
                           std::size_t count) BURR_RT {
  const std::uint32_t before = version.load(std::memory_order_acquire);
  if ((before & 1U) != 0) return false;
  for (std::size_t i = 0; i < count; ++i) {
    // atomic_ref wants a non-const object; it is only read
    std::atomic_ref<std::uint64_t> word(const_cast<std::uint64_t&>(shared[i]));
    to[i] = word.load(std::memory_order_relaxed);
  }
  std::atomic_thread_fence(std::memory_order_acquire);
  return version.load(std::memory_order_relaxed) == before;
}

}  // namespace burr::rt
