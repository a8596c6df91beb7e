// rt/simd.h - which instruction set the kernels use. The bits are the same on all of them; only the
// time differs.
//
// Thread: read anywhere; force() only before a session, by tests and benches.
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

// The best this processor has, or what was forced (environment BURR_SIMD=scalar|avx2|avx512, read
// once).
[[nodiscard]] Simd simd() BURR_RT;

// Never above what the processor has.
void force_simd(Simd wanted) noexcept;

[[nodiscard]] const char* name(Simd which) noexcept;

}  // namespace burr::rt
