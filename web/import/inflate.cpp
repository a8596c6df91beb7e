// Unpacks deflated data (RFC 1951) in zlib's and gzip's wrappings (RFC 1950, 1952), piece by piece, and
// checks their sums. Written for this page; no input can make it read or write beyond what it is given.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <vector>

#include "burr/record/mcap/crc32.h"

namespace {

constexpr int kFast = 9;  // bits of the table that finds most codes at once
constexpr unsigned kWindow = 32768;
constexpr int kLongest = 15;  // bits of a code

// Code lengths -> symbols (canonical Huffman codes).
class Codes {
 public:
  // False: more codes than there can be.
  bool make(const std::uint8_t* lengths, int count) {
    std::array<int, kLongest + 1> of{};
    for (int n = 0; n < count; ++n) ++of[lengths[n]];
    of[0] = 0;
    int left = 1;
    for (int length = 1; length <= kLongest; ++length) {
      left = 2 * left - of[static_cast<std::size_t>(length)];
      if (left < 0) return false;
    }
    counts_ = of;
    std::array<int, kLongest + 2> offset{};
    for (std::size_t l = 1; l <= kLongest; ++l) offset[l + 1] = offset[l] + of[l];
    symbols_.assign(static_cast<std::size_t>(count), 0);
    for (int n = 0; n < count; ++n)
      if (lengths[n] != 0)
        symbols_[static_cast<std::size_t>(offset[lengths[n]]++)] = static_cast<std::uint16_t>(n);
    fast_.fill(0);
    for (unsigned bits = 0; bits < 1U << kFast; ++bits) {
      int length = 0;
      const int symbol = slow(bits, kFast, length);
      if (symbol >= 0) fast_[bits] = static_cast<std::uint16_t>(symbol << 4 | length);
    }
    return true;
  }
  // The symbol at the beginning of `bits`, of which `have` are known; -1: more are needed; -2: there is none.
  int find(std::uint64_t bits, int have, int& length) const {
    const std::uint16_t one = fast_[bits & ((1U << kFast) - 1)];
    if (one != 0 && (one & 15) <= have) {
      length = one & 15;
      return one >> 4;
    }
    return slow(bits, have, length);
  }

 private:
  int slow(std::uint64_t bits, int have, int& length) const {
    int code = 0, first = 0, index = 0;
    for (length = 1; length <= kLongest; ++length) {
      if (length > have) return -1;
      code |= static_cast<int>(bits >> (length - 1) & 1);
      const int count = counts_[static_cast<std::size_t>(length)];
      if (code - count < first) return symbols_[static_cast<std::size_t>(index + code - first)];
      index += count;
      first = (first + count) << 1;
      code <<= 1;
    }
    return -2;
  }
  std::array<int, kLongest + 1> counts_{};
  std::vector<std::uint16_t> symbols_;
  std::array<std::uint16_t, 1 << kFast> fast_{};
};

enum class At {
  head,
  block,
  stored_length,
  stored,
  tables,
  lengths,
  symbols,
  copy,
  tail,
  end,
  bad
};
enum class Wrap { none, zlib, gzip };

constexpr std::array<std::uint16_t, 29> kLength = {3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                                   15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                                   67, 83, 99, 115, 131, 163, 195, 227, 258};
constexpr std::array<std::uint8_t, 29> kLengthBits = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                                      2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
constexpr std::array<std::uint16_t, 30> kFar = {
    1,   2,   3,   4,   5,   7,    9,    13,   17,   25,   33,   49,   65,    97,    129,
    193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
constexpr std::array<std::uint8_t, 30> kFarBits = {0, 0, 0,  0,  1,  1,  2,  2,  3,  3,
                                                   4, 4, 5,  5,  6,  6,  7,  7,  8,  8,
                                                   9, 9, 10, 10, 11, 11, 12, 12, 13, 13};
constexpr std::array<std::uint8_t, 19> kOrder = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                 11, 4,  12, 3, 13, 2, 14, 1, 15};

}  // namespace

