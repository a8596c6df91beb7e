// base/markup.h - words that come from files, devices or people, made fit to stand between tags and
// in quotes of HTML, SVG and XML.
//
// Thread: any.
#pragma once

#include <string>
#include <string_view>

namespace burr::base {

// Nothing of it becomes markup; control letters, which XML does not know, become spaces.
[[nodiscard]] std::string markup_text(std::string_view text);

}  // namespace burr::base
