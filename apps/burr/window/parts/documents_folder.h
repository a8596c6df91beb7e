// apps/burr/window/parts/documents_folder.h - where a user keeps documents: the folder that is proposed for what
// burr writes.
//
// Thread: main.
#pragma once

#include <filesystem>

namespace burr::app {

// The first of these that is a folder: XDG_DOCUMENTS_DIR, as a variable or in the desktop's user-dirs.dirs;
// ~/Documents; the home folder; the folder in which burr was started.
[[nodiscard]] std::filesystem::path documents_folder();

}  // namespace burr::app