struct InflateState {
  Wrap wrap = Wrap::none;
  At at = At::head;
  std::uint64_t hold =
      0;  // bits that were read and not yet used: never a whole byte more than needed
  int have = 0;
  bool last = false;
  std::vector<std::uint8_t> head;
  unsigned left = 0, far = 0;  // of a stored block or a copy
  int literals = 0, fars = 0, codes = 0, known = 0;
  std::array<std::uint8_t, 320> lengths{};
  Codes lengths_of_codes, literal, distance;
  std::array<std::uint8_t, kWindow> window{};
  unsigned to = 0;            // in the window
  std::uint64_t written = 0;  // since the start of this member
  std::uint32_t crc = 0, a = 1, b = 0;
  int wanted = -1;  // length symbol whose distance is still to come

  // Whoever calls believes that all is out when its input is used up. So the last byte is shown as unused while there
  // may be more to put out; then it is in `hold` already.
  bool shown = false;

  void pass_shown(z_stream& s) {
    if (!shown || s.avail_in == 0) return;
    shown = false;
    ++s.next_in;
    --s.avail_in;
  }
  bool need(z_stream& s, int bits) {
    while (have < bits) {
      pass_shown(s);
      if (s.avail_in == 0) return false;
      hold |= std::uint64_t{*s.next_in++} << have;
      --s.avail_in;
      have += 8;
    }
    return true;
  }
  unsigned take(int bits) {
    const auto value = static_cast<unsigned>(hold & ((std::uint64_t{1} << bits) - 1));
    hold >>= bits;
    have -= bits;
    return value;
  }
  // -1: there is no more input; -2: no such code. The bits stay where they are.
  int symbol(z_stream& s, const Codes& codes_of, int& length) {
    for (;;) {
      const int found = codes_of.find(hold, have, length);
      if (found != -1) return found;
      if (!need(s, have + 1)) return -1;
    }
  }
  void put(z_stream& s, std::uint8_t byte) {
    window[to] = byte;
    to = (to + 1) % kWindow;
    ++written;
    *s.next_out++ = byte;
    --s.avail_out;
    ++s.total_out;
  }
  void sum(const std::uint8_t* from, std::size_t count) {
    if (wrap == Wrap::gzip) crc = burr::record::crc32(crc, {from, count});
    if (wrap != Wrap::zlib) return;
    for (std::size_t n = 0; n < count; ++n) {
      a = (a + from[n]) % 65521;
      b = (b + a) % 65521;
    }
  }
  void begin() {
    at = wrap == Wrap::none ? At::block : At::head;
    head.clear();
    last = false;
    written = 0;
    crc = b = 0;
    codes = 0;
    shown = false;
    a = 1;
    wanted = -1;
  }
  bool read_head(z_stream& s);
  bool read_block(z_stream& s);
  bool read_lengths(z_stream& s);
  bool read_symbols(z_stream& s);
  bool read_tail(z_stream& s);
};

// Each step returns false if it waits for more input, or found damage (at == At::bad).

bool InflateState::read_head(z_stream& s) {
  const std::size_t least = wrap == Wrap::zlib ? 2 : 10;
  const auto bad = [this] {
    at = At::bad;
    return false;
  };
  for (;;) {
    bool whole = head.size() >= least;
    if (whole && wrap == Wrap::zlib) {
      if ((head[0] & 15) != 8 || (head[0] * 256 + head[1]) % 31 != 0 || (head[1] & 32) != 0)
        return bad();
    } else if (whole) {
      if (head[0] != 0x1F || head[1] != 0x8B || head[2] != 8 || (head[3] & 0xE0) != 0) return bad();
      std::size_t end = 10;
      if ((head[3] & 4) != 0) {
        whole = head.size() >= end + 2;
        if (whole) end += 2 + head[end] + std::size_t{256} * head[end + 1];
      }
      for (const int text : {8, 16}) {
        if (!whole || (head[3] & text) == 0) continue;
        while (end < head.size() && head[end] != 0) ++end;
        whole = ++end <= head.size();
      }
      if ((head[3] & 2) != 0) end += 2;
      whole = whole && head.size() >= end;
    }
    if (whole) {
      at = At::block;
      return true;
    }
    if (head.size() > 200000) return bad();
    if (s.avail_in == 0) return false;
    head.push_back(*s.next_in++);
    --s.avail_in;
  }
}

