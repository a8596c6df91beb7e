// The pixels of one DICOM file. Uncompressed ones are read here; compressed ones (JPEG, JPEG-LS,
// JPEG 2000, RLE) are decompressed by GDCM. GDCM gets a small clean file made of the few facts that
// were checked, so that no odd private element and no false length ever reaches it.
#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <mutex>
#include <sstream>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wshadow"
#endif
#include <gdcmImageReader.h>
#include <gdcmTrace.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include "burr/base/printable.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/dicom_header.h"
#include "burr/io/read/dicom_syntaxes.h"

namespace burr::io {
namespace {

// Writes explicit little endian elements of a Part-10 file.
class Writer {
 public:
  void us(std::uint32_t tag, int value) {
    head(tag, "US", 2);
    put16(static_cast<std::uint32_t>(value));
  }
  void text(std::uint32_t tag, const char* vr, std::string value) {
    if (value.size() % 2 != 0) value += std::string(vr) == "UI" ? '\0' : ' ';
    head(tag, vr, static_cast<std::uint32_t>(value.size()));
    out_ += value;
  }
  void pixels(const std::vector<std::uint8_t>& bytes) {
    put16(0x7FE0);
    put16(0x0010);
    out_ += "OB";
    put16(0);
    put32(0xFFFFFFFF);
    out_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  void raw(const std::string& bytes) { out_ += bytes; }
  [[nodiscard]] std::string take() { return std::move(out_); }

 private:
  void head(std::uint32_t tag, const char* vr, std::uint32_t length) {
    put16(tag >> 16);
    put16(tag & 0xFFFF);
    out_ += vr;
    put16(length);
  }
  void put16(std::uint32_t v) {
    out_ += static_cast<char>(v & 0xFF);
    out_ += static_cast<char>(v >> 8 & 0xFF);
  }
  void put32(std::uint32_t v) {
    put16(v & 0xFFFF);
    put16(v >> 16);
  }
  std::string out_;
};

std::uint32_t little32(const std::uint8_t* p) {
  return static_cast<std::uint32_t>(p[0] | p[1] << 8 | p[2] << 16) |
         static_cast<std::uint32_t>(p[3]) << 24;
}

// The fragments in order; the error names what is wrong with the structure. Cuts off what follows
// the end mark.
Result<std::vector<std::pair<std::size_t, std::size_t>>> fragments(
    std::vector<std::uint8_t>& bytes) {
  std::vector<std::pair<std::size_t, std::size_t>> found;  // position, length
  std::size_t at = 0;
  bool table = true;  // the first item is the offset table
  while (at + 8 <= bytes.size()) {
    const std::uint32_t group = little32(&bytes[at]), length = little32(&bytes[at + 4]);
    if (group == 0xE0DDFFFE) {
      bytes.resize(at + 8);
      return found;
    }
    if (group != 0xE000FFFE) return error("its compressed pixels are not stored in fragments");
    if (length > bytes.size() - at - 8) return error("its compressed pixels are cut off");
    if (!table) found.emplace_back(at + 8, length);
    table = false;
    at += 8 + length;
  }
  // a missing end mark is common, and harmless if the last fragment is complete
  if (at != bytes.size() || found.empty()) return error("its compressed pixels are cut off");
  const std::uint8_t end[8] = {0xFE, 0xFF, 0xDD, 0xE0, 0, 0, 0, 0};
  bytes.insert(bytes.end(), end, end + 8);
  return found;
}

// Width and height as the compressed picture itself states them, before a decoder relies on them.
bool picture_size(const std::uint8_t* p, std::size_t n, int& columns, int& rows, int& parts) {
  const auto be16 = [&](std::size_t at) { return p[at] << 8 | p[at + 1]; };
  const auto be32 = [&](std::size_t at) {
    return static_cast<std::int64_t>(be16(at)) << 16 | be16(at + 2);
  };
  if (n > 12 && std::memcmp(p + 4, "jP  ", 4) == 0) {  // JP2 box file: find the codestream
    for (std::size_t at = 0; at + 4 < n; ++at)
      if (p[at] == 0xFF && p[at + 1] == 0x4F && p[at + 2] == 0xFF && p[at + 3] == 0x51)
        return picture_size(p + at, n - at, columns, rows, parts);
    return false;
  }
  if (n > 48 && p[0] == 0xFF && p[1] == 0x4F && p[2] == 0xFF && p[3] == 0x51) {  // JPEG 2000, SIZ
    const std::int64_t w = be32(8) - be32(16), h = be32(12) - be32(20);
    if (w <= 0 || h <= 0 || w > 65535 || h > 65535) return false;
    columns = static_cast<int>(w);
    rows = static_cast<int>(h);
    parts = be16(40);
    return true;
  }
  if (n < 4 || p[0] != 0xFF || p[1] != 0xD8) return false;
  for (std::size_t at = 2; at + 9 < n;) {  // JPEG and JPEG-LS: the start of frame
    if (p[at] != 0xFF) return false;
    const int marker = p[at + 1];
    if (marker == 0xFF) {
      ++at;
      continue;
    }
    const bool frame = marker == 0xF7 || (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 &&
                                          marker != 0xC8 && marker != 0xCC);
    if (frame) {
      rows = be16(at + 5);
      columns = be16(at + 7);
      parts = p[at + 9];
      return true;
    }
    at += 2 + static_cast<std::size_t>(be16(at + 2));
  }
  return false;
}

template <class T>
void widen(const std::uint8_t* from, std::vector<std::int32_t>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    T value;
    std::memcpy(&value, from + i * sizeof(T), sizeof(T));
    to[i] = static_cast<std::int32_t>(value);
  }
}

// Only the stored bits count; the others may hold old overlays. Signed values get their sign.
// Returns how many values had other bits that are neither a sign nor empty.
std::size_t keep_stored_bits(std::vector<std::int32_t>& values, int bits, int high_bit,
                             bool is_signed, int allocated) {
  if (bits >= 32 || bits < 1) return 0;
  const int shift = std::max(0, high_bit - bits + 1);
  const std::uint32_t mask = (std::uint32_t{1} << bits) - 1, sign = std::uint32_t{1} << (bits - 1);
  const std::uint32_t whole =
      allocated >= 32 ? ~std::uint32_t{0} : (std::uint32_t{1} << allocated) - 1;
  const std::uint32_t above = (whole >> shift) & ~mask;
  std::size_t beyond = 0;
  for (std::int32_t& value : values) {
    const std::uint32_t all = static_cast<std::uint32_t>(value) >> shift, over = all & above;
    std::uint32_t v = all & mask;
    const bool negative = is_signed && (v & sign) != 0;
    beyond += over != 0 && !(negative && over == above) ? 1U : 0U;
    if (negative) v |= ~mask;
    value = static_cast<std::int32_t>(v);
  }
  return beyond;
}

void quiet_gdcm() {
  static std::once_flag once;
  std::call_once(once, [] {
    gdcm::Trace::DebugOff();
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
  });
}

Result<std::vector<std::int32_t>> unpack(const DicomHeader& h, std::vector<std::uint8_t> bytes) {
  const std::string file = short_name(h.path);
  auto parts = fragments(bytes);
  if (!parts) return error(fmt::format("{}: {}", file, parts.error().text));
  const bool rle = h.transfer_syntax == "1.2.840.10008.1.2.5";
  if (!rle) {
    // A picture may span fragments, but its header is always at the beginning of one. A short first
    // fragment is joined with what follows.
    std::vector<std::uint8_t> head;
    for (const auto& [at, length] : *parts) {
      head.insert(head.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                  bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
      if (head.size() > 65536) break;
    }
    int columns = 0, rows = 0, colours = 0;
    if (!picture_size(head.data(), head.size(), columns, rows, colours))
      return error(
          fmt::format("{}: its compressed pixels do not have the format of the transfer syntax "
                      "({}); export the scan again",
                      file, base::printable(h.transfer_syntax)));
    if (columns != h.columns || rows != h.rows || colours != 1)
      return error(
          fmt::format("{}: its compressed picture has {} x {} pixels of {} channels, but the "
                      "header states {} x {} of one; export the scan again",
                      file, columns, rows, colours, h.columns, h.rows));
  }

  Writer w;
  std::string preamble(128, '\0');
  preamble += "DICM";
  w.raw(preamble);
  // OpenJPEG decodes High-Throughput JPEG 2000 too, and GDCM hands it what is called JPEG 2000
  const bool high = is_high_throughput(h.transfer_syntax);
  w.text(0x00020010, "UI", high ? "1.2.840.10008.1.2.4.91" : h.transfer_syntax);
  w.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2");
  w.text(0x00080060, "CS", "CT");
  w.us(0x00280002, 1);
  w.text(0x00280004, "CS", "MONOCHROME2");
  if (h.frame_count > 1) w.text(0x00280008, "IS", std::to_string(h.frame_count));
  w.us(0x00280010, h.rows);
  w.us(0x00280011, h.columns);
  w.us(0x00280100, h.bits_allocated);
  w.us(0x00280101, h.bits_stored);
  w.us(0x00280102, h.high_bit);
  w.us(0x00280103, h.is_signed ? 1 : 0);
  w.pixels(bytes);
  std::vector<std::uint8_t>().swap(bytes);

  quiet_gdcm();
  std::istringstream stream(w.take());
  gdcm::ImageReader reader;
  reader.SetStream(stream);
  const auto failed = [&] {
    return error(
        fmt::format("{}: its compressed pixels (transfer syntax {}) cannot be decompressed; they "
                    "are damaged or in a format that burr does not read",
                    file, base::printable(h.transfer_syntax)));
  };
  if (!reader.Read()) return failed();
  const gdcm::Image& image = reader.GetImage();
  const gdcm::PixelFormat format = image.GetPixelFormat();
  const std::size_t count = static_cast<std::size_t>(h.rows) * static_cast<std::size_t>(h.columns) *
                            static_cast<std::size_t>(h.frame_count);
  const std::size_t width = format.GetBitsAllocated() / 8U;
  if (format.GetSamplesPerPixel() != 1 || (width != 1 && width != 2 && width != 4) ||
      image.GetBufferLength() != count * width)
    return failed();
  std::vector<char> buffer(count * width);
  if (!image.GetBuffer(buffer.data())) return failed();
  std::vector<std::int32_t> values(count);
  const auto* from = reinterpret_cast<const std::uint8_t*>(buffer.data());
  const bool is_signed = format.GetPixelRepresentation() == 1;
  if (width == 1)
    is_signed ? widen<std::int8_t>(from, values) : widen<std::uint8_t>(from, values);
  else if (width == 2)
    is_signed ? widen<std::int16_t>(from, values) : widen<std::uint16_t>(from, values);
  else
    widen<std::int32_t>(from, values);
  (void)keep_stored_bits(values, format.GetBitsStored(), format.GetBitsStored() - 1, is_signed,
                         static_cast<int>(8 * width));
  return values;
}

}  // namespace

Result<std::unique_ptr<ByteSource>> open_dicom_pixels(const DicomHeader& h) {
  // the bytes, from the file or from its inflated data set
  auto opened = open_file(h.path, h.deflated ? 0 : h.pixels_at);
  if (!opened) return opened.error();
  std::unique_ptr<ByteSource> source = std::move(opened->source);
  if (h.deflated) {
    // find the compressed part again: after the meta header
    auto head = first_bytes(h.path, 65536);
    if (!head) return head.error();
    std::size_t at = 132;
    while (at + 8 <= head->size() && (*head)[at] == 2 && (*head)[at + 1] == 0) {
      const bool wide = (*head)[at + 4] == 'O' && (*head)[at + 5] == 'B';
      if (wide && at + 12 > head->size()) break;
      at += wide ? 12 + std::size_t{little32(&(*head)[at + 8])}
                 : 8 + static_cast<std::size_t>((*head)[at + 6] | (*head)[at + 7] << 8);
    }
    opened = open_file(h.path, at);
    if (!opened) return opened.error();
    source = inflate_raw(std::move(opened->source));
    if (Status status = skip(*source, h.pixels_at); !status)
      return error(fmt::format("{}: {}", short_name(h.path), status.error().text));
  }
  return source;
}

Result<std::vector<std::uint8_t>> inflate_dicom_frames(const DicomHeader& h,
                                                       std::size_t frame_bytes) {
  const std::string file = short_name(h.path);
  auto source = open_dicom_pixels(h);
  if (!source) return source.error();
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(h.pixels_length));
  if (Status status = read_exactly(**source, bytes.data(), bytes.size()); !status)
    return error(fmt::format("{}: {}", file, status.error().text));
  const auto parts = fragments(bytes);
  if (!parts) return error(fmt::format("{}: {}", file, parts.error().text));
  if (parts->size() != static_cast<std::size_t>(h.frame_count))
    return error(
        fmt::format("{}: its compressed pixels are in {} parts, but it states {} frames; "
                    "export it again",
                    file, parts->size(), h.frame_count));
  for (const auto& [at, length] : *parts)
    if (frame_bytes > length * kMostGzip)
      return error(
          fmt::format("{}: {} bytes of compressed pixels cannot hold a frame of {} bytes; "
                      "copy it again",
                      file, length, frame_bytes));
  std::vector<std::uint8_t> out(frame_bytes * parts->size());
  for (std::size_t f = 0; f < parts->size(); ++f) {
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>((*parts)[f].first);
    const auto inflating = inflate_raw(
        memory_source({begin, begin + static_cast<std::ptrdiff_t>((*parts)[f].second)}));
    if (Status status = read_exactly(*inflating, out.data() + f * frame_bytes, frame_bytes);
        !status)
      return error(fmt::format("{}: frame {}: {}", file, f + 1, status.error().text));
  }
  return out;
}

Result<std::vector<std::int32_t>> read_dicom_pixels(const DicomHeader& h, std::size_t* beyond) {
  const std::string file = short_name(h.path);
  const std::size_t count = static_cast<std::size_t>(h.rows) * static_cast<std::size_t>(h.columns) *
                            static_cast<std::size_t>(h.frame_count);
  const auto width = static_cast<std::size_t>(h.bits_allocated / 8);
  auto opened = open_dicom_pixels(h);
  if (!opened) return opened.error();
  const std::unique_ptr<ByteSource> source = std::move(*opened);

  const bool frames = h.transfer_syntax == kDeflatedFrames && h.encapsulated;
  if (h.encapsulated && !frames) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(h.pixels_length));
    if (Status status = read_exactly(*source, bytes.data(), bytes.size()); !status)
      return error(fmt::format("{}: {}", file, status.error().text));
    return unpack(h, std::move(bytes));
  }

  if (!frames && h.pixels_length < count * width)
    return error(
        fmt::format("{}: Pixel Data has {} bytes, but {} x {} pixels need {}; the file is cut off, "
                    "copy it again",
                    file, h.pixels_length, h.columns, h.rows, count * width));
  std::vector<std::uint8_t> bytes;
  if (frames) {
    auto inflated = inflate_dicom_frames(
        h, width * static_cast<std::size_t>(h.rows) * static_cast<std::size_t>(h.columns));
    if (!inflated) return inflated.error();
    bytes = std::move(*inflated);
  } else {
    bytes.resize(count * width);
    if (Status status = read_exactly(*source, bytes.data(), bytes.size()); !status)
      return error(fmt::format("{}: {}", file, status.error().text));
  }
  if (h.big_endian && width > 1)
    for (std::size_t i = 0; i < bytes.size(); i += width)
      std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                   bytes.begin() + static_cast<std::ptrdiff_t>(i + width));
  std::vector<std::int32_t> values(count);
  if (width == 1)
    widen<std::uint8_t>(bytes.data(), values);
  else if (width == 2)
    widen<std::uint16_t>(bytes.data(), values);
  else
    widen<std::int32_t>(bytes.data(), values);
  const std::size_t over =
      keep_stored_bits(values, h.bits_stored, h.high_bit, h.is_signed, h.bits_allocated);
  if (beyond != nullptr) *beyond = over;
  return values;
}

}  // namespace burr::io
