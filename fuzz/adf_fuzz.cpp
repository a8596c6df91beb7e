// The description of a volume of AMBF (YAML) and the pictures beside it: text up to a line "...",
// then pictures of a few pixels, packed here so that their checksums are right.
#include <zlib.h>

#include <filesystem>
#include <string>
#include <vector>

#include "burr/io/read/yaml.h"
#include "support.h"

namespace {

using namespace burr;
using std::string;

constexpr int kMostPictures = 5, kLongestSide = 6;

string big32(std::size_t v) {
  string out;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(v >> shift & 0xFF);
  return out;
}
string chunk(const string& name, const string& data) {
  const string body = name + data;
  return big32(data.size()) + body +
         big32(::crc32(0, reinterpret_cast<const Bytef*>(body.data()),
                       static_cast<uInt>(body.size())));
}

// A picture whose kind, depth, size and bytes come from the input.
string picture(fuzz::Pieces& in) {
  const std::uint8_t kind = in.byte(), depth = in.byte(), interlaced = in.byte();
  const int width = 1 + in.byte() % kLongestSide, height = 1 + in.byte() % kLongestSide;
  const fuzz::Bytes raw = in.take(in.byte());
  uLongf size = compressBound(raw.size());
  string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size, raw.data(), raw.size(), 1);
  packed.resize(size);
  const string head = big32(static_cast<std::size_t>(width)) +
                      big32(static_cast<std::size_t>(height)) + static_cast<char>(depth) +
                      static_cast<char>(kind) + string(2, '\0') + static_cast<char>(interlaced & 1);
  return "\x89PNG\r\n\x1A\n" + chunk("IHDR", head) +
         (kind == 3 ? chunk("PLTE", string("\1\2\3\4\5\6", 6)) : "") + chunk("IDAT", packed) +
         chunk("IEND", "");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const string place = [] {
    std::filesystem::create_directories(fuzz::folder() + "/adf/p");
    return fuzz::folder() + "/adf";
  }();
  fuzz::Pieces in({data, size});
  string text;
  while (!in.empty()) {
    const std::string_view line = in.line();
    if (line == "...") break;
    text += string(line) + "\n";
  }
  fuzz::look_at_error(io::parse_yaml(text, "a.yaml"));
  const string& path = fuzz::as_file(
      "adf/a.yaml", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  for (int n = 0; n < kMostPictures; ++n) {
    const string name = "adf/p/a" + std::to_string(n) + ".png";
    if (in.empty()) {
      std::filesystem::remove(place + name.substr(3));
      continue;
    }
    const string bytes = picture(in);
    fuzz::as_file(name, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  }
  NoProgress progress;
  const auto scan = io::read_adf(path, {}, progress);
  fuzz::look_at_error(scan);
  fuzz::look_at_error(io::describes_pictures(path));
  if (scan) fuzz::look_at(*scan);
  return 0;
}
