// tests/io/picture_writer.h - small pictures for tests, written byte by byte: PNG, BMP, and TIFF in strips or
// tiles, of both byte orders, packed or not.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace burr::test {

inline void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// A number of `width` bytes.
inline std::string number_bytes(std::uint64_t value, std::size_t width, bool big = false) {
  std::string out(width, '\0');
  for (std::size_t n = 0; n < width; ++n)
    out[big ? width - 1 - n : n] = static_cast<char>(value >> 8 * n & 0xFF);
  return out;
}

inline std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  compress2(reinterpret_cast<Bytef*>(out.data()), &size,
            reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 9);
  out.resize(size);
  return out;
}

// The value of a pixel, and of a channel where there are several.
using PixelOf = std::function<std::uint32_t(int column, int row)>;

struct PictureForm {
  int columns = 7, rows = 5, bits = 8, channels = 1;
};

// The numbers of a picture, row by row; each row ends at a byte.
inline std::string pixel_bytes(const PictureForm& form, const PixelOf& at, bool big) {
  std::string out;
  for (int j = 0; j < form.rows; ++j)
    for (int i = 0; i < form.columns; ++i)
      for (int c = 0; c < form.channels; ++c)
        out += number_bytes(at(i, j), static_cast<std::size_t>(form.bits / 8), big);
  return out;
}

inline std::string png_bytes(const PictureForm& form, const PixelOf& at) {
  const auto chunk = [](const std::string& kind, const std::string& data) {
    const std::string all = kind + data;
    const auto crc =
        crc32(0, reinterpret_cast<const Bytef*>(all.data()), static_cast<uInt>(all.size()));
    return number_bytes(data.size(), 4, true) + all + number_bytes(crc, 4, true);
  };
  const std::string pixels = pixel_bytes(form, at, true);
  const std::size_t row = pixels.size() / static_cast<std::size_t>(form.rows);
  std::string filtered;
  for (std::size_t j = 0; j < static_cast<std::size_t>(form.rows); ++j)
    filtered += '\0' + pixels.substr(j * row, row);
  const int kind = form.channels == 3 ? 2 : form.channels == 2 ? 4 : 0;
  return std::string("\x89PNG\r\n\x1a\n") +
         chunk("IHDR",
               number_bytes(static_cast<std::uint64_t>(form.columns), 4, true) +
                   number_bytes(static_cast<std::uint64_t>(form.rows), 4, true) +
                   std::string{static_cast<char>(form.bits), static_cast<char>(kind), 0, 0, 0}) +
         chunk("IDAT", deflated(filtered)) + chunk("IEND", "");
}

// 8 bits with a table of greys, or 24 bits of three equal ones.
inline std::string bmp_bytes(const PictureForm& form, const PixelOf& at, bool from_above = false) {
  const bool table = form.channels == 1;
  const std::size_t bits = table ? 8 : 24,
                    row = (static_cast<std::size_t>(form.columns) * bits + 31) / 32 * 4;
  std::string body;
  for (int n = 0; n < form.rows; ++n) {
    const int j = from_above ? n : form.rows - 1 - n;
    std::string line;
    for (int i = 0; i < form.columns; ++i)
      line += std::string(table ? 1 : 3, static_cast<char>(at(i, j)));
    line.resize(row, '\0');
    body += line;
  }
  std::string colours;
  for (int n = 0; table && n < 256; ++n) colours += std::string(3, static_cast<char>(n)) + '\0';
  const std::size_t begin = 54 + colours.size();
  const auto rows = static_cast<std::uint32_t>(from_above ? -form.rows : form.rows);
  return "BM" + number_bytes(begin + body.size(), 4) + number_bytes(0, 4) + number_bytes(begin, 4) +
         number_bytes(40, 4) + number_bytes(static_cast<std::uint64_t>(form.columns), 4) +
         number_bytes(rows, 4) + number_bytes(1, 2) + number_bytes(bits, 2) + number_bytes(0, 4) +
         number_bytes(body.size(), 4) + number_bytes(0, 16) + colours + body;
}

// One TIFF file of several pages.
class TiffWriter {
 public:
  enum class Packing { none = 1, lzw = 5, deflate = 8, packbits = 32773 };
  PictureForm form;
  bool big = false;
  Packing packing = Packing::none;
  int tile = 0;  // its edge; 0: strips of two rows
  int kind = 1;  // 1: unsigned, 2: signed, 3: floating point
  int photometric = 1;
  std::string description;
  double per_unit = 0;  // pixels in a unit; 0: not stated

  TiffWriter& page(const PixelOf& at) {
    begin();
    std::vector<std::uint64_t> places, sizes;
    for (const std::string& piece : pieces(at)) {
      const std::string packed = pack(piece);
      places.push_back(out_.size());
      sizes.push_back(packed.size());
      out_ += packed + (packed.size() % 2 != 0 ? std::string(1, '\0') : std::string());
    }
    directory(places, sizes);
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return out_; }

