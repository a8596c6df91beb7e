// What pictures of all formats have in common, and BMP after Microsoft's BITMAPINFOHEADER.
#include "burr/io/read/grey_picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "burr/io/read/bytes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

constexpr int kLongestSide = 32768;

Error colour(const std::string& file) {
  // the volumes of AMBF are pictures in colour
  const bool png = lower(file).ends_with(".png");
  return error(
      fmt::format("{}: is a colour picture, and burr reads grey values; save the stack in "
                  "grey, {}or give burr a label map",
                  file, png ? "put the ADF (.yaml) of AMBF that names it into the folder, " : ""));
}

// What a BMP states of its pixels.
struct Bmp {
  std::uint32_t pixels_at = 0, compression = 0;
  std::size_t palette_at = 0, palette_each = 4, palette_count = 0;
  int width = 0, height = 0, bits = 0;
  bool from_above = false;
};

std::uint32_t number(const std::vector<std::uint8_t>& b, std::size_t at, std::size_t width) {
  std::uint32_t out = 0;
  for (std::size_t n = 0; n < width && at + n < b.size(); ++n)
    out |= std::uint32_t{b[at + n]} << 8 * n;
  return out;
}

Result<Bmp> parse_bmp(const std::vector<std::uint8_t>& bytes, const std::string& file) {
  constexpr std::size_t kFileHead = 14, kOldHead = 12, kHead = 40;
  const auto head = number(bytes, kFileHead, 4);
  const bool old = head == kOldHead;
  if (bytes.size() < kFileHead + kOldHead || (!old && (head < kHead || head > 1024)) ||
      bytes.size() < kFileHead + head)
    return error(fmt::format("{}: is a damaged BMP picture; copy it again", file));
  Bmp bmp;
  bmp.pixels_at = number(bytes, 10, 4);
  bmp.width = static_cast<int>(number(bytes, 18, old ? 2 : 4));
  bmp.height = static_cast<int>(number(bytes, old ? 20 : 22, old ? 2 : 4));
  bmp.bits = static_cast<int>(number(bytes, old ? 24 : 28, 2));
  bmp.compression = old ? 0 : number(bytes, 30, 4);
  bmp.palette_at = kFileHead + head;
  bmp.palette_each = old ? 3 : 4;
  bmp.from_above = bmp.height < 0 && bmp.height > -kLongestSide;
  if (bmp.from_above) bmp.height = -bmp.height;
  if (bmp.width < 1 || bmp.height < 1 || bmp.width > kLongestSide || bmp.height > kLongestSide)
    return error(fmt::format("{}: is a BMP picture of {} x {} pixels; it is damaged, copy it again",
                             file, bmp.width, bmp.height));
  constexpr std::uint32_t kPlain = 0, kMasks = 3;
  const bool plain = bmp.compression == kPlain || (bmp.compression == kMasks && bmp.bits == 32);
  if (!plain ||
      (bmp.bits != 1 && bmp.bits != 4 && bmp.bits != 8 && bmp.bits != 24 && bmp.bits != 32))
    return error(
        fmt::format("{}: is a compressed BMP picture or one of {} bits a pixel, which burr "
                    "does not read; save the stack as TIFF or PNG",
                    file, bmp.bits));
  if (bmp.bits <= 8) bmp.palette_count = std::size_t{1} << bmp.bits;
  return bmp;
}

// The grey value of each index of the palette. Error: one of them is a colour.
Result<std::array<std::uint8_t, 256>> palette_of(const Bmp& bmp,
                                                 const std::vector<std::uint8_t>& bytes,
                                                 const std::string& file) {
  std::array<std::uint8_t, 256> out{};
  for (std::size_t n = 0; n < bmp.palette_count; ++n) {
    const std::size_t at = bmp.palette_at + bmp.palette_each * n;
    if (at + 3 > bytes.size() || at + 3 > bmp.pixels_at) break;  // a shorter table
    if (bytes[at] != bytes[at + 1] || bytes[at] != bytes[at + 2]) return colour(file);
    out[n] = bytes[at];
  }
  return out;
}

}  // namespace

PictureKind picture_kind(const std::vector<std::uint8_t>& head) {
  const std::string_view bytes(reinterpret_cast<const char*>(head.data()), head.size());
  using namespace std::string_view_literals;
  for (const std::string_view mark : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})
    if (bytes.starts_with(mark)) return PictureKind::tiff;
  if (bytes.starts_with("\x89PNG")) return PictureKind::png;
  // "BM", and four bytes that programs leave at 0
  if (bytes.starts_with("BM") && bytes.size() >= 26 && number(head, 6, 4) == 0)
    return PictureKind::bmp;
  return PictureKind::none;
}

const char* name_of(PictureKind kind) {
  return kind == PictureKind::tiff ? "TIFF" : kind == PictureKind::png ? "PNG" : "BMP";
}

Status keep_grey(GreyPicture& picture, int channels, const std::string& file) {
  if (channels == 1) return fine();
  const std::size_t width = bytes_of(picture.type),
                    each = width * static_cast<std::size_t>(channels),
                    pixels = picture.samples.size() / each;
  std::uint8_t* const all = picture.samples.data();
  for (std::size_t p = 0; p < pixels; ++p) {
    const std::uint8_t* from = all + p * each;
    if (channels >= 3 && (std::memcmp(from, from + width, width) != 0 ||
                          std::memcmp(from, from + 2 * width, width) != 0))
      return colour(file);
    std::memmove(all + p * width, from, width);
  }
  picture.samples.resize(pixels * width);
  return fine();
}

Result<GreyPicture> read_grey_bmp(const std::filesystem::path& path) {
  const std::string file = short_name(path);
  constexpr std::size_t kLargest = std::size_t{1} << 30;  // [byte]
  const auto bytes = first_bytes(path, kLargest, false);
  if (!bytes) return bytes.error();
  const auto bmp = parse_bmp(*bytes, file);
  if (!bmp) return bmp.error();
  const auto width = static_cast<std::size_t>(bmp->width),
             height = static_cast<std::size_t>(bmp->height),
             bits = static_cast<std::size_t>(bmp->bits);
  const std::size_t row = (width * bits + 31) / 32 * 4, needed = row * height;
  if (bmp->pixels_at > bytes->size() || needed > bytes->size() - bmp->pixels_at)
    return error(
        fmt::format("{}: {} x {} pixels need {} bytes, and the file holds {}; it is cut off, "
                    "copy it again",
                    file, width, height, needed, bytes->size()));
  const auto palette = palette_of(*bmp, *bytes, file);
  if (!palette) return palette.error();
  GreyPicture picture;
  picture.width = bmp->width;
  picture.height = bmp->height;
  const int channels = bmp->bits <= 8 ? 1 : bmp->bits / 8;
  picture.samples.reserve(width * height * static_cast<std::size_t>(channels));
  for (std::size_t j = 0; j < height; ++j) {
    const std::uint8_t* from =
        bytes->data() + bmp->pixels_at + row * (bmp->from_above ? j : height - 1 - j);
    if (channels > 1) {
      picture.samples.insert(picture.samples.end(), from,
                             from + width * static_cast<std::size_t>(channels));
      continue;
    }
    for (std::size_t i = 0; i < width; ++i) {
      const std::size_t place = i * bits, shift = 8 - bits - place % 8;
      picture.samples.push_back(
          (*palette)[static_cast<std::size_t>(from[place / 8] >> shift) & ((1U << bits) - 1)]);
    }
  }
  if (Status status = keep_grey(picture, channels, file); !status) return status.error();
  return picture;
}

}  // namespace burr::io
