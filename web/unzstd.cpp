#include "unzstd.h"

#include <algorithm>
#include <array>
#include <bit>

namespace burr::web {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint32_t kMagic = 0xFD2FB528;
constexpr std::size_t kMostBlock = 128 * 1024;
constexpr int kMostHuffmanBits = 11, kMostLengths = 52, kMostOffsets = 31;

std::uint64_t little(Bytes bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t n = 0; n < count && at + n < bytes.size(); ++n)
    value |= std::uint64_t{bytes[at + n]} << (8 * n);
  return value;
}

int bits_of(std::uint32_t value) { return static_cast<int>(std::bit_width(value)); }

// Bits from the front, lowest first: the description of an FSE table.
class Forward {
 public:
  explicit Forward(Bytes bytes) : bytes_(bytes) {}
  std::uint32_t peek(int count) const {
    const auto word = little(bytes_, at_ / 8, 8) >> (at_ % 8);
    return static_cast<std::uint32_t>(word & ((std::uint64_t{1} << count) - 1));
  }
  void skip(int count) { at_ += static_cast<std::size_t>(count); }
  std::uint32_t take(int count) {
    const std::uint32_t value = peek(count);
    skip(count);
    return value;
  }
  [[nodiscard]] std::size_t bytes() const { return (at_ + 7) / 8; }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
};

// Bits from the back: codes of Huffman and FSE. Beyond the front there are zeros.
class Backward {
 public:
  explicit Backward(Bytes bytes) : bytes_(bytes) {
    if (bytes.empty() || bytes.back() == 0) {
      good_ = false;
      return;
    }
    left_ = 8 * static_cast<std::int64_t>(bytes.size()) - 9 + bits_of(bytes.back());
  }
  [[nodiscard]] bool good() const { return good_; }
  // bits that are left; below 0: so many more were taken than there were
  [[nodiscard]] std::int64_t left() const { return left_; }
  std::uint64_t peek(int count) const {
    if (count == 0) return 0;
    const std::int64_t from = left_ - count;
    const std::uint64_t mask = (std::uint64_t{1} << count) - 1;
    if (from < 0) {
      if (left_ <= 0) return 0;
      return (little(bytes_, 0, 8) & ((std::uint64_t{1} << left_) - 1)) << -from & mask;
    }
    const auto at = static_cast<std::size_t>(from);
    return little(bytes_, at / 8, 8) >> (at % 8) & mask;
  }
  void skip(int count) { left_ -= count; }
  std::uint64_t take(int count) {
    const std::uint64_t value = peek(count);
    skip(count);
    return value;
  }

 private:
  Bytes bytes_;
  std::int64_t left_ = 0;
  bool good_ = true;
};

// ---- FSE

struct Fse {
  struct Cell {
    std::uint8_t symbol = 0, bits = 0;
    std::uint16_t base = 0;
  };
  std::vector<Cell> cells;  // 2^log; empty: there is no table
  int log = 0;
};

bool build(Fse& fse, std::span<const int> shares, int log) {
  const std::size_t size = std::size_t{1} << log;
  fse.log = log;
  fse.cells.assign(size, {});
  std::array<std::uint32_t, 256> next{};
  std::size_t high = size;
  for (std::size_t s = 0; s < shares.size(); ++s)
    if (shares[s] == -1) {
      if (high == 0) return false;
      fse.cells[--high].symbol = static_cast<std::uint8_t>(s);
      next[s] = 1;
    }
  const std::size_t step = (size >> 1) + (size >> 3) + 3;
  std::size_t at = 0;
  for (std::size_t s = 0; s < shares.size(); ++s) {
    if (shares[s] <= 0) continue;
    next[s] = static_cast<std::uint32_t>(shares[s]);
    for (int n = 0; n < shares[s]; ++n) {
      fse.cells[at].symbol = static_cast<std::uint8_t>(s);
      do at = (at + step) & (size - 1);
      while (at >= high);
    }
  }
  if (at != 0) return false;
  for (Fse::Cell& cell : fse.cells) {
    const std::uint32_t state = next[cell.symbol]++;
    const int bits = log - (bits_of(state) - 1);
    if (bits < 0 || bits > log) return false;
    cell.bits = static_cast<std::uint8_t>(bits);
    cell.base = static_cast<std::uint16_t>((state << bits) - size);
  }
  return true;
}