 private:
  struct Field {
    std::uint64_t type, count;
    std::string value;
  };
  [[nodiscard]] std::string n(std::uint64_t value, std::size_t width) const {
    return number_bytes(value, width, big);
  }
  void begin() {
    if (!out_.empty()) return;
    out_ = std::string(big ? "MM" : "II") + n(42, 2) + n(0, 4);
    next_ = 4;
  }
  [[nodiscard]] std::vector<std::string> pieces(const PixelOf& at) const {
    std::vector<std::string> out;
    if (tile > 0) {
      for (int y = 0; y < form.rows; y += tile)
        for (int x = 0; x < form.columns; x += tile)
          out.push_back(pixel_bytes(
              {tile, tile, form.bits, form.channels},
              [&](int i, int j) {
                return x + i < form.columns && y + j < form.rows ? at(x + i, y + j) : 99U;
              },
              big));
      return out;
    }
    for (int y = 0; y < form.rows; y += 2)
      out.push_back(pixel_bytes(
          {form.columns, std::min(2, form.rows - y), form.bits, form.channels},
          [&](int i, int j) { return at(i, y + j); }, big));
    return out;
  }
  [[nodiscard]] std::string pack(const std::string& bytes) const {
    switch (packing) {
      case Packing::none:
        return bytes;
      case Packing::deflate:
        return deflated(bytes);
      case Packing::packbits: {
        std::string out;
        for (std::size_t at = 0; at < bytes.size(); at += 128) {
          const std::string part = bytes.substr(at, 128);
          out += static_cast<char>(part.size() - 1) + part;
        }
        return out;
      }
      case Packing::lzw:
        return lzw(bytes);
    }
    return {};
  }
  // Only codes of nine bits: the table is cleared before it would need ten.
  static std::string lzw(const std::string& bytes) {
    constexpr unsigned kClear = 256, kEnd = 257, kWidth = 9;
    std::string out;
    unsigned held = 0, bits = 0;
    const auto put = [&](unsigned code) {
      held = held << kWidth | code;
      for (bits += kWidth; bits >= 8; bits -= 8)
        out += static_cast<char>(held >> (bits - 8) & 0xFF);
      held &= (1U << bits) - 1;
    };
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      if (at % 200 == 0) put(kClear);
      put(static_cast<unsigned char>(bytes[at]));
    }
    put(kEnd);
    if (bits > 0) out += static_cast<char>(held << (8 - bits) & 0xFF);
    return out;
  }
  void directory(const std::vector<std::uint64_t>& places,
                 const std::vector<std::uint64_t>& sizes) {
    std::map<std::uint64_t, Field> fields;
    const auto put = [&](std::uint64_t tag, std::uint64_t value) {
      fields[tag] = {3, 1, n(value, 2)};
    };
    const auto list = [&](const std::vector<std::uint64_t>& values) {
      Field field{4, values.size(), {}};
      for (const std::uint64_t value : values) field.value += n(value, 4);
      return field;
    };
    put(256, static_cast<std::uint64_t>(form.columns));
    put(257, static_cast<std::uint64_t>(form.rows));
    std::string each;
    for (int c = 0; c < form.channels; ++c) each += n(static_cast<std::uint64_t>(form.bits), 2);
    fields[258] = {3, static_cast<std::uint64_t>(form.channels), each};
    put(259, static_cast<std::uint64_t>(packing));
    put(262, static_cast<std::uint64_t>(form.channels == 3 ? 2 : photometric));
    put(277, static_cast<std::uint64_t>(form.channels));
    put(339, static_cast<std::uint64_t>(kind));
    if (tile > 0) {
      put(322, static_cast<std::uint64_t>(tile));
      put(323, static_cast<std::uint64_t>(tile));
      fields[324] = list(places);
      fields[325] = list(sizes);
    } else {
      put(278, 2);
      fields[273] = list(places);
      fields[279] = list(sizes);
    }
    if (!description.empty()) fields[270] = {2, description.size() + 1, description + '\0'};
    if (per_unit > 0)
      for (const std::uint64_t tag : {282U, 283U})
        fields[tag] = {5, 1, n(static_cast<std::uint64_t>(per_unit * 1e6), 4) + n(1'000'000, 4)};
    std::string table = n(fields.size(), 2);
    for (auto& [tag, field] : fields) {
      if (field.value.size() > 4) {
        const std::size_t at = out_.size();
        out_ += field.value + (field.value.size() % 2 != 0 ? std::string(1, '\0') : std::string());
        field.value = n(at, 4);
      }
      field.value.resize(4, '\0');
      table += n(tag, 2) + n(field.type, 2) + n(field.count, 4) + field.value;
    }
    out_.replace(next_, 4, n(out_.size(), 4));
    next_ = out_.size() + table.size();
    out_ += table + n(0, 4);
  }

  std::string out_;
  std::size_t next_ = 0;  // where the place of the next page stands
};

}  // namespace burr::test
