// workshop/sha256.h - SHA-256 (FIPS 180-4), which other programs know as well: `sha256sum M.csv`.
//
// Thread: any.
#pragma once

#include <string>
#include <string_view>

#include "burr/base/result.h"

namespace burr::workshop {

// 64 digits, 0 to f.
[[nodiscard]] std::string sha256(std::string_view bytes);
// Of a file's bytes. Error: it cannot be read.
[[nodiscard]] Result<std::string> sha256_of_file(const std::string& path);

}  // namespace burr::workshop
