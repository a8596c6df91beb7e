// proof/built_in_tables.h - the text of proof/tables/*.txt, which cmake/library.cmake makes part of the program. For use of this room
// only.
//
// Thread: any.
#pragma once

#include <span>
#include <string_view>

namespace burr::proof {

struct BuiltInTable {
  std::string_view case_name;  // "temporal-bone"
  std::string_view text;
};

[[nodiscard]] std::span<const BuiltInTable> built_in_tables();

}  // namespace burr::proof
