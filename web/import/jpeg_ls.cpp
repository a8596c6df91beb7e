// JPEG-LS (ITU-T T.87), lossless and nearly so, of one channel. Names as in the standard, where it has some.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "unpack.h"

namespace burr::web {
namespace {

using Bytes = std::span<const std::uint8_t>;

// Bits of a scan, the highest first; behind a byte FF stands one bit that means nothing.
class Bits {
 public:
  Bits(Bytes bytes, std::size_t at) : bytes_(bytes), at_(at) {}
  int bit() {
    if (left_ == 0) fill();
    --left_;
    return static_cast<int>(now_ >> left_ & 1U);
  }
  int bits(int count) {
    int value = 0;
    for (int n = 0; n < count; ++n) value = value << 1 | bit();
    return value;
  }
  [[nodiscard]] bool ended() const { return missing_ > 8; }

 private:
  void fill() {
    const bool stuffed = now_ == 0xFF && !first_;
    now_ = 0;
    first_ = false;
    left_ = stuffed ? 7 : 8;
    // behind FF a byte of 128 and more is the second byte of a mark: the scan has ended
    if (at_ >= bytes_.size() || (stuffed && bytes_[at_] >= 0x80) || missing_ > 0)
      ++missing_;
    else
      now_ = bytes_[at_++];
  }
  Bytes bytes_;
  std::size_t at_;
  unsigned now_ = 0;
  bool first_ = true;
  int left_ = 0, missing_ = 0;
};

struct Head {
  int precision = 0, columns = 0, rows = 0;
  int MAXVAL = 0, NEAR = 0, T1 = 0, T2 = 0, T3 = 0, RESET = 64;
  std::size_t scan = 0;
};

// What the file does not say (C.2.4.1.1).
void complete(Head& h) {
  const auto within = [&](int value, int least) {
    return value > h.MAXVAL || value < least ? least : value;
  };
  if (h.MAXVAL == 0) h.MAXVAL = (1 << h.precision) - 1;
  int t1 = 0, t2 = 0, t3 = 0;
  if (h.MAXVAL >= 128) {
    const int factor = (std::min(h.MAXVAL, 4095) + 128) >> 8;
    t1 = within(factor + 2 + 3 * h.NEAR, h.NEAR + 1);
    t2 = within(factor * 4 + 3 + 5 * h.NEAR, t1);
    t3 = within(factor * 17 + 4 + 7 * h.NEAR, t2);
  } else {
    const int factor = 256 / (h.MAXVAL + 1);
    t1 = within(std::max(2, 3 / factor + 3 * h.NEAR), h.NEAR + 1);
    t2 = within(std::max(3, 7 / factor + 5 * h.NEAR), t1);
    t3 = within(std::max(4, 21 / factor + 7 * h.NEAR), t2);
  }
  if (h.T1 == 0) h.T1 = t1;
  if (h.T2 == 0) h.T2 = t2;
  if (h.T3 == 0) h.T3 = t3;
}

bool read_head(Bytes bytes, Head& h) {
  const auto two = [](Bytes part, std::size_t at) { return part[at] << 8 | part[at + 1]; };
  if (bytes.size() < 4 || two(bytes, 0) != 0xFFD8) return false;
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    if (bytes[at] != 0xFF) return false;
    const int mark = bytes[at + 1];
    if (mark == 0xFF) {
      ++at;
      continue;
    }
    const auto length = static_cast<std::size_t>(two(bytes, at + 2));
    if (length < 2 || at + 2 + length > bytes.size()) return false;
    const Bytes part = bytes.subspan(at + 4, length - 2);
    at += 2 + length;
    if (mark == 0xF7) {
      if (part.size() < 6 || part[5] != 1) return false;
      h.precision = part[0];
      h.rows = two(part, 1);
      h.columns = two(part, 3);
    } else if (mark == 0xF8) {
      if (part.empty() || part[0] != 1) return false;  // tables of colours, very large pictures
      if (part.size() < 11) return false;
      h.MAXVAL = two(part, 1);
      h.T1 = two(part, 3);
      h.T2 = two(part, 5);
      h.T3 = two(part, 7);
      if (two(part, 9) != 0) h.RESET = two(part, 9);
    } else if (mark == 0xDD) {
      if (part.size() < 2 || part[0] != 0 || part[1] != 0) return false;  // restarts
    } else if (mark == 0xDA) {
      if (part.size() < 6 || part[0] != 1 || h.precision < 2 || h.precision > 16) return false;
      h.NEAR = part[3];
      h.scan = at;
      complete(h);
      return h.MAXVAL < 1 << h.precision && 2 * h.NEAR <= h.MAXVAL && h.RESET >= 3 &&
             h.RESET <= 4096 && h.T1 <= h.T2 && h.T2 <= h.T3;
    } else if (mark >= 0xC0 && mark <= 0xCF) {
      return false;
    }
  }
  return false;
}

constexpr std::array<int, 32> kRun = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,  2,  3,  3,  3,  3,
                                      4, 4, 5, 5, 6, 6, 7, 7, 8, 9, 10, 11, 12, 13, 14, 15};
