// apps/burr/window/shell/typed_path.h - cleans up a path that the user typed, pasted or dropped.
#pragma once

#include <string>

namespace burr::app {

// Removes blanks around it, quotes and file://; replaces ~ by the home folder.
[[nodiscard]] std::string cleaned_path(std::string path);

}  // namespace burr::app
