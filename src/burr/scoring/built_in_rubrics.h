// scoring/built_in_rubrics.h - the text of rubrics/*.toml, which cmake/library.cmake makes part of the
// library. For use of this room only.
//
// Thread: any.
#pragma once

#include <span>

namespace burr::scoring {

struct BuiltIn {
  const char* name;  // "temporal-bone"
  const char* toml;
};

[[nodiscard]] std::span<const BuiltIn> built_in_texts();

}  // namespace burr::scoring