bool InflateState::read_block(z_stream& s) {
  if (last) {
    take(have % 8);
    at = At::tail;
    return true;
  }
  if (!need(s, 3)) return false;
  last = take(1) != 0;
  switch (take(2)) {
    case 0:
      take(have % 8);
      at = At::stored_length;
      return true;
    case 1: {
      std::array<std::uint8_t, 288> fixed{};
      for (std::size_t n = 0; n < 288; ++n) fixed[n] = n < 144 ? 8 : n < 256 ? 9 : n < 280 ? 7 : 8;
      literal.make(fixed.data(), 288);
      fixed.fill(5);
      distance.make(fixed.data(), 30);
      at = At::symbols;
      return true;
    }
    case 2:
      at = At::tables;
      return true;
    default:
      at = At::bad;
      return false;
  }
}

bool InflateState::read_lengths(z_stream& s) {
  const auto bad = [this] {
    at = At::bad;
    return false;
  };
  while (known < literals + fars) {
    int length = 0;
    const int found = symbol(s, lengths_of_codes, length);
    if (found == -2) return bad();
    if (found < 0) return false;
    if (found < 16) {
      take(length);
      lengths[static_cast<std::size_t>(known++)] = static_cast<std::uint8_t>(found);
      continue;
    }
    const int more = found == 16 ? 2 : found == 17 ? 3 : 7;
    if (!need(s, length + more)) return false;
    take(length);
    int times = static_cast<int>(take(more)) + (found == 18 ? 11 : 3);
    if (known + times > literals + fars || (found == 16 && known == 0)) return bad();
    const std::uint8_t value =
        found == 16 ? lengths[static_cast<std::size_t>(known - 1)] : std::uint8_t{0};
    for (; times > 0; --times) lengths[static_cast<std::size_t>(known++)] = value;
  }
  if (lengths[256] == 0 || !literal.make(lengths.data(), literals) ||
      !distance.make(lengths.data() + literals, fars))
    return bad();
  at = At::symbols;
  return true;
}

bool InflateState::read_symbols(z_stream& s) {
  const auto bad = [this] {
    at = At::bad;
    return false;
  };
  while (s.avail_out > 0) {
    int length = 0;
    if (wanted < 0) {
      const int found = symbol(s, literal, length);
      if (found == -2) return bad();
      if (found < 0) return false;
      if (found < 256) {
        take(length);
        put(s, static_cast<std::uint8_t>(found));
        continue;
      }
      if (found == 256) {
        take(length);
        at = At::block;
        return true;
      }
      if (found > 285) return bad();
      const auto n = static_cast<std::size_t>(found - 257);
      if (!need(s, length + kLengthBits[n])) return false;
      take(length);
      left = kLength[n] + take(kLengthBits[n]);
      wanted = found;
    }
    const int found = symbol(s, distance, length);
    if (found == -2 || found > 29) return bad();
    if (found < 0) return false;
    const auto n = static_cast<std::size_t>(found);
    if (!need(s, length + kFarBits[n])) return false;
    take(length);
    far = kFar[n] + take(kFarBits[n]);
    wanted = -1;
    if (far > written || far > kWindow) return bad();
    at = At::copy;
    return true;
  }
  return false;
}

bool InflateState::read_tail(z_stream& s) {
  const int bytes = wrap == Wrap::none ? 0 : wrap == Wrap::zlib ? 4 : 8;
  if (!need(s, 8 * bytes)) return false;
  if (wrap == Wrap::gzip) {
    const unsigned sum_there = take(32), size = take(32);
    if (sum_there != crc || size != static_cast<std::uint32_t>(written)) {
      at = At::bad;
      return false;
    }
  } else if (wrap == Wrap::zlib) {
    std::uint32_t there = 0;
    for (int n = 0; n < 4; ++n) there = there << 8 | take(8);
    if (there != (b << 16 | a)) {
      at = At::bad;
      return false;
    }
  }
  at = At::end;
  return true;
}

