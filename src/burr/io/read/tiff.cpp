#include "burr/io/read/tiff.h"

#include <fmt/core.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>

#include "burr/base/printable.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

constexpr std::size_t kMostPages = 100000;
constexpr std::uint32_t kLongestSide = 32768;

// One page of full size, as its directory states it.
struct Page {
  std::uint64_t at = 0;  // of its directory
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 1, channels = 1, format = SAMPLEFORMAT_UINT,
                meaning = PHOTOMETRIC_MINISBLACK, planar = PLANARCONFIG_CONTIG,
                packing = COMPRESSION_NONE, way = ORIENTATION_TOPLEFT;
};

class Memory {
 public:
  explicit Memory(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }

  // Whether the directory at this place ends within the file. libtiff takes one without its last bytes, the
  // link to the next picture, for the last one.
  [[nodiscard]] bool holds_directory(std::uint64_t at) const {
    constexpr std::uint64_t kBigTiff = 43;
    const bool large = number(2, 2) == kBigTiff;
    const std::uint64_t count_bytes = large ? 8 : 2, entry = large ? 20 : 12, link = large ? 8 : 4;
    if (at > size() || size() - at < count_bytes + link) return false;
    const std::uint64_t left = size() - at - count_bytes - link;
    return number(at, count_bytes) <= left / entry;
  }

  static tmsize_t read(thandle_t self, void* to, tmsize_t n) {
    auto& in = *static_cast<Memory*>(self);
    const std::uint64_t left = in.bytes_.size() - std::min<std::uint64_t>(in.at_, in.bytes_.size()),
                        part = std::min<std::uint64_t>(left,
                                                       n < 0 ? 0 : static_cast<std::uint64_t>(n));
    if (part > 0) std::memcpy(to, in.bytes_.data() + in.at_, part);
    in.at_ += part;
    return static_cast<tmsize_t>(part);
  }
  static tmsize_t write(thandle_t, void*, tmsize_t) { return -1; }
  static toff_t seek(thandle_t self, toff_t to, int from) {
    auto& in = *static_cast<Memory*>(self);
    in.at_ = from == SEEK_SET ? to : from == SEEK_CUR ? in.at_ + to : in.bytes_.size() + to;
    return in.at_;
  }
  static int close(thandle_t) { return 0; }
  static toff_t length(thandle_t self) { return static_cast<Memory*>(self)->bytes_.size(); }

  std::string why;  // the last complaint

 private:
  [[nodiscard]] std::uint64_t number(std::uint64_t at, std::uint64_t width) const {
    const bool big = !bytes_.empty() && bytes_[0] == 'M';
    std::uint64_t out = 0;
    for (std::uint64_t n = 0; n < width && at + width <= bytes_.size(); ++n)
      out |= std::uint64_t{bytes_[at + n]} << 8 * (big ? width - 1 - n : n);
    return out;
  }

  std::vector<std::uint8_t> bytes_;
  std::uint64_t at_ = 0;
};

int complain(TIFF*, void* self, const char*, const char* words, va_list list) {
  char text[160];
  std::vsnprintf(text, sizeof text, words, list);
  auto& memory = *static_cast<Memory*>(self);
  if (memory.why.empty()) memory.why = text;
  return 1;
}
int be_quiet(TIFF*, void*, const char*, const char*, va_list) { return 1; }

template <class T>
T tag_value(TIFF* tiff, std::uint32_t tag, T otherwise) {
  T value = otherwise;
  return TIFFGetFieldDefaulted(tiff, tag, &value) != 0 ? value : otherwise;
}

Page page_of(TIFF* tiff) {
  Page page;
  page.at = TIFFCurrentDirOffset(tiff);
  page.width = tag_value<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0);
  page.height = tag_value<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
  page.bits = tag_value<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  page.channels = tag_value<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  page.format = tag_value<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  page.meaning = tag_value<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  page.planar = tag_value<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  page.packing = tag_value<std::uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  page.way = tag_value<std::uint16_t>(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  return page;
}

