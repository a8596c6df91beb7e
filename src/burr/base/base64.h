// base/base64.h - bytes as text, for a picture inside a page (RFC 4648, section 4).
//
// Thread: any.
#pragma once

#include <string>
#include <string_view>

namespace burr::base {

[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace burr::base
