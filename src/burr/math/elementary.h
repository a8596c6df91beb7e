// math/elementary.h - exp, sin, cos, atan2 and hypot with the same bits on every processor.
//
// The last bit of a C library's functions is not defined. It differs between libraries (glibc, musl) and also on one
// computer: glibc takes other code on a processor with fused multiply-add than on one without, so a recording would not
// replay to the bit on the other one. Whatever the tick's result depends on uses these functions. They need nothing
// but additions, products, quotients and roots in a fixed order (-ffp-contract=off), which IEEE 754 defines to the
// last bit.
//
// Accuracy: within 0.51 units in the last place of the true value for exp, and 0.52 for the others, so nearly
// always the number that is nearest (tests/math/elementary_test.cpp compares with a wider format). Method: a table for
// the greater part of the argument, in two doubles, and a short series for the rest (P. T. P. Tang, Table-Driven Implementation of the
// Exponential Function in IEEE Floating-Point Arithmetic, ACM TOMS 15, 1989); sums and products of two doubles after
// T. J. Dekker, A Floating-Point Technique for Extending the Available Precision, Numer. Math. 18, 1971.
//
// Thread-safe; no allocation, no lock, no exception, no errno. A NaN gives a NaN.
#pragma once

namespace burr::math {

// e^x; 0 below -745.2, infinite above 709.8.
[[nodiscard]] double exponential(double x) noexcept;
// e^x - 1, without loss for small x.
[[nodiscard]] double exponential_minus_one(double x) noexcept;

// x in radians, within 50 000 of zero; a number further out is brought near by whole turns of the double nearest to 2 pi.
[[nodiscard]] double sine(double x) noexcept;
[[nodiscard]] double cosine(double x) noexcept;

// The angle of (x, y) against the x axis, in (-pi, pi]; zero for (0, 0). [rad]
[[nodiscard]] double angle_of(double y, double x) noexcept;
[[nodiscard]] inline double arctangent(double slope) noexcept { return angle_of(slope, 1); }

// sqrt(x^2 + y^2), for numbers whose squares are neither infinite nor lost.
[[nodiscard]] double hypotenuse(double x, double y) noexcept;

}  // namespace burr::math