constexpr std::size_t kContexts = 365;

int bits_for(int count) {  // the least n with 2^n >= count
  int n = 0;
  while (1 << n < count) ++n;
  return n;
}

class Decoder {
 public:
  Decoder(const Head& head, Bytes bytes) : h_(head), bits_(bytes, head.scan) {
    step_ = 2 * h_.NEAR + 1;
    range_ = (h_.MAXVAL + 2 * h_.NEAR) / step_ + 1;
    qbpp_ = bits_for(range_);
    const int bpp = std::max(2, bits_for(h_.MAXVAL + 1));
    limit_ = 2 * (bpp + std::max(8, bpp));
    for (Context& one : contexts_) one.A = std::max(2, (range_ + 32) / 64);
  }

  bool read(Unpacked& to) {
    const int wide = h_.columns;
    // a line has one value before it, and one behind
    std::vector<std::int32_t> above(static_cast<std::size_t>(wide) + 2), line = above;
    to.values.clear();
    to.values.reserve(static_cast<std::size_t>(wide) * static_cast<std::size_t>(h_.rows));
    for (int y = 0; y < h_.rows; ++y) {
      line[0] = above[1];
      above[static_cast<std::size_t>(wide) + 1] = above[static_cast<std::size_t>(wide)];
      if (!read_line(above, line, wide) || bits_.ended()) return false;
      to.values.insert(to.values.end(), line.begin() + 1, line.end() - 1);
      std::swap(above, line);
    }
    return true;
  }

 private:
  struct Context {
    int A = 0, B = 0, C = 0, N = 1;  // of the two of runs, B is Nn
  };

  bool read_line(const std::vector<std::int32_t>& above, std::vector<std::int32_t>& line,
                 int wide) {
    for (int x = 0; x < wide;) {
      const auto at = static_cast<std::size_t>(x) + 1;
      const int a = line[at - 1], b = above[at], c = above[at - 1], d = above[at + 1];
      const int q1 = quantised(d - b), q2 = quantised(b - c), q3 = quantised(c - a);
      if (q1 == 0 && q2 == 0 && q3 == 0) {
        if (!read_run(above, line, x, wide)) return false;
        continue;
      }
      int q = 81 * q1 + 9 * q2 + q3, sign = 1;
      if (q < 0) q = -q, sign = -1;
      line[at] = regular(contexts_[static_cast<std::size_t>(q)], sign, median(a, b, c));
      ++x;
    }
    return true;
  }
  bool read_run(const std::vector<std::int32_t>& above, std::vector<std::int32_t>& line, int& x,
                int wide) {
    const int a = line[static_cast<std::size_t>(x)];
    int end = x;
    while (bits_.bit() == 1) {
      const int whole = 1 << kRun[run_], some = std::min(whole, wide - end);
      end += some;
      if (some == whole && run_ < 31) ++run_;
      if (end == wide) break;
    }
    if (end < wide) end += bits_.bits(kRun[run_]);
    if (end > wide) return false;
    for (; x < end; ++x) line[static_cast<std::size_t>(x) + 1] = a;
    if (x == wide) return true;
    const auto at = static_cast<std::size_t>(x) + 1;
    line[at] = interruption(a, above[at]);
    if (run_ > 0) --run_;
    ++x;
    return true;
  }

