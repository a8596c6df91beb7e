#include <gdcmImageReader.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "left_out.h"
#include "unpack.h"

namespace gdcm {
namespace {

using Bytes = std::span<const std::uint8_t>;

struct Small {  // the file that io/read/dicom_pixels.cpp makes
  std::map<std::uint32_t, std::string> facts;
  std::vector<Bytes> fragments;
  [[nodiscard]] int number(std::uint32_t tag) const {
    const auto at = facts.find(tag);
    if (at == facts.end() || at->second.size() < 2) return 0;
    return static_cast<unsigned char>(at->second[0]) | static_cast<unsigned char>(at->second[1])
                                                           << 8;
  }
  [[nodiscard]] std::string text(std::uint32_t tag) const {
    const auto at = facts.find(tag);
    std::string text = at == facts.end() ? "" : at->second;
    while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
    return text;
  }
};

Small read_small(Bytes bytes) {
  Small small;
  const auto two = [&](std::size_t at) {
    return static_cast<std::uint32_t>(bytes[at] | bytes[at + 1] << 8);
  };
  std::size_t at = 132;
  for (; at + 8 <= bytes.size() && two(at) != 0x7FE0;) {
    const std::size_t length = two(at + 6);
    if (at + 8 + length > bytes.size()) return small;
    small.facts[two(at) << 16 | two(at + 2)].assign(
        bytes.begin() + static_cast<std::ptrdiff_t>(at + 8),
        bytes.begin() + static_cast<std::ptrdiff_t>(at + 8 + length));
    at += 8 + length;
  }
  bool table = true;  // the first item says where the frames begin
  for (at += 12; at + 8 <= bytes.size() && two(at) == 0xFFFE && two(at + 2) == 0xE000;) {
    const std::size_t length = two(at + 4) | std::size_t{two(at + 6)} << 16;
    if (length > bytes.size() - at - 8) return small;
    if (!table) small.fragments.push_back(bytes.subspan(at + 8, length));
    table = false;
    at += 8 + length;
  }
  return small;
}

bool begins_picture(Bytes one) {
  if (one.size() < 4) return false;
  const bool jpeg = one[0] == 0xFF && one[1] == 0xD8,
             stream = one[0] == 0xFF && one[1] == 0x4F && one[2] == 0xFF && one[3] == 0x51;
  return jpeg || stream || (one.size() > 12 && std::memcmp(&one[4], "jP  ", 4) == 0);
}

// The bytes of each frame. A frame may lie in several fragments: a new one begins where a picture does.
std::vector<std::vector<std::uint8_t>> frames_of(const Small& small, std::size_t frames) {
  std::vector<std::vector<std::uint8_t>> all;
  for (const Bytes one : small.fragments) {
    const bool next =
        all.empty() || (frames > 1 && (small.fragments.size() == frames || begins_picture(one)));
    if (next) all.emplace_back();
    all.back().insert(all.back().end(), one.begin(), one.end());
  }
  return all;
}

// Where the codestream of a JPEG 2000 picture begins: some are files with boxes around it.
std::size_t codestream_at(Bytes bytes) {
  constexpr std::uint8_t kStart[] = {0xFF, 0x4F, 0xFF, 0x51};
  const auto at = std::search(bytes.begin(), bytes.end(), std::begin(kStart), std::end(kStart));
  return static_cast<std::size_t>(at - bytes.begin());
}

bool unpack(std::string_view syntax, Bytes bytes, int width, burr::web::Unpacked& to) {
  if (!syntax.starts_with("1.2.840.10008.1.2."))
    burr::web::leave_out("no_codec", std::string(syntax).c_str());
  const std::string_view kind = syntax.substr(std::strlen("1.2.840.10008.1.2."));
  if (kind == "5") return burr::web::unpack_rle(bytes, width, to);
  if (kind == "4.57" || kind == "4.70") return burr::web::unpack_jpeg_lossless(bytes, to);
  if (kind == "4.80" || kind == "4.81") return burr::web::unpack_jpeg_ls(bytes, to);
  if (kind == "4.90" || kind == "4.91")
    return burr::web::unpack_jpeg_2000(bytes.subspan(codestream_at(bytes)), to);
  burr::web::leave_out("no_codec", std::string(syntax).c_str());
}

}  // namespace

bool Image::GetBuffer(char* to) const {
  std::copy(bytes.begin(), bytes.end(), to);
  return true;
}

bool ImageReader::Read() {
  const std::string file{std::istreambuf_iterator<char>(*stream_), {}};
  const Small small = read_small({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
  const std::string count = small.text(0x00280008);
  const int frames = count.empty() ? 1 : std::atoi(count.c_str());
  const int rows = small.number(0x00280010), columns = small.number(0x00280011);
  image_.format = {static_cast<unsigned>(small.number(0x00280100)),
                   static_cast<unsigned>(small.number(0x00280101)), small.number(0x00280103)};
  const auto width = static_cast<std::size_t>(image_.format.allocated / 8);
  if (frames < 1 || rows < 1 || columns < 1 || width < 1 || width > 4) return false;
  const auto packed = frames_of(small, static_cast<std::size_t>(frames));
  if (packed.size() != static_cast<std::size_t>(frames)) return false;
  image_.bytes.clear();
  for (const std::vector<std::uint8_t>& one : packed) {
    burr::web::Unpacked picture{columns, rows, {}};
    if (!unpack(small.text(0x00020010), one, static_cast<int>(width), picture)) return false;
    for (const std::int32_t value : picture.values)
      for (std::size_t n = 0; n < width; ++n)
        image_.bytes.push_back(static_cast<char>(value >> (8 * n) & 255));
  }
  return true;
}

}  // namespace gdcm
