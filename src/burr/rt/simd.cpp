#include "burr/rt/simd.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <string_view>

namespace burr::rt {
namespace {

Simd best() noexcept {
#ifdef __x86_64__
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
      __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512dq") != 0)
    return Simd::avx512;
  return __builtin_cpu_supports("avx2") != 0 ? Simd::avx2 : Simd::scalar;
#else
  return Simd::scalar;
#endif
}

Simd at_start() noexcept {
  const char* request = std::getenv("BURR_SIMD");
  for (const Simd one : {Simd::scalar, Simd::avx2, Simd::avx512})
    if (request != nullptr && std::string_view(request) == name(one)) return std::min(one, best());
  return best();
}

std::atomic<Simd>& chosen() noexcept {
  static std::atomic<Simd> value = at_start();
  return value;
}

}  // namespace

Simd simd() BURR_RT { return chosen().load(std::memory_order_relaxed); }

void force_simd(Simd wanted) noexcept { chosen() = std::min(wanted, best()); }

const char* name(Simd which) noexcept {
  return which == Simd::avx512 ? "avx512" : which == Simd::avx2 ? "avx2" : "scalar";
}

}  // namespace burr::rt