// The number type; false: burr does not read it.
bool type_of(const Page& page, SampleType& type) {
  const bool is_signed = page.format == SAMPLEFORMAT_INT, real = page.format == SAMPLEFORMAT_IEEEFP,
             plain = page.format == SAMPLEFORMAT_UINT || page.format == SAMPLEFORMAT_VOID;
  if (real && (page.bits == 32 || page.bits == 64)) {
    type = page.bits == 32 ? SampleType::f32 : SampleType::f64;
    return true;
  }
  if (!is_signed && !plain) return false;
  switch (page.bits) {
    case 1:
    case 2:
    case 4:
      type = SampleType::u8;
      return plain;
    case 8:
      type = is_signed ? SampleType::i8 : SampleType::u8;
      return true;
    case 16:
      type = is_signed ? SampleType::i16 : SampleType::u16;
      return true;
    case 32:
      type = is_signed ? SampleType::i32 : SampleType::u32;
      return true;
    default:
      return false;
  }
}

class Tiff final : public TiffFile {
 public:
  Tiff(std::string file, std::vector<std::uint8_t> bytes)
      : file_(std::move(file)), memory_(std::move(bytes)) {
    TIFFOpenOptions* how = TIFFOpenOptionsAlloc();
    constexpr tmsize_t kMost = tmsize_t{1} << 30;  // one piece of memory [byte]
    TIFFOpenOptionsSetMaxSingleMemAlloc(how, kMost);
    TIFFOpenOptionsSetErrorHandlerExtR(how, &complain, &memory_);
    TIFFOpenOptionsSetWarningHandlerExtR(how, &be_quiet, nullptr);
    tiff_ = TIFFClientOpenExt("TIFF", "rm", &memory_, &Memory::read, &Memory::write, &Memory::seek,
                              &Memory::close, &Memory::length, nullptr, nullptr, how);
    TIFFOpenOptionsFree(how);
  }
  ~Tiff() override {
    if (tiff_ != nullptr) TIFFClose(tiff_);
  }

  // Lists the pages.
  Status look() {
    if (tiff_ == nullptr) return damaged();
    do {
      const Page page = page_of(tiff_);
      if (!memory_.holds_directory(page.at)) {
        memory_.why = "it is cut off";
        return damaged();
      }
      constexpr std::uint32_t kSmaller = FILETYPE_REDUCEDIMAGE | FILETYPE_MASK;
      if ((tag_value<std::uint32_t>(tiff_, TIFFTAG_SUBFILETYPE, 0) & kSmaller) == 0)
        pages_.push_back(page);
      if (pages_.size() == 1 && words_.description.empty()) take_words();
      if (pages_.size() > kMostPages)
        return error(fmt::format("{}: holds more than {} pictures", file_, kMostPages));
      memory_.why.clear();
    } while (TIFFReadDirectory(tiff_) != 0);
    if (!memory_.why.empty()) return damaged();
    if (pages_.empty())
      return error(fmt::format("{}: is a TIFF file without a picture; save it again", file_));
    return fine();
  }

  [[nodiscard]] std::size_t pages() const override { return pages_.size(); }
  [[nodiscard]] const TiffWords& words() const override { return words_; }

  Result<GreyPicture> read(std::size_t number) override {
    const Page& page = pages_[number];
    GreyPicture picture;
    if (Status status = check(page, picture); !status) return status.error();
    memory_.why.clear();
    if (TIFFSetSubDirectory(tiff_, page.at) == 0) return damaged();
    const bool apart = page.planar == PLANARCONFIG_SEPARATE && page.channels > 1;
    std::vector<std::uint8_t> first;
    const std::uint16_t planes = apart ? std::min<std::uint16_t>(page.channels, 3) : 1;
    for (std::uint16_t plane = 0; plane < planes; ++plane) {
      std::vector<std::uint8_t> bytes;
      if (Status status = read_plane(page, plane, apart ? 1 : page.channels, bytes); !status)
        return status.error();
      if (plane == 0)
        first = std::move(bytes);
      else if (page.channels >= 3 && bytes != first)
        return colour();
    }
    picture.samples = std::move(first);
    if (page.bits < 8) spread(page, picture);
    if (!apart)
      if (Status status = keep_grey(picture, page.channels, file_); !status) return status.error();
    if (page.meaning == PHOTOMETRIC_PALETTE)
      if (Status status = check_palette(page); !status) return status.error();
    if (page.meaning == PHOTOMETRIC_MINISWHITE) turn_round(picture);
    lay_upright(page, picture);
    return picture;
  }

 private:
  [[nodiscard]] Error damaged() const {
    return error(fmt::format(
        "{}: is a damaged TIFF picture{}; copy it again", file_,
        memory_.why.empty() ? std::string() : fmt::format(" ({})", base::printable(memory_.why))));
  }
  [[nodiscard]] Error colour() const {
    return error(
        fmt::format("{}: is a colour picture, and burr reads grey values; save the stack in "
                    "grey, or give burr a label map",
                    file_));
  }

