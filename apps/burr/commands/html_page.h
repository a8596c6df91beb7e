// apps/burr/commands/html_page.h - what burr's pages for a browser have in common; words go through
// base/markup.h.
#pragma once

namespace burr::app {

extern const char* const kPageStyle;  // CSS

}  // namespace burr::app
