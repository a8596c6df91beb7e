// apps/burr/batch/sha256.h - SHA-256 (FIPS 180-4), which other programs know as well: `sha256sum M.csv`.
//
// Thread: any.
#pragma once

#include <string>
#include <string_view>

namespace burr::app {

// 64 digits, 0 to f.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace burr::app