  void take_words() {
    char* text = nullptr;
    if (TIFFGetField(tiff_, TIFFTAG_IMAGEDESCRIPTION, &text) != 0 && text != nullptr)
      words_.description = text;
    float x = 0, y = 0;
    if (TIFFGetField(tiff_, TIFFTAG_XRESOLUTION, &x) != 0) words_.per_unit_x = x;
    if (TIFFGetField(tiff_, TIFFTAG_YRESOLUTION, &y) != 0) words_.per_unit_y = y;
  }

  // Before anything is decoded: is it a picture that burr reads, and can the file hold it?
  Status check(const Page& page, GreyPicture& picture) const {
    if (page.width < 1 || page.height < 1 || page.width > kLongestSide ||
        page.height > kLongestSide)
      return error(fmt::format("{}: has a picture of {} x {} pixels, which burr does not read",
                               file_, page.width, page.height));
    picture.width = static_cast<int>(page.width);
    picture.height = static_cast<int>(page.height);
    picture.bits = page.bits;
    if (!type_of(page, picture.type))
      return error(
          fmt::format("{}: has {} bits a pixel in a form that burr does not read; save the "
                      "stack with 8 or 16 bits",
                      file_, page.bits));
    if (page.channels < 1 || page.channels > 4) return colour();
    if (page.channels >= 3 && page.meaning != PHOTOMETRIC_RGB) return colour();
    if (TIFFIsCODECConfigured(page.packing) == 0)
      return error(
          fmt::format("{}: is compressed in a way that burr does not read (TIFF compression "
                      "{}); save the stack with LZW, ZIP or without compression",
                      file_, page.packing));
    if (page.way < ORIENTATION_TOPLEFT || page.way > ORIENTATION_BOTLEFT)
      return error(fmt::format(
          "{}: its rows and columns are exchanged (Orientation {}); save the stack upright", file_,
          page.way));
    constexpr std::uint64_t kMostRatio = 20000;  // of any packing, for a picture of zeros
    const std::uint64_t bytes =
        std::uint64_t{page.width} * page.height * page.channels * page.bits / 8;
    const bool plain = page.packing == COMPRESSION_NONE;
    if (bytes / (plain ? 1 : kMostRatio) > memory_.size())
      return error(
          fmt::format("{}: its {} bytes cannot hold a picture of {} x {} pixels; the file is "
                      "cut off or damaged, copy it again",
                      file_, memory_.size(), page.width, page.height));
    return fine();
  }

  // All rows of one plane, `channels` numbers a pixel.
  Status read_plane(const Page& page, std::uint16_t plane, std::uint16_t channels,
                    std::vector<std::uint8_t>& out) {
    const std::size_t row = (std::size_t{page.width} * channels * page.bits + 7) / 8;
    out.assign(row * page.height, 0);
    return TIFFIsTiled(tiff_) != 0 ? read_tiles(page, plane, channels, row, out)
                                   : read_strips(page, plane, row, out);
  }

  Status read_strips(const Page& page, std::uint16_t plane, std::size_t row,
                     std::vector<std::uint8_t>& out) {
    if (TIFFScanlineSize64(tiff_) != row) return damaged();
    const auto each =
        std::min(tag_value<std::uint32_t>(tiff_, TIFFTAG_ROWSPERSTRIP, page.height), page.height);
    if (each == 0) return damaged();
    for (std::uint32_t y = 0; y < page.height; y += each) {
      const std::size_t rows = std::min(each, page.height - y), bytes = rows * row;
      const auto got = TIFFReadEncodedStrip(tiff_, TIFFComputeStrip(tiff_, y, plane),
                                            out.data() + y * row, static_cast<tmsize_t>(bytes));
      if (got != static_cast<tmsize_t>(bytes)) return damaged();
    }
    return fine();
  }

