// apps/burr/shared/picture_size.h - the option --picture-size W,H of every command that writes
// pictures.
#pragma once

namespace CLI {
class App;
}

namespace burr::app {

struct PictureSize {
  int width = 1280, height = 720;  // [pixel]
};
// Adds --picture-size W,H.
void add_picture_size(CLI::App& command, PictureSize& size);

}  // namespace burr::app
