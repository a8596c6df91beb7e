// scenario/built_in_cases.h - the text of cases/*.toml, which cmake/library.cmake makes part of the
// library. For use of this room only.
//
// Thread: any.
#pragma once

#include <span>

namespace burr::scenario {

struct BuiltIn {
  const char* name;  // "temporal-bone"
  const char* toml;
};

[[nodiscard]] std::span<const BuiltIn> built_in_texts();

}  // namespace burr::scenario
