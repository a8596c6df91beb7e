// base/toml_text.h - quotes any text as a TOML string that is read back unchanged.
//
// Thread: any.
#pragma once

#include <string>
#include <string_view>

namespace burr::base {

[[nodiscard]] std::string toml_text(std::string_view text);

}  // namespace burr::base
