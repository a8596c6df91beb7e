#include "jpeg_2000_blocks.h"

#include <algorithm>
#include <array>

namespace burr::web {
namespace {

// Table C.2: probability, next state after the more and the less probable symbol, whether they change places.
struct State {
  std::uint16_t q;
  std::uint8_t more, less, swap;
};
constexpr std::array<State, 47> kStates = {{
    {0x5601, 1, 1, 1},   {0x3401, 2, 6, 0},   {0x1801, 3, 9, 0},   {0x0AC1, 4, 12, 0},
    {0x0521, 5, 29, 0},  {0x0221, 38, 33, 0}, {0x5601, 7, 6, 1},   {0x5401, 8, 14, 0},
    {0x4801, 9, 14, 0},  {0x3801, 10, 14, 0}, {0x3001, 11, 17, 0}, {0x2401, 12, 18, 0},
    {0x1C01, 13, 20, 0}, {0x1601, 29, 21, 0}, {0x5601, 15, 14, 1}, {0x5401, 16, 14, 0},
    {0x5101, 17, 15, 0}, {0x4801, 18, 16, 0}, {0x3801, 19, 17, 0}, {0x3401, 20, 18, 0},
    {0x3001, 21, 19, 0}, {0x2801, 22, 19, 0}, {0x2401, 23, 20, 0}, {0x2201, 24, 21, 0},
    {0x1C01, 25, 22, 0}, {0x1801, 26, 23, 0}, {0x1601, 27, 24, 0}, {0x1401, 28, 25, 0},
    {0x1201, 29, 26, 0}, {0x1101, 30, 27, 0}, {0x0AC1, 31, 28, 0}, {0x09C1, 32, 29, 0},
    {0x08A1, 33, 30, 0}, {0x0521, 34, 31, 0}, {0x0441, 35, 32, 0}, {0x02A1, 36, 33, 0},
    {0x0221, 37, 34, 0}, {0x0141, 38, 35, 0}, {0x0111, 39, 36, 0}, {0x0085, 40, 37, 0},
    {0x0049, 41, 38, 0}, {0x0025, 42, 39, 0}, {0x0015, 43, 40, 0}, {0x0009, 44, 41, 0},
    {0x0005, 45, 42, 0}, {0x0001, 45, 43, 0}, {0x5601, 46, 46, 0},
}};
constexpr std::size_t kSigns = 9, kRefine = 14, kRun = 17, kEven = 18, kContexts = 19;

// The arithmetic decoder (annex C). Behind its bytes come ones.
class Arithmetic {
 public:
  void begin(std::span<const std::uint8_t> bytes) {
    bytes_ = bytes;
    at_ = 0;
    c_ = byte(0) << 16;
    more();
    c_ <<= 7;
    left_ -= 7;
    a_ = 0x8000;
  }
  void forget() {
    states_.fill(0);
    symbols_.fill(0);
    states_[0] = 4;
    states_[kRun] = 3;
    states_[kEven] = 46;
  }
  int bit(std::size_t context) {
    const State& state = kStates[states_[context]];
    std::uint8_t& symbol = symbols_[context];
    a_ -= state.q;
    const bool lower = c_ >> 16 < state.q;
    int found = symbol;
    if (!lower) {
      c_ -= std::uint32_t{state.q} << 16;
      if ((a_ & 0x8000) != 0) return found;
    }
    const bool less = lower == (a_ >= state.q);
    if (lower) a_ = state.q;
    if (less) {
      found = 1 - symbol;
      if (state.swap != 0) symbol = static_cast<std::uint8_t>(found);
      states_[context] = state.less;
    } else {
      states_[context] = state.more;
    }
    do {
      if (left_ == 0) more();
      a_ <<= 1;
      c_ <<= 1;
      --left_;
    } while ((a_ & 0x8000) == 0);
    return found;
  }

