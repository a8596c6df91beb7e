// A folder of pictures: for each a line with its name, two bytes for its length, and its bytes (PNG, BMP, TIFF).
#include <filesystem>
#include <fstream>
#include <vector>

#include "burr/io/read/picture_stack.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  constexpr std::size_t kMostPictures = 6, kLongestName = 20;
  static const std::string place = [] {
    std::filesystem::create_directory(fuzz::folder() + "/stack");
    return fuzz::folder() + "/stack/";
  }();
  fuzz::Pieces in({data, size});
  std::vector<std::filesystem::path> files;
  while (!in.empty() && files.size() < kMostPictures) {
    std::string name(in.line().substr(0, kLongestName));
    for (char& c : name)
      if (c == '/' || c == '\0') c = '0';
    if (name.empty() || name == "." || name == "..") name = "a1.png";
    const fuzz::Bytes bytes = in.take(in.word());
    std::ofstream(place + name, std::ios::binary) << fuzz::text_of(bytes);
    files.emplace_back(place + name);
  }
  const auto pictures = io::pictures_among(files);
  if (!pictures.empty()) {
    NoProgress progress;
    const auto scan = io::read_picture_stack(pictures, "stack", {}, progress);
    fuzz::look_at_error(scan);
    if (scan) fuzz::look_at(*scan);
  }
  std::error_code trouble;
  for (const auto& path : files) std::filesystem::remove(path, trouble);
  return 0;
}
