// base/markup.h - escapes text from files, devices or users so that it can stand between tags and
// inside quotes of HTML, SVG and XML.
//
// Thread: any.
#pragma once

#include <string>
#include <string_view>

namespace burr::base {

// No part of the result is read as markup. Control characters, which XML does not allow, become
// spaces.
[[nodiscard]] std::string markup_text(std::string_view text);

}  // namespace burr::base
