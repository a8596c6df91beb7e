// web/gaps/std_gaps.h - what the C++ library of Debian's emscripten (libc++ 13) lacks of C++20 and burr's
// rooms use. Given to the compiler by -include, for the page only.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <string>
#include <type_traits>
#include <utility>

namespace std {

#ifndef __cpp_lib_bit_cast
template <class To, class From>
requires(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> &&
         is_trivially_copyable_v<From>) constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}
#endif

// of a number with a point, in the C locale: a module has no other
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const string text(first, last);
  char* end = nullptr;
  const double read = strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  value = read;
  return {first + (end - text.c_str()), errc()};
}

#ifndef __cpp_lib_ranges
inline namespace _LIBCPP_ABI_NAMESPACE {
namespace ranges {
struct burr_same {
  template <class T>
  constexpr T&& operator()(T&& one) const noexcept {
    return std::forward<T>(one);
  }
};
template <class Range, class Value, class Less = std::less<>, class Of = burr_same>
auto lower_bound(Range&& range, const Value& value, Less smaller = {}, Of of = {}) {
  return std::lower_bound(
      std::begin(range), std::end(range), value,
      [&](const auto& one, const Value& v) { return smaller(std::invoke(of, one), v); });
}
}  // namespace ranges
}  // namespace _LIBCPP_ABI_NAMESPACE
#endif

}  // namespace std
