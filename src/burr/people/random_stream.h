// people/random_stream.h - random numbers that are the same on every machine. The n-th number
// depends only on seed, stream and n, so an interrupted experiment can be continued as if it had
// not stopped.
//
// Thread: one. Memory: none.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "burr/base/hash.h"

namespace burr::people {

class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed, std::uint64_t stream = 0)
      : seed_(base::mix(base::mix(std::uint64_t{0x70656f706c65}, seed), stream)) {}

  // 0 <= u < 1
  double uniform() { return static_cast<double>(base::mix(seed_, count_++) >> 11) * 0x1p-53; }
  // mean 0, variance 1 (Box and Muller 1958)
  double normal() {
    const double a = 1 - uniform(), b = uniform();
    return std::sqrt(-2 * std::log(a)) * std::cos(2 * std::numbers::pi * b);
  }
  // 0 .. below - 1
  int below(int below) { return static_cast<int>(uniform() * below); }

 private:
  std::uint64_t seed_, count_ = 0;
};

}  // namespace burr::people
