// apps/burr/window/ui/typed_path.h - cleans up a path that the user typed, pasted or dropped.
#pragma once

#include <string>

namespace burr::app {

// Removes blanks around it, quotes and file://; replaces ~ by the home folder.
[[nodiscard]] std::string cleaned_path(std::string path);

// As Tab in a shell: the path with as many letters added as all files and folders that begin so
// have in common, and a slash after the one folder. Unchanged where nothing begins so. Hidden ones
// count only if the dot is typed.
[[nodiscard]] std::string completed_path(const std::string& path);

}  // namespace burr::app
