// apps/burr/verify/verify.h - a part of `burr verify`; one file each, which registers itself.
//
//     namespace {
//     void friction(const Verify& verify, VerifyReport::Part& part) { ... part.near(...); }
//     const VerifyPart part{40, "friction", "Friction", "What is asked here ...", friction};
//     }
#pragma once

#include <cstdint>
#include <string>

#include "verify_report.h"

namespace burr::app {

struct Verify {
  bool quick = false;      // about a minute for everything: one resolution, short strokes
  std::string data;        // folder of real bones; empty: none
  std::uint64_t seed = 0;  // of parts that draw at random; 0: the usual one of each

  [[nodiscard]] std::uint64_t seed_or(std::uint64_t usual) const {
    return seed == 0 ? usual : seed;
  }
};

struct VerifyPart {
  using Work = void (*)(const Verify&, VerifyReport::Part&);
  VerifyPart(int place, const char* name, const char* title, const char* about, Work work);
};

}  // namespace burr::app
