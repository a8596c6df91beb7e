// tool/shape_lanes.h - what shape_formulas.h computes with in kernels: sixteen places at a time.
//
// Internal linkage, as in rt/lanes.h.
#pragma once

#include "burr/rt/lanes.h"

namespace burr::tool {
namespace {

struct SixteenNumbers {
  using Number = rt::lanes::Floats;
  using Real = float;
  using Whole = rt::lanes::Ints;
  static void square_root(Number& v) noexcept { rt::lanes::root(v); }
  template <class Numbers>
  static Numbers choose(const Whole& which, const Numbers& one, const Numbers& other) noexcept {
    return rt::lanes::choose(which, one, other);
  }
  static Whole whole(const Number& v) noexcept { return rt::lanes::convert<Whole>(v); }
  static Number number(const Whole& v) noexcept { return rt::lanes::convert<Number>(v); }
};

}  // namespace
}  // namespace burr::tool
