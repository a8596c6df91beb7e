// apps/burr/window/parts/small_picture.h - small pictures in the user's own folders: of the cases on the start page, of
// the sessions in its list. Files of the kind PPM.
//
// Thread: any. A picture that cannot be written or read is not there, and nothing else happens.
#pragma once

#include <filesystem>

#include "burr/render/picture.h"

namespace burr::app {

// False: there is none, it is damaged, or it is larger than 1024 x 1024.
[[nodiscard]] bool read_small_picture(const std::filesystem::path& path, render::Image& image);
void keep_small_picture(const std::filesystem::path& path, const render::Image& image);

}  // namespace burr::app