 private:
  [[nodiscard]] std::uint32_t byte(std::size_t at) const {
    return at < bytes_.size() ? bytes_[at] : 0xFF;
  }
  void more() {
    if (byte(at_) == 0xFF) {
      if (byte(at_ + 1) > 0x8F) {
        c_ += 0xFF00;
        left_ = 8;
      } else {
        c_ += byte(++at_) << 9;
        left_ = 7;
      }
    } else {
      c_ += byte(++at_) << 8;
      left_ = 8;
    }
  }
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::uint32_t a_ = 0, c_ = 0;
  int left_ = 0;
  std::array<std::uint8_t, kContexts> states_{}, symbols_{};
};

// Plain bits of a pass without arithmetic coding.
class Plain {
 public:
  void begin(std::span<const std::uint8_t> bytes) {
    bytes_ = bytes;
    at_ = 0;
    left_ = 0;
    now_ = 0;
  }
  int bit() {
    if (left_ == 0) {
      left_ = now_ == 0xFF ? 7 : 8;
      now_ = at_ < bytes_.size() ? bytes_[at_++] : 0xFF;
    }
    --left_;
    return static_cast<int>(now_ >> left_ & 1U);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  unsigned now_ = 0;
  int left_ = 0;
};

enum Flag : std::uint8_t { kFound = 1, kSeen = 2, kRefined = 4, kNegative = 8 };

class Block {
 public:
  Block(int wide, int high, Band band, int style)
      : wide_(wide),
        high_(high),
        along_(static_cast<std::size_t>(wide) + 2),
        band_(band),
        style_(style),
        flags_(along_ * (static_cast<std::size_t>(high) + 2)),
        values_(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high)) {}

  std::vector<std::int32_t> decode(int planes, std::span<const Segment> segments) {
    coder_.forget();
    int pass = 0;  // the first plane has only a clean-up
    for (const Segment& segment : segments) {
      plain_now_ = (style_ & kBypass) != 0 && pass >= 10 && (pass + 2) % 3 != 2;
      if (plain_now_)
        plain_.begin(segment.bytes);
      else
        coder_.begin(segment.bytes);
      for (int n = 0; n < segment.passes; ++n, ++pass) {
        const int plane = planes - 1 - (pass + 2) / 3;
        if (plane < 0) return std::move(values_);
        run((pass + 2) % 3, plane);
        if ((style_ & kForget) != 0) coder_.forget();
      }
    }
    return std::move(values_);
  }

 private:
  // kind: 0: significance, 1: refinement, 2: clean-up
  void run(int kind, int plane) {
    for (int top = 0; top < high_; top += 4)
      for (int x = 0; x < wide_; ++x) {
        const int end = std::min(high_, top + 4);
        if (kind == 2) {
          clean_column(x, top, end, plane);
          continue;
        }
        for (int y = top; y < end; ++y) kind == 0 ? look(x, y, plane) : refine(x, y, plane);
      }
    if (kind != 2) return;
    for (std::uint8_t& one : flags_) one &= static_cast<std::uint8_t>(~kSeen);
    if ((style_ & kSegmentMark) != 0)
      for (int n = 0; n < 4; ++n) static_cast<void>(coder_.bit(kEven));
  }

  [[nodiscard]] std::size_t at(int x, int y) const {
    return (static_cast<std::size_t>(y) + 1) * along_ + static_cast<std::size_t>(x) + 1;
  }
  // The flags of a neighbour; below the stripe there is none if the style says so.
  [[nodiscard]] int flag(int x, int y, int from_y) const {
    if ((style_ & kCausal) != 0 && y > from_y && (from_y & 3) == 3) return 0;
    return flags_[at(x, y)];
  }
  [[nodiscard]] int found(int x, int y, int from_y) const { return flag(x, y, from_y) & kFound; }

  struct Around {
    int h, v, d;
    [[nodiscard]] bool none() const { return h + v + d == 0; }
  };
  [[nodiscard]] Around around(int x, int y) const {
    return {found(x - 1, y, y) + found(x + 1, y, y), found(x, y - 1, y) + found(x, y + 1, y),
            found(x - 1, y - 1, y) + found(x + 1, y - 1, y) + found(x - 1, y + 1, y) +
                found(x + 1, y + 1, y)};
  }
  // Table D.1.
  [[nodiscard]] std::size_t zero_context(Around n) const {
    if (band_ == Band::hh) {
      const int hv = n.h + n.v;
      if (n.d >= 3) return 8;
      if (n.d == 2) return hv >= 1 ? 7 : 6;
      if (n.d == 1) return hv >= 2 ? 5 : hv == 1 ? 4 : 3;
      return hv >= 2 ? 2 : hv == 1 ? 1 : 0;
    }
    if (band_ == Band::hl) std::swap(n.h, n.v);
    if (n.h == 2) return 8;
    if (n.h == 1) return n.v >= 1 ? 7 : n.d >= 1 ? 6 : 5;
    if (n.v == 2) return 4;
    if (n.v == 1) return 3;
    return n.d >= 2 ? 2 : n.d == 1 ? 1 : 0;
  }

