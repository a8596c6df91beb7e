#include "window/parts/small_picture.h"

#include <fmt/format.h>

#include <cstddef>
#include <fstream>
#include <system_error>

#include "burr/base/new_file.h"

namespace burr::app {
namespace {

constexpr int kLargest = 1024;  // [pixel]

}  // namespace

bool read_small_picture(const std::filesystem::path& path, render::Image& image) {
  std::ifstream file(path, std::ios::binary);
  std::string kind;
  int wide = 0, high = 0, white = 0;
  if (!(file >> kind >> wide >> high >> white) || kind != "P6" || white != 255) return false;
  if (wide < 1 || high < 1 || wide > kLargest || high > kLargest || file.get() != '\n')
    return false;
  image = {wide, high, {}};
  image.rgb.resize(std::size_t{3} * static_cast<std::size_t>(wide) *
                   static_cast<std::size_t>(high));
  return static_cast<bool>(file.read(reinterpret_cast<char*>(image.rgb.data()),
                                     static_cast<std::streamsize>(image.rgb.size())));
}

void keep_small_picture(const std::filesystem::path& path, const render::Image& image) {
  std::error_code nobody_asks;
  std::filesystem::create_directories(path.parent_path(), nobody_asks);
  auto file = base::NewFile::create(path.string());
  if (!file) return;
  file->write(fmt::format("P6\n{} {}\n255\n", image.width, image.height));
  file->write(image.rgb.data(), image.rgb.size());
  static_cast<void>(file->put_in_place());
}

}  // namespace burr::app
