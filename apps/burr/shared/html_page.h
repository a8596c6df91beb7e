// apps/burr/shared/html_page.h - the common part of burr's pages for a browser; texts are escaped
// by base/markup.h.
#pragma once

namespace burr::app {

extern const char* const kPageStyle;  // CSS

}  // namespace burr::app