// Reads the shares of the symbols (4.1.1). took: bytes of the description.
bool read_fse(Fse& fse, Bytes bytes, int most_log, int most_symbol, std::size_t& took) {
  Forward in(bytes);
  const int log = static_cast<int>(in.take(4)) + 5;
  if (log > most_log) return false;
  std::vector<int> shares;
  int left = 1 << log;  // still to be shared out
  while (left > 0 && static_cast<int>(shares.size()) <= most_symbol) {
    const int bits = bits_of(static_cast<std::uint32_t>(left + 1));
    const std::uint32_t value = in.peek(bits);
    const std::uint32_t low = value & ((1U << (bits - 1)) - 1);
    const std::uint32_t spare = (1U << bits) - 1 - static_cast<std::uint32_t>(left + 1);
    std::uint32_t share = 0;
    if (low < spare) {
      in.skip(bits - 1);
      share = low;
    } else {
      in.skip(bits);
      share = value >= (1U << (bits - 1)) ? value - spare : value;
    }
    const int part = static_cast<int>(share) - 1;
    shares.push_back(part);
    left -= part < 0 ? 1 : part;
    if (part != 0) continue;
    for (std::uint32_t more = 3; more == 3;) {
      more = in.take(2);
      if (static_cast<int>(shares.size() + more) > most_symbol + 1) return false;
      shares.insert(shares.end(), more, 0);
    }
  }
  took = in.bytes();
  if (left != 0 || took > bytes.size()) return false;
  return build(fse, shares, log);
}

Fse one_symbol(std::uint8_t symbol) {
  Fse fse;
  fse.cells.push_back({symbol, 0, 0});
  return fse;
}

// ---- Huffman

struct Huffman {
  struct Cell {
    std::uint8_t symbol = 0, bits = 0;
  };
  std::vector<Cell> cells;  // 2^log; empty: there is no tree
  int log = 0;
};

bool build(Huffman& tree, std::vector<int>& weights) {
  std::uint32_t sum = 0;
  for (const int weight : weights) {
    if (weight > kMostHuffmanBits) return false;
    if (weight > 0) sum += 1U << (weight - 1);
  }
  if (sum == 0) return false;
  const int log = bits_of(sum);
  const std::uint32_t rest = (1U << log) - sum;
  if (log > kMostHuffmanBits || !std::has_single_bit(rest)) return false;
  weights.push_back(bits_of(rest));  // of the last symbol: what is left
  if (weights.size() > 256) return false;
  tree.log = log;
  tree.cells.assign(std::size_t{1} << log, {});
  std::size_t at = 0;
  for (int weight = 1; weight <= log; ++weight)
    for (std::size_t s = 0; s < weights.size(); ++s) {
      if (weights[s] != weight) continue;
      const std::size_t many = std::size_t{1} << (weight - 1);
      if (at + many > tree.cells.size()) return false;
      std::fill_n(
          tree.cells.begin() + static_cast<std::ptrdiff_t>(at), many,
          Huffman::Cell{static_cast<std::uint8_t>(s), static_cast<std::uint8_t>(log + 1 - weight)});
      at += many;
    }
  return at == tree.cells.size();
}

// The weights, packed by FSE with two states in turn.
bool packed_weights(Bytes bytes, std::vector<int>& weights) {
  Fse fse;
  std::size_t took = 0;
  if (!read_fse(fse, bytes, 6, 255, took)) return false;
  Backward in(bytes.subspan(took));
  if (!in.good()) return false;
  std::array<std::size_t, 2> state{};
  for (std::size_t& one : state) one = static_cast<std::size_t>(in.take(fse.log));
  for (int which = 0; weights.size() < 255; which ^= 1) {
    const Fse::Cell& cell = fse.cells[state[static_cast<std::size_t>(which)]];
    weights.push_back(cell.symbol);
    state[static_cast<std::size_t>(which)] =
        cell.base + static_cast<std::size_t>(in.take(cell.bits));
    if (in.left() >= 0) continue;
    weights.push_back(fse.cells[state[static_cast<std::size_t>(which ^ 1)]].symbol);
    return true;
  }
  return false;
}

