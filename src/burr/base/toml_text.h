// base/toml_text.h - any text as a string of TOML, in quotes, so that it is read back as it was.
//
// Thread: any.
#pragma once

#include <string>
#include <string_view>

namespace burr::base {

[[nodiscard]] std::string toml_text(std::string_view text);

}  // namespace burr::base
