#include "shared/picture_size.h"

#include <CLI/CLI.hpp>

#include <vector>

namespace burr::app {

void add_picture_size(CLI::App& command, PictureSize& size) {
  command
      .add_option_function<std::vector<int>>(
          "--picture-size",
          [&size](const std::vector<int>& wh) {
            size = {wh[0], wh[1]};
          },
          "W,H of pictures [pixel] (default: 1280,720)")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(16, 65536));
}

}  // namespace burr::app