bool read_huffman(Huffman& tree, Bytes bytes, std::size_t& took) {
  if (bytes.empty()) return false;
  std::vector<int> weights;
  const std::size_t head = bytes[0];
  if (head < 128) {
    took = 1 + head;
    if (took > bytes.size() || !packed_weights(bytes.subspan(1, head), weights)) return false;
  } else {
    const std::size_t count = head - 127;
    took = 1 + (count + 1) / 2;
    if (took > bytes.size()) return false;
    for (std::size_t n = 0; n < count; ++n)
      weights.push_back(n % 2 == 0 ? bytes[1 + n / 2] >> 4 : bytes[1 + n / 2] & 15);
  }
  return build(tree, weights);
}

bool huffman_stream(const Huffman& tree, Bytes bytes, std::uint8_t* out, std::size_t count) {
  Backward in(bytes);
  if (!in.good()) return false;
  for (std::size_t n = 0; n < count; ++n) {
    const Huffman::Cell& cell = tree.cells[static_cast<std::size_t>(in.peek(tree.log))];
    out[n] = cell.symbol;
    in.skip(cell.bits);
  }
  return in.left() == 0;
}

// ---- a block

constexpr std::array<std::uint32_t, 36> kLiteralBase = {
    0,  1,  2,  3,  4,  5,  6,  7,  8,   9,   10,  11,   12,   13,   14,   15,    16,    18,
    20, 22, 24, 28, 32, 40, 48, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768, 65536};
