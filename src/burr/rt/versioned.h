// rt/versioned.h - a block of words that one thread writes and other threads copy as a whole: a
// sequence lock.
//
// Guarantee: the writer is wait-free. A reader that overlapped a write gets false and may try again
// later. The words are relaxed atomics, so that the code is correct in the C++ memory model and for
// ThreadSanitizer (H.-J. Boehm, "Can seqlocks get along with programming language memory models?",
// MSPC 2012).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "burr/rt/atoms.h"
#include "burr/rt/rt.h"

namespace burr::rt {

template <class Atoms>
using VersionOf = typename Atoms::template Atomic<std::uint32_t>;  // odd during a write
using Version = VersionOf<StdAtoms>;

// Writer (only one): copies words [0, count) of `from` to `shared`.
template <class Atoms = StdAtoms>
void versioned_write(VersionOf<Atoms>& version, std::uint64_t* shared, const std::uint64_t* from,
                     std::size_t count) BURR_RT {
  const std::uint32_t before = version.load(std::memory_order_relaxed);
  version.store(before + 1, std::memory_order_relaxed);
  Atoms::fence(std::memory_order_release);
  for (std::size_t i = 0; i < count; ++i) Atoms::store(shared[i], from[i]);
  version.store(before + 2, std::memory_order_release);
}

// Reader: calls copy(), which reads the words that it needs with Atoms::load. False: a write
// overlapped, so what was copied is invalid; try again.
template <class Atoms = StdAtoms, class Copy>
bool versioned_read(const VersionOf<Atoms>& version, const Copy& copy) BURR_RT {
  const std::uint32_t before = version.load(std::memory_order_acquire);
  if ((before & 1U) != 0) return false;
  copy();
  Atoms::fence(std::memory_order_acquire);
  return version.load(std::memory_order_relaxed) == before;
}

// The same for all words [0, count).
template <class Atoms = StdAtoms>
bool versioned_read(const VersionOf<Atoms>& version, const std::uint64_t* shared, std::uint64_t* to,
                    std::size_t count) BURR_RT {
  return versioned_read<Atoms>(version, [&] {
    for (std::size_t i = 0; i < count; ++i) to[i] = Atoms::load(shared[i]);
  });
}

}  // namespace burr::rt
