// rt/simd.h - which instruction set the kernels use. Results are the same bits on all of them; only
// the time differs.
//
// Thread: simd() from any; force_simd() only before a session, by tests and benchmarks.
#pragma once

#include "burr/rt/rt.h"

namespace burr::rt {

// Only for x86-64 are the kernels compiled more than once (cmake/library.cmake); for others
// Simd::scalar is all there is.
#ifdef __x86_64__
inline constexpr bool kWideKernels = true;
#else
inline constexpr bool kWideKernels = false;
#endif

enum class Simd { scalar = 0, avx2 = 1, avx512 = 2 };

// The best set of this processor, or the forced one (environment variable
// BURR_SIMD=scalar|avx2|avx512, read once).
[[nodiscard]] Simd simd() BURR_RT;

// Uses `wanted`, but never more than the processor has.
void force_simd(Simd wanted) noexcept;

[[nodiscard]] const char* name(Simd which) noexcept;

}  // namespace burr::rt