constexpr std::array<std::uint8_t, 36> kLiteralBits = {0, 0, 0, 0, 0, 0,  0,  0,  0,  0,  0,  0,
                                                       0, 0, 0, 0, 1, 1,  1,  1,  2,  2,  3,  3,
                                                       4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
constexpr std::array<std::uint32_t, 53> kMatchBase = {
    3,  4,  5,  6,  7,  8,  9,  10,  11,  12,  13,   14,   15,   16,   17,    18,    19,   20,
    21, 22, 23, 24, 25, 26, 27, 28,  29,  30,  31,   32,   33,   34,   35,    37,    39,   41,
    43, 47, 51, 59, 67, 83, 99, 131, 259, 515, 1027, 2051, 4099, 8195, 16387, 32771, 65539};
constexpr std::array<std::uint8_t, 53> kMatchBits = {
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,  0,  0,  0,  0,  0,  0, 0,
    0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 3, 3, 4, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
constexpr std::array<int, 36> kLiteralShares = {4, 3, 2, 2, 2, 2, 2, 2, 2,  2,  2,  2,
                                                2, 1, 1, 1, 2, 2, 2, 2, 2,  2,  2,  2,
                                                2, 3, 2, 1, 1, 1, 1, 1, -1, -1, -1, -1};
constexpr std::array<int, 53> kMatchShares = {
    1, 4, 3, 2, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,  1,  1,  1,  1,  1,  1, 1,
    1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1, -1, -1};
constexpr std::array<int, 29> kOffsetShares = {1, 1, 1, 1, 1, 1, 2, 2, 2, 1,  1,  1,  1,  1, 1,
                                               1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1};

class Frame {
 public:
  Frame(std::vector<std::uint8_t>& out, std::size_t size) : out_(out), size_(size) {}
  [[nodiscard]] bool block(Bytes bytes);

 private:
  [[nodiscard]] bool literals(Bytes& bytes);
  [[nodiscard]] bool packed_literals(Bytes& bytes, bool own_tree);
  [[nodiscard]] bool table(Fse& fse, int mode, std::span<const int> usual, int usual_log,
                           int most_log, int most_symbol, Bytes& bytes);
  [[nodiscard]] bool sequences(Bytes bytes);
  [[nodiscard]] bool run(Bytes bytes, std::size_t count);
  [[nodiscard]] std::size_t offset_of(std::uint64_t value, std::size_t literal_length);
  [[nodiscard]] bool copy_literals(std::size_t count);
  [[nodiscard]] bool copy_match(std::size_t far, std::size_t count);

  std::vector<std::uint8_t>& out_;
  std::size_t size_;
  Huffman tree_;
  Fse literal_lengths_, match_lengths_, offsets_;
  std::array<std::size_t, 3> before_ = {1, 4, 8};  // offsets
  std::vector<std::uint8_t> literals_;
  std::size_t used_ = 0;  // of them
};

bool Frame::block(Bytes bytes) {
  used_ = 0;
  return literals(bytes) && sequences(bytes);
}

bool Frame::literals(Bytes& bytes) {
  if (bytes.empty()) return false;
  const int kind = bytes[0] & 3, form = bytes[0] >> 2 & 3;
  if (kind >= 2) return packed_literals(bytes, kind == 2);
  const std::size_t head = form == 1 ? 2 : form == 3 ? 3 : 1;
  if (head > bytes.size()) return false;
  const auto count = static_cast<std::size_t>(little(bytes, 0, head) >> (head == 1 ? 3 : 4));
  const std::size_t took = kind == 1 ? 1 : count;
  if (count > kMostBlock || head + took > bytes.size()) return false;
  if (kind == 1)
    literals_.assign(count, bytes[head]);
  else
    literals_.assign(bytes.begin() + static_cast<std::ptrdiff_t>(head),
                     bytes.begin() + static_cast<std::ptrdiff_t>(head + count));
  bytes = bytes.subspan(head + took);
  return true;
}

bool Frame::packed_literals(Bytes& bytes, bool own_tree) {
  const int form = bytes[0] >> 2 & 3;
  const std::size_t head = form < 2 ? 3 : form == 2 ? 4 : 5;
  const int wide = form < 2 ? 10 : form == 2 ? 14 : 18;
  if (head > bytes.size()) return false;
  const std::uint64_t word = little(bytes, 0, head) >> 4, mask = (std::uint64_t{1} << wide) - 1;
  const auto count = static_cast<std::size_t>(word & mask);
  const auto packed = static_cast<std::size_t>(word >> wide & mask);
  if (count > kMostBlock || head + packed > bytes.size()) return false;
  Bytes body = bytes.subspan(head, packed);
  bytes = bytes.subspan(head + packed);
  if (own_tree) {
    std::size_t took = 0;
    if (!read_huffman(tree_, body, took)) return false;
    body = body.subspan(took);
  }
  if (tree_.cells.empty()) return false;
  literals_.resize(count);
  if (form == 0) return huffman_stream(tree_, body, literals_.data(), count);
  if (body.size() < 6) return false;
  std::size_t at = 6;
  const std::size_t each = (count + 3) / 4;
  if (3 * each > count) return false;
  for (std::size_t n = 0; n < 4; ++n) {
    const std::size_t length =
        n < 3 ? static_cast<std::size_t>(little(body, 2 * n, 2)) : body.size() - at;
    if (at + length > body.size()) return false;
    if (!huffman_stream(tree_, body.subspan(at, length), literals_.data() + n * each,
                        n < 3 ? each : count - 3 * each))
      return false;
    at += length;
  }
  return true;
}

bool Frame::table(Fse& fse, int mode, std::span<const int> usual, int usual_log, int most_log,
                  int most_symbol, Bytes& bytes) {
  if (mode == 0) return build(fse, usual, usual_log);
  if (mode == 1) {
    if (bytes.empty() || bytes[0] > most_symbol) return false;
    fse = one_symbol(bytes[0]);
    bytes = bytes.subspan(1);
    return true;
  }
  if (mode == 3) return !fse.cells.empty();
  std::size_t took = 0;
  if (!read_fse(fse, bytes, most_log, most_symbol, took)) return false;
  bytes = bytes.subspan(took);
  return true;
}

bool Frame::sequences(Bytes bytes) {
  if (bytes.empty()) return false;
  std::size_t count = bytes[0], head = 1;
  if (count >= 128) {
    head = count == 255 ? 3 : 2;
    if (head > bytes.size()) return false;
    count = count == 255 ? static_cast<std::size_t>(little(bytes, 1, 2)) + 0x7F00
                         : ((count - 128) << 8) + bytes[1];
  }
  bytes = bytes.subspan(head);
  if (count == 0) return bytes.empty() && copy_literals(literals_.size());
  if (bytes.empty()) return false;
  const int modes = bytes[0];
  bytes = bytes.subspan(1);
  if ((modes & 3) != 0 || !table(literal_lengths_, modes >> 6, kLiteralShares, 6, 9, 35, bytes) ||
      !table(offsets_, modes >> 4 & 3, kOffsetShares, 5, 8, kMostOffsets, bytes) ||
      !table(match_lengths_, modes >> 2 & 3, kMatchShares, 6, 9, kMostLengths, bytes))
    return false;
  return run(bytes, count);
}

bool Frame::run(Bytes bytes, std::size_t count) {
  Backward in(bytes);
  if (!in.good()) return false;
  auto literal = static_cast<std::size_t>(in.take(literal_lengths_.log));
  auto offset = static_cast<std::size_t>(in.take(offsets_.log));
  auto match = static_cast<std::size_t>(in.take(match_lengths_.log));
  for (std::size_t n = 0; n < count; ++n) {
    const Fse::Cell& l = literal_lengths_.cells[literal];
    const Fse::Cell& o = offsets_.cells[offset];
    const Fse::Cell& m = match_lengths_.cells[match];
    if (o.symbol > kMostOffsets) return false;
    const std::uint64_t value = (std::uint64_t{1} << o.symbol) + in.take(o.symbol);
    const std::size_t match_length =
        kMatchBase[m.symbol] + static_cast<std::size_t>(in.take(kMatchBits[m.symbol]));
    const std::size_t literal_length =
        kLiteralBase[l.symbol] + static_cast<std::size_t>(in.take(kLiteralBits[l.symbol]));
    if (n + 1 < count) {
      literal = l.base + static_cast<std::size_t>(in.take(l.bits));
      match = m.base + static_cast<std::size_t>(in.take(m.bits));
      offset = o.base + static_cast<std::size_t>(in.take(o.bits));
    }
    if (in.left() < 0) return false;
    const std::size_t far = offset_of(value, literal_length);
    if (!copy_literals(literal_length) || !copy_match(far, match_length)) return false;
  }
  return in.left() == 0 && copy_literals(literals_.size() - used_);
}

// 0: there is none.
std::size_t Frame::offset_of(std::uint64_t value, std::size_t literal_length) {
  if (value > 3) {
    before_ = {static_cast<std::size_t>(value - 3), before_[0], before_[1]};
    return before_[0];
  }
  const std::size_t which = static_cast<std::size_t>(value) - 1 + (literal_length == 0 ? 1 : 0);
  if (which == 0) return before_[0];
  const std::size_t far = which < 3 ? before_[which] : before_[0] - 1;
  if (which > 1) before_[2] = before_[1];
  before_[1] = before_[0];
  before_[0] = far;
  return far;
}

bool Frame::copy_literals(std::size_t count) {
  if (count > literals_.size() - used_ || count > size_ - out_.size()) return false;
  const auto from = literals_.begin() + static_cast<std::ptrdiff_t>(used_);
  out_.insert(out_.end(), from, from + static_cast<std::ptrdiff_t>(count));
  used_ += count;
  return true;
}

bool Frame::copy_match(std::size_t far, std::size_t count) {
  if (far == 0 || far > out_.size() || count > size_ - out_.size()) return false;
  for (std::size_t n = 0; n < count; ++n) out_.push_back(out_[out_.size() - far]);
  return true;
}

}  // namespace

bool unzstd(Bytes packed, std::size_t size, std::vector<std::uint8_t>& out) {
  out.clear();
  if (packed.size() < 5 || little(packed, 0, 4) != kMagic) return false;
  const int head = packed[4];
  const bool whole = (head & 0x20) != 0, summed = (head & 4) != 0;
  if ((head & 8) != 0 || (head & 3) != 0) return false;  // reserved; a dictionary
  const int kind = head >> 6;
  const std::size_t promised = kind == 0 ? (whole ? 1 : 0) : std::size_t{1} << kind;
  std::size_t at = 5 + (whole ? 0U : 1U) + promised;
  if (at > packed.size()) return false;
  if (promised > 0 && little(packed, at - promised, promised) + (promised == 2 ? 256 : 0) != size)
    return false;
  Frame frame(out, size);
  for (bool last = false; !last;) {
    if (at + 3 > packed.size()) return false;
    const auto block = static_cast<std::uint32_t>(little(packed, at, 3));
    at += 3;
    last = (block & 1) != 0;
    const std::uint32_t type = block >> 1 & 3;
    const std::size_t length = block >> 3, took = type == 1 ? 1 : length;
    if (length > kMostBlock || type == 3 || at + took > packed.size()) return false;
    if (type < 2 && length > size - out.size()) return false;
    if (type == 0)
      out.insert(out.end(), packed.begin() + static_cast<std::ptrdiff_t>(at),
                 packed.begin() + static_cast<std::ptrdiff_t>(at + length));
    else if (type == 1)
      out.insert(out.end(), length, packed[at]);
    else if (!frame.block(packed.subspan(at, length)))
      return false;
    at += took;
  }
  return at + (summed ? 4 : 0) == packed.size() && out.size() == size;
}

}  // namespace burr::web
