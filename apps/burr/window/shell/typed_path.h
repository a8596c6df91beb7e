// apps/burr/window/shell/typed_path.h - a path as people give it: typed, pasted or dropped.
#pragma once

#include <string>

namespace burr::app {

// Without blanks around it, quotes and file://; ~ is the home folder.
[[nodiscard]] std::string cleaned_path(std::string path);

}  // namespace burr::app