  [[nodiscard]] static int sign_of(int flag) {
    return (flag & kFound) == 0 ? 0 : (flag & kNegative) != 0 ? -1 : 1;
  }
  // Table D.3.
  bool read_sign(int x, int y) {
    if (plain_now_) return plain_.bit() == 1;
    int h = std::clamp(sign_of(flag(x - 1, y, y)) + sign_of(flag(x + 1, y, y)), -1, 1);
    int v = std::clamp(sign_of(flag(x, y - 1, y)) + sign_of(flag(x, y + 1, y)), -1, 1);
    const bool turned = h < 0 || (h == 0 && v < 0);
    if (turned) h = -h, v = -v;
    const int context = h == 1 ? 12 + v : 9 + v;
    return (coder_.bit(static_cast<std::size_t>(context)) == 1) != turned;
  }
  void find(int x, int y, int plane) {
    const bool negative = read_sign(x, y);
    flags_[at(x, y)] |= static_cast<std::uint8_t>(kFound | (negative ? kNegative : 0));
    const std::int32_t value = std::int32_t{3} << plane;
    values_[place(x, y)] = negative ? -value : value;
  }
  [[nodiscard]] std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(wide_) +
           static_cast<std::size_t>(x);
  }

  void look(int x, int y, int plane) {
    if ((flags_[at(x, y)] & kFound) != 0) return;
    const Around near = around(x, y);
    if (near.none()) return;
    if ((plain_now_ ? plain_.bit() : coder_.bit(zero_context(near))) == 1) find(x, y, plane);
    flags_[at(x, y)] |= kSeen;
  }
  void refine(int x, int y, int plane) {
    std::uint8_t& mine = flags_[at(x, y)];
    if ((mine & (kFound | kSeen)) != kFound) return;
    const std::size_t context = (mine & kRefined) != 0 ? 16 : around(x, y).none() ? 14 : 15;
    const int bit = plain_now_ ? plain_.bit() : coder_.bit(context);
    std::int32_t& value = values_[place(x, y)];
    const std::int32_t half = std::int32_t{1} << plane;
    value += (bit == 1) == (value > 0) ? half : -half;
    mine |= kRefined;
  }
  void clean_column(int x, int top, int end, int plane) {
    int y = top;
    if (end - top == 4 && empty_column(x, top)) {
      if (coder_.bit(kRun) == 0) return;
      y += coder_.bit(kEven) << 1;
      y += coder_.bit(kEven);
      find(x, y++, plane);
    }
    for (; y < end; ++y) {
      if ((flags_[at(x, y)] & (kFound | kSeen)) != 0) continue;
      if (coder_.bit(zero_context(around(x, y))) == 1) find(x, y, plane);
    }
  }
  [[nodiscard]] bool empty_column(int x, int top) const {
    for (int y = top; y < top + 4; ++y)
      if ((flags_[at(x, y)] & (kFound | kSeen)) != 0 || !around(x, y).none()) return false;
    return true;
  }

  int wide_, high_;
  std::size_t along_;
  Band band_;
  int style_;
  std::vector<std::uint8_t> flags_;  // with a margin of one
  std::vector<std::int32_t> values_;
  Arithmetic coder_;
  Plain plain_;
  bool plain_now_ = false;
};

}  // namespace

std::vector<std::int32_t> decode_block(int wide, int high, int planes, Band band, int style,
                                       std::span<const Segment> segments) {
  return Block(wide, high, band, style).decode(planes, segments);
}

}  // namespace burr::web
