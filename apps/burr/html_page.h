// apps/burr/html_page.h - what burr's pages for a browser have in common.
#pragma once

#include <string>

namespace burr::app {

// Words that come from files or devices, between tags and in quotes of HTML and SVG: nothing of
// them may become markup.
[[nodiscard]] std::string escaped(const std::string& text);

extern const char* const kPageStyle;  // CSS

}  // namespace burr::app