extern "C" {

int inflateInit2(z_stream* stream, int window_bits) {
  stream->total_out = 0;
  stream->state = new (std::nothrow) InflateState;
  if (stream->state == nullptr) return Z_MEM_ERROR;
  stream->state->wrap = window_bits < 0 ? Wrap::none : window_bits > 15 ? Wrap::gzip : Wrap::zlib;
  stream->state->begin();
  return Z_OK;
}

int inflateReset(z_stream* stream) {
  stream->total_out = 0;
  stream->state->begin();
  return Z_OK;
}

int inflateEnd(z_stream* stream) {
  delete stream->state;
  stream->state = nullptr;
  return Z_OK;
}

int inflate(z_stream* stream, int) {
  z_stream& s = *stream;
  InflateState& i = *s.state;
  const Bytef *const first = s.next_out, *const came = s.next_in;
  std::size_t summed = 0;
  const auto sum_up = [&] {
    const auto count = static_cast<std::size_t>(s.next_out - first);
    i.sum(first + summed, count - summed);
    summed = count;
  };
  for (bool going = true; going;) {
    switch (i.at) {
      case At::head:
        going = i.read_head(s);
        break;
      case At::block:
        going = i.read_block(s);
        break;
      case At::stored_length: {
        going = i.need(s, 32);
        if (!going) break;
        i.left = i.take(16);
        if (i.take(16) != (~i.left & 0xFFFF)) return Z_DATA_ERROR;
        i.at = At::stored;
        break;
      }
      case At::stored:
        while (i.left > 0 && s.avail_out > 0 && i.need(s, 8)) {
          i.put(s, static_cast<std::uint8_t>(i.take(8)));
          --i.left;
        }
        going = i.left == 0;
        if (going) i.at = At::block;
        break;
      case At::tables: {
        going = i.need(s, 14);
        if (!going) break;
        // 14 bits, then 3 for each of up to 19 lengths: 57 more are too many to hold at once
        if (i.codes == 0) {
          i.literals = 257 + static_cast<int>(i.take(5));
          i.fars = 1 + static_cast<int>(i.take(5));
          i.codes = 4 + static_cast<int>(i.take(4));
          if (i.literals > 286 || i.fars > 30) return Z_DATA_ERROR;
          i.known = 0;
          i.lengths.fill(0);
          i.at = At::lengths;
        }
        break;
      }
      case At::lengths:
        while (going && i.codes > 0) {
          going = i.need(s, 3);
          if (!going) break;
          i.lengths[kOrder[static_cast<std::size_t>(i.known++)]] =
              static_cast<std::uint8_t>(i.take(3));
          if (--i.codes > 0) continue;
          if (!i.lengths_of_codes.make(i.lengths.data(), 19)) return Z_DATA_ERROR;
          i.lengths.fill(0);
          i.known = 0;
        }
        going = going && i.read_lengths(s);
        break;
      case At::symbols:
        going = i.read_symbols(s);
        break;
      case At::copy:
        while (i.left > 0 && s.avail_out > 0) {
          i.put(s, i.window[(i.to + kWindow - i.far) % kWindow]);
          --i.left;
        }
        going = i.left == 0;
        if (going) i.at = At::symbols;
        break;
      case At::tail:
        sum_up();
        going = i.read_tail(s);
        break;
      case At::end:
        i.pass_shown(s);
        return Z_STREAM_END;
      case At::bad:
        return Z_DATA_ERROR;
    }
  }
  sum_up();
  if (i.at == At::bad) return Z_DATA_ERROR;
  if (s.avail_out == 0 && s.next_in != came && !i.shown) {
    i.shown = true;
    --s.next_in;
    ++s.avail_in;
  }
  return s.next_out == first ? Z_BUF_ERROR : Z_OK;
}

unsigned long crc32(unsigned long so_far, const Bytef* bytes, uInt count) {
  if (bytes == nullptr) return 0;
  return burr::record::crc32(static_cast<std::uint32_t>(so_far), {bytes, count});
}

}  // extern "C"
