// Lossless JPEG (ITU-T T.81, annex H): each value as its difference from neighbours, in Huffman codes.
#include <algorithm>
#include <array>

#include "unpack.h"

namespace burr::web {
namespace {

using Bytes = std::span<const std::uint8_t>;

// Bits of a scan, the highest first. Behind its end come zeros.
class Bits {
 public:
  Bits(Bytes bytes, std::size_t at) : bytes_(bytes), at_(at) {}
  unsigned bit() {
    if (left_ == 0) fill();
    --left_;
    return now_ >> left_ & 1U;
  }
  unsigned bits(int count) {
    unsigned value = 0;
    for (int n = 0; n < count; ++n) value = value << 1 | bit();
    return value;
  }
  // Bits were asked for that are not there.
  [[nodiscard]] bool ended() const { return missing_ > 8; }
  // Goes behind the next restart mark. False: there is none.
  bool restart() {
    left_ = 0;
    while (at_ + 1 < bytes_.size() &&
           !(bytes_[at_] == 0xFF && bytes_[at_ + 1] >= 0xD0 && bytes_[at_ + 1] <= 0xD7)) {
      if (bytes_[at_] == 0xFF && bytes_[at_ + 1] != 0 && bytes_[at_ + 1] != 0xFF) return false;
      ++at_;
    }
    if (at_ + 1 >= bytes_.size()) return false;
    at_ += 2;
    return true;
  }

 private:
  void fill() {
    now_ = 0;
    left_ = 8;
    if (at_ >= bytes_.size()) {
      ++missing_;
      return;
    }
    if (bytes_[at_] == 0xFF) {
      if (at_ + 1 >= bytes_.size() || bytes_[at_ + 1] != 0) {  // a mark: the scan has ended
        ++missing_;
        return;
      }
      now_ = 0xFF;
      at_ += 2;
      return;
    }
    now_ = bytes_[at_++];
  }
  Bytes bytes_;
  std::size_t at_;
  unsigned now_ = 0;
  int left_ = 0, missing_ = 0;
};

// Huffman codes as the file lists them: how many of each length, then their symbols.
struct Codes {
  std::array<int, 17> count{};
  std::vector<std::uint8_t> symbols;

  // -1: there is no such code.
  int read(Bits& bits) const {
    int code = 0, first = 0, index = 0;
    for (std::size_t length = 1; length <= 16; ++length) {
      code |= static_cast<int>(bits.bit());
      if (code - first < count[length])
        return symbols[static_cast<std::size_t>(index + code - first)];
      index += count[length];
      first = (first + count[length]) << 1;
      code <<= 1;
    }
    return -1;
  }
};

struct Head {
  int precision = 0, columns = 0, rows = 0, table = 0, predictor = 0, shift = 0, interval = 0;
  std::array<Codes, 4> codes;
  std::size_t scan = 0;  // where its bits begin
};

bool read_codes(Bytes part, Head& head) {
  std::size_t at = 0;
  while (at + 17 <= part.size()) {
    if ((part[at] & 15) > 3) return false;
    Codes& codes = head.codes[part[at] & 15U];
    std::size_t all = 0;
    for (std::size_t n = 1; n <= 16; ++n) all += part[at + n];
    if (all > 256 || at + 17 + all > part.size()) return false;
    codes.symbols.assign(part.begin() + static_cast<std::ptrdiff_t>(at + 17),
                         part.begin() + static_cast<std::ptrdiff_t>(at + 17 + all));
    for (std::size_t n = 1; n <= 16; ++n) codes.count[n] = part[at + n];
    at += 17 + all;
  }
  return at == part.size();
}

bool read_head(Bytes bytes, Head& head) {
  const auto two = [&](std::size_t at) { return bytes[at] << 8 | bytes[at + 1]; };
  if (bytes.size() < 4 || two(0) != 0xFFD8) return false;
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    if (bytes[at] != 0xFF) return false;
    const int mark = bytes[at + 1];
    if (mark == 0xFF) {
      ++at;
      continue;
    }
    const auto length = static_cast<std::size_t>(two(at + 2));
    if (length < 2 || at + 2 + length > bytes.size()) return false;
    const Bytes part = bytes.subspan(at + 4, length - 2);
    at += 2 + length;
    if (mark == 0xC3) {
      if (part.size() < 9 || part[5] != 1) return false;
      head.precision = part[0];
      head.rows = part[1] << 8 | part[2];
      head.columns = part[3] << 8 | part[4];
    } else if (mark == 0xC4) {
      if (!read_codes(part, head)) return false;
    } else if (mark == 0xDD) {
      if (part.size() < 2) return false;
      head.interval = part[0] << 8 | part[1];
    } else if (mark == 0xDA) {
      if (part.size() < 6 || part[0] != 1 || head.precision < 2 || head.precision > 16)
        return false;
      head.table = part[2] >> 4;
      head.predictor = part[3];
      head.shift = part[5] & 15;
      head.scan = at;
      return head.table <= 3 && head.predictor >= 1 && head.predictor <= 7 &&
             head.shift < head.precision;
    } else if (mark >= 0xC0 && mark <= 0xCF && mark != 0xC8 && mark != 0xCC) {
      return false;  // another kind of JPEG
    }
  }
  return false;
}

int predicted(int predictor, int a, int b, int c) {
  switch (predictor) {
    case 1:
      return a;
    case 2:
      return b;
    case 3:
      return c;
    case 4:
      return a + b - c;
    case 5:
      return a + ((b - c) >> 1);
    case 6:
      return b + ((a - c) >> 1);
    default:
      return (a + b) >> 1;
  }
}

// False: the bits are no difference.
bool read_difference(const Codes& codes, Bits& bits, int& difference) {
  const int size = codes.read(bits);
  if (size < 0 || size > 16) return false;
  difference = 0;
  if (size == 16) difference = 32768;
  if (size == 0 || size == 16) return true;
  const auto value = static_cast<int>(bits.bits(size));
  difference = value >= 1 << (size - 1) ? value : value - (1 << size) + 1;
  return true;
}

}  // namespace

bool unpack_jpeg_lossless(Bytes bytes, Unpacked& to) {
  Head head;
  if (!read_head(bytes, head) || head.columns != to.columns || head.rows != to.rows) return false;
  const auto wide = static_cast<std::size_t>(to.columns);
  // a restart begins a line anew
  if (head.interval % std::max(1, to.columns) != 0) return false;
  const int lines = head.interval / std::max(1, to.columns);
  to.values.assign(wide * static_cast<std::size_t>(to.rows), 0);
  Bits bits(bytes, head.scan);
  const Codes& codes = head.codes[static_cast<std::size_t>(head.table)];
  int since = 0;  // lines since the start or a restart
  for (int y = 0; y < to.rows; ++y, ++since) {
    if (lines > 0 && since == lines) {
      if (!bits.restart()) return false;
      since = 0;
    }
    std::int32_t* row = &to.values[static_cast<std::size_t>(y) * wide];
    for (std::size_t x = 0; x < wide; ++x) {
      int before = 1 << (head.precision - head.shift - 1);
      if (since == 0 && x > 0) before = row[x - 1];
      if (since > 0) {
        const std::int32_t* above = row - wide;
        before = x == 0 ? above[0] : predicted(head.predictor, row[x - 1], above[x], above[x - 1]);
      }
      int difference = 0;
      if (!read_difference(codes, bits, difference)) return false;
      row[x] = (before + difference) & 0xFFFF;
    }
    if (bits.ended()) return false;
  }
  for (std::int32_t& one : to.values) one = one << head.shift & 0xFFFF;
  return true;
}

}  // namespace burr::web
