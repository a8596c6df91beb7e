// apps/burr/shared/counted.h - a number and what is counted: "1 region", "2 regions".
//
// Thread: any.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace burr::app {

// many: where it is not `one` with an s behind it.
[[nodiscard]] inline std::string counted(std::size_t count, std::string_view one,
                                         std::string_view many = {}) {
  if (count == 1) return fmt::format("1 {}", one);
  return many.empty() ? fmt::format("{} {}s", count, one) : fmt::format("{} {}", count, many);
}

}  // namespace burr::app
