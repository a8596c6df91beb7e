// scenario/built_in.h - the text of cases/*.toml, made part of the library by cmake/library.cmake;
// of this room only.
#pragma once

#include <span>

namespace burr::scenario {

struct BuiltIn {
  const char* name;  // "temporal-bone"
  const char* toml;
};

[[nodiscard]] std::span<const BuiltIn> built_in_texts();

}  // namespace burr::scenario