  Status read_tiles(const Page& page, std::uint16_t plane, std::uint16_t channels, std::size_t row,
                    std::vector<std::uint8_t>& out) {
    const auto wide = tag_value<std::uint32_t>(tiff_, TIFFTAG_TILEWIDTH, 0),
               high = tag_value<std::uint32_t>(tiff_, TIFFTAG_TILELENGTH, 0);
    const std::uint64_t tile_row = TIFFTileRowSize64(tiff_), size = TIFFTileSize64(tiff_);
    const std::size_t bits = std::size_t{channels} * page.bits;
    constexpr std::uint64_t kMost = std::uint64_t{1} << 28;
    if (wide == 0 || high == 0 || size > kMost || size != tile_row * high || wide * bits % 8 != 0 ||
        tile_row != wide * bits / 8)
      return damaged();
    std::vector<std::uint8_t> tile(size);
    for (std::uint32_t y = 0; y < page.height; y += high)
      for (std::uint32_t x = 0; x < page.width; x += wide) {
        const auto got = TIFFReadEncodedTile(tiff_, TIFFComputeTile(tiff_, x, y, 0, plane),
                                             tile.data(), static_cast<tmsize_t>(size));
        if (got != static_cast<tmsize_t>(size)) return damaged();
        const std::size_t at = x * bits / 8, part = std::min<std::size_t>(tile_row, row - at);
        for (std::uint32_t j = 0; j < std::min(high, page.height - y); ++j)
          std::memcpy(out.data() + (y + j) * row + at, tile.data() + j * tile_row, part);
      }
    return fine();
  }

  // Pixels of one, two or four bits become a byte each.
  static void spread(const Page& page, GreyPicture& picture) {
    const std::size_t across = std::size_t{page.width} * page.channels, bits = page.bits,
                      row = (across * bits + 7) / 8;
    std::vector<std::uint8_t> out;
    out.reserve(across * page.height);
    for (std::size_t j = 0; j < page.height; ++j)
      for (std::size_t i = 0; i < across; ++i) {
        const std::size_t place = i * bits, shift = 8 - bits - place % 8;
        out.push_back(static_cast<std::uint8_t>(picture.samples[j * row + place / 8] >> shift &
                                                ((1U << bits) - 1)));
      }
    picture.samples = std::move(out);
  }

  // A table of colours that is a ramp of grey changes nothing; any other makes colours.
  Status check_palette(const Page& page) {
    std::uint16_t *red = nullptr, *green = nullptr, *blue = nullptr;
    if (page.bits > 8 || TIFFGetField(tiff_, TIFFTAG_COLORMAP, &red, &green, &blue) == 0)
      return damaged();
    const std::size_t count = std::size_t{1} << page.bits;
    for (std::size_t n = 0; n < count; ++n)
      if (red[n] != green[n] || red[n] != blue[n] || (n > 0 && red[n] < red[n - 1]))
        return colour();
    return fine();
  }

  // White is 0: v becomes the largest number less v.
  static void turn_round(GreyPicture& picture) {
    if (picture.type != SampleType::u8 && picture.type != SampleType::u16) return;
    picture.inverted = true;
    const bool whole = picture.type == SampleType::u16 || picture.bits == 8;
    const auto most = static_cast<std::uint8_t>(whole ? 0xFF : (1U << picture.bits) - 1);
    for (std::uint8_t& byte : picture.samples) byte = static_cast<std::uint8_t>(most - byte);
  }

  // The first row above, the first column at the left.
  static void lay_upright(const Page& page, GreyPicture& picture) {
    const std::size_t width = bytes_of(picture.type), row = width * page.width;
    const bool below = page.way == ORIENTATION_BOTLEFT || page.way == ORIENTATION_BOTRIGHT,
               right = page.way == ORIENTATION_TOPRIGHT || page.way == ORIENTATION_BOTRIGHT;
    auto* const all = picture.samples.data();
    for (std::size_t j = 0; below && j < page.height / 2; ++j)
      std::swap_ranges(all + j * row, all + (j + 1) * row, all + (page.height - 1 - j) * row);
    for (std::size_t j = 0; right && j < page.height; ++j)
      for (std::size_t i = 0; i < page.width / 2; ++i)
        std::swap_ranges(all + j * row + i * width, all + j * row + (i + 1) * width,
                         all + j * row + (page.width - 1 - i) * width);
  }

  std::string file_;
  Memory memory_;
  TIFF* tiff_ = nullptr;
  std::vector<Page> pages_;
  TiffWords words_;
};

}  // namespace

Result<std::unique_ptr<TiffFile>> TiffFile::open(const std::filesystem::path& path) {
  constexpr std::size_t kLargest = std::size_t{8} << 30;  // [byte]
  auto bytes = first_bytes(path, kLargest);
  if (!bytes) return bytes.error();
  auto tiff = std::make_unique<Tiff>(short_name(path), std::move(*bytes));
  if (Status status = tiff->look(); !status) return status.error();
  return std::unique_ptr<TiffFile>(std::move(tiff));
}

}  // namespace burr::io