  [[nodiscard]] int quantised(int d) const {
    const int far = std::abs(d);
    const int q = far <= h_.NEAR ? 0 : far < h_.T1 ? 1 : far < h_.T2 ? 2 : far < h_.T3 ? 3 : 4;
    return d < 0 ? -q : q;
  }
  static int median(int a, int b, int c) {
    if (c >= std::max(a, b)) return std::min(a, b);
    if (c <= std::min(a, b)) return std::max(a, b);
    return a + b - c;
  }
  int golomb(int k, int limit) {
    int zeros = 0;
    while (zeros < limit && bits_.bit() == 0) ++zeros;
    constexpr int kMost = 1 << 17;  // only a damaged file says more
    if (zeros < limit - qbpp_ - 1) return std::min((zeros << k) + bits_.bits(k), kMost);
    return bits_.bits(qbpp_) + 1;
  }
  [[nodiscard]] static int parameter(int N, int A) {
    int k = 0;
    while (k < 16 && N << k < A) ++k;
    return k;
  }
  [[nodiscard]] int restored(int expected, int error) const {
    int value = expected + error * step_;
    if (value < -h_.NEAR) value += range_ * step_;
    if (value > h_.MAXVAL + h_.NEAR) value -= range_ * step_;
    return std::clamp(value, 0, h_.MAXVAL);
  }

  int regular(Context& c, int sign, int expected) {
    expected = std::clamp(expected + sign * c.C, 0, h_.MAXVAL);
    const int k = parameter(c.N, c.A), mapped = golomb(k, limit_);
    int error = (mapped & 1) != 0 ? -(mapped + 1) / 2 : mapped / 2;
    if (h_.NEAR == 0 && k == 0 && 2 * c.B <= -c.N) error = -error - 1;
    c.B += error * step_;
    c.A += std::abs(error);
    if (c.N == h_.RESET) {
      c.A >>= 1;
      c.B >>= 1;
      c.N >>= 1;
    }
    ++c.N;
    if (c.B <= -c.N) {
      c.B = std::max(c.B + c.N, 1 - c.N);
      c.C = std::max(c.C - 1, -128);
    } else if (c.B > 0) {
      c.B = std::min(c.B - c.N, 0);
      c.C = std::min(c.C + 1, 127);
    }
    return restored(expected, sign * error);
  }
  // The value that ends a run.
  int interruption(int a, int b) {
    const int type = std::abs(a - b) <= h_.NEAR ? 1 : 0;
    Context& c = contexts_[kContexts + static_cast<std::size_t>(type)];
    const int k = parameter(c.N, type == 0 ? c.A : c.A + (c.N >> 1));
    const int mapped = golomb(k, limit_ - kRun[run_] - 1);
    const int both = mapped + type, odd = both & 1;
    int error = (both + odd) / 2;
    if ((k != 0 || 2 * c.B >= c.N) == (odd != 0)) error = -error;
    if (error < 0) ++c.B;
    c.A += (mapped + 1 - type) >> 1;
    if (c.N == h_.RESET) {
      c.A >>= 1;
      c.B >>= 1;
      c.N >>= 1;
    }
    ++c.N;
    return restored(type == 1 ? a : b, type == 0 && a > b ? -error : error);
  }

  Head h_;
  Bits bits_;
  int step_ = 1, range_ = 0, qbpp_ = 0, limit_ = 0;
  std::size_t run_ = 0;
  std::array<Context, kContexts + 2> contexts_{};
};

}  // namespace

bool unpack_jpeg_ls(Bytes bytes, Unpacked& to) {
  Head head;
  if (!read_head(bytes, head) || head.columns != to.columns || head.rows != to.rows) return false;
  if (head.columns < 1 || head.rows < 1) return false;
  return Decoder(head, bytes).read(to);
}

}  // namespace burr::web
