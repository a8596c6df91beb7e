// JPEG 2000 (ITU-T T.800) of one channel: the codestream, its packets, and what they hold. Not read: regions of interest, changes of
// the order within a tile, packet heads that lie apart.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "jpeg_2000_blocks.h"
#include "jpeg_2000_wavelet.h"
#include "unpack.h"

namespace burr::web {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr int kMostPlanes = 30;
constexpr std::size_t kMostLevels = 32;

int up(std::int64_t value, int shift) {
  return static_cast<int>((value + (std::int64_t{1} << shift) - 1) >> shift);
}

// How a tile is coded: COD and QCD.
struct Coding {
  int order = 0, layers = 1, levels = 0, block_x = 6, block_y = 6, style = 0;
  bool whole = true, starts = false, ends = false;  // marks before packets, and behind their heads
  std::array<std::uint8_t, kMostLevels + 1> precincts{};
  int guard = 0, steps = 0;  // steps: 0: none, 1: one for all, 2: one for each band
  std::vector<int> step;
};

struct Picture {
  Area area;
  int tile_x = 0, tile_y = 0, tile_wide = 0, tile_high = 0, precision = 0;
  bool has_signs = false;
  Coding coding;
  [[nodiscard]] int across() const { return (area.x1 - tile_x + tile_wide - 1) / tile_wide; }
  [[nodiscard]] int down() const { return (area.y1 - tile_y + tile_high - 1) / tile_high; }
};

class Reader {
 public:
  explicit Reader(Bytes bytes) : bytes_(bytes) {}
  [[nodiscard]] bool has(std::size_t count) const { return bytes_.size() - at_ >= count; }
  std::uint32_t number(int size) {
    std::uint32_t value = 0;
    for (int n = 0; n < size; ++n) value = value << 8 | (at_ < bytes_.size() ? bytes_[at_++] : 0U);
    return value;
  }
  Bytes take(std::size_t count) {
    const Bytes part = bytes_.subspan(at_, std::min(count, bytes_.size() - at_));
    at_ += part.size();
    return part;
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
};

bool read_size(Reader part, Picture& picture) {
  if (!part.has(39)) return false;
  part.number(2);
  std::array<std::uint32_t, 8> n{};
  for (std::uint32_t& one : n) one = part.number(4);
  if (std::any_of(n.begin(), n.end(), [](std::uint32_t one) { return one > 1U << 24; }))
    return false;
  const auto at = [&](std::size_t which) { return static_cast<int>(n[which]); };
  picture.area = {at(2), at(3), at(0), at(1)};
  picture.tile_wide = at(4);
  picture.tile_high = at(5);
  picture.tile_x = at(6);
  picture.tile_y = at(7);
  if (part.number(2) != 1) return false;
  const std::uint32_t depth = part.number(1);
  picture.has_signs = (depth & 128) != 0;
  picture.precision = static_cast<int>(depth & 127) + 1;
  if (part.number(1) != 1 || part.number(1) != 1 || picture.precision > 16) return false;
  const Area& area = picture.area;
  return area.wide() > 0 && area.high() > 0 && picture.tile_wide > 0 && picture.tile_high > 0 &&
         picture.tile_x <= area.x0 && picture.tile_y <= area.y0 &&
         picture.tile_x + picture.tile_wide > area.x0 &&
         picture.tile_y + picture.tile_high > area.y0;
}

bool read_coding(Reader part, Coding& coding) {
  if (!part.has(10)) return false;
  const std::uint32_t marks = part.number(1);
  coding.starts = (marks & 2) != 0;
  coding.ends = (marks & 4) != 0;
  coding.order = static_cast<int>(part.number(1));
  coding.layers = static_cast<int>(part.number(2));
  part.number(1);  // how channels mix
  coding.levels = static_cast<int>(part.number(1));
  coding.block_x = static_cast<int>(part.number(1)) + 2;
  coding.block_y = static_cast<int>(part.number(1)) + 2;
  coding.style = static_cast<int>(part.number(1));
  coding.whole = part.number(1) == 1;
  if (coding.levels > static_cast<int>(kMostLevels) || coding.order > 4 || coding.block_x > 10 ||
      coding.block_y > 10 || coding.block_x + coding.block_y > 12)
    return false;
  const auto levels = static_cast<std::size_t>(coding.levels);
  coding.precincts.fill(0xFF);
  if ((marks & 1) == 0) return true;
  if (!part.has(levels + 1)) return false;
  for (std::size_t n = 0; n <= levels; ++n) {
    coding.precincts[n] = static_cast<std::uint8_t>(part.number(1));
    if (n > 0 && ((coding.precincts[n] & 15) == 0 || coding.precincts[n] >> 4 == 0)) return false;
  }
  return true;
}

bool read_steps(Reader part, Coding& coding) {
  if (!part.has(2)) return false;
  const std::uint32_t style = part.number(1);
  coding.steps = static_cast<int>(style & 31);
  coding.guard = static_cast<int>(style >> 5);
  if (coding.steps > 2) return false;
  const int size = coding.steps == 0 ? 1 : 2;
  coding.step.clear();
  while (part.has(static_cast<std::size_t>(size)))
    coding.step.push_back(static_cast<int>(part.number(size)));
  return !coding.step.empty();
}

// Of one channel, so COC and QCC mean the same as COD and QCD. False: damaged, or not known here.
bool read_mark(std::uint32_t mark, Bytes bytes, Coding& coding) {
  switch (mark) {
    case 0xFF52:
      return read_coding(Reader(bytes), coding);
    case 0xFF5C:
      return read_steps(Reader(bytes), coding);
    case 0xFF5D:
      return !bytes.empty() && read_steps(Reader(bytes.subspan(1)), coding);
    case 0xFF53:  // COC
    case 0xFF5E:  // RGN
    case 0xFF5F:  // POC
    case 0xFF60:  // PPM
    case 0xFF61:
      return false;  // PPT
    default:
      return true;
  }
}

// A tree of the least values (B.10.2).
class Tree {
 public:
  void shape(int wide, int high) {
    levels_.clear();
    for (;; wide = (wide + 1) / 2, high = (high + 1) / 2) {
      levels_.push_back({wide, std::vector<Node>(static_cast<std::size_t>(wide) *
                                                 static_cast<std::size_t>(high))});
      if (wide * high <= 1) return;
    }
  }
  // Whether the value of this leaf is below `limit`; if so, value() is it.
  template <class ReadBit>
  bool below(int x, int y, int limit, const ReadBit& bit) {
    int low = 0;
    for (std::size_t n = levels_.size(); n-- > 0;) {
      Node& node = at(n, x, y);
      node.low = std::max(node.low, low);
      while (!node.known && node.low < limit) {
        if (bit() == 1)
          node.known = true;
        else
          ++node.low;
      }
      low = node.low;
    }
    const Node& leaf = at(0, x, y);
    return leaf.known && leaf.low < limit;
  }
  int value(int x, int y) { return at(0, x, y).low; }

 private:
  struct Node {
    int low = 0;
    bool known = false;
  };
  struct Level {
    int wide;
    std::vector<Node> nodes;
  };
  Node& at(std::size_t level, int x, int y) {
    return levels_[level]
        .nodes[static_cast<std::size_t>((y >> level) * levels_[level].wide + (x >> level))];
  }
  std::vector<Level> levels_;
};

struct CodeBlock {
  Area area;  // in its band
  bool begun = false;
  int planes = 0, passes = 0, length_bits = 3;
  std::vector<Segment> segments;
  std::size_t room = 0;  // passes that the last segment may still take
};
struct Precinct {  // of a band
  int wide = 0, high = 0;
  std::vector<CodeBlock> blocks;
  Tree included, empty_planes;
};
struct BandOfTile {
  Area area;
  Band kind = Band::ll;
  int planes = 0;
  float step = 1;
  std::vector<Precinct> precincts;
};
struct Resolution {
  Area area;
  int precincts_wide = 0, precincts_high = 0, px = 15, py = 15;
  std::vector<BandOfTile> bands;
};

// Bits of a packet's head; behind a byte FF one bit is left out.
class HeadBits {
 public:
  explicit HeadBits(Reader& from) : from_(from) {}
  int bit() {
    if (left_ == 0) {
      left_ = now_ == 0xFF ? 7 : 8;
      ended_ = ended_ || !from_.has(1);
      now_ = from_.number(1);
    }
    --left_;
    return static_cast<int>(now_ >> left_ & 1U);
  }
  int bits(int count) {
    int value = 0;
    for (int n = 0; n < count; ++n) value = value << 1 | bit();
    return value;
  }
  void end() {
    if (now_ == 0xFF) from_.number(1);
    left_ = 0;
    now_ = 0;
  }
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  Reader& from_;
  unsigned now_ = 0;
  int left_ = 0;
  bool ended_ = false;
};

class Tile {
 public:
  Tile(const Picture& picture, const Coding& coding, const Area& area)
      : picture_(picture), coding_(coding), area_(area) {}

  bool shape() {
    std::size_t blocks = 0;
    for (int r = 0; r <= coding_.levels; ++r)
      if (!add_resolution(r, blocks)) return false;
    return true;
  }
  // False: damaged, or not all of it is there.
  bool read_packets(Bytes bytes) {
    std::size_t packets = 0;
    for (const Resolution& one : resolutions_)
      packets += static_cast<std::size_t>(one.precincts_wide) *
                 static_cast<std::size_t>(one.precincts_high) *
                 static_cast<std::size_t>(coding_.layers);
    if (packets > bytes.size()) return false;  // each takes a byte at least
    Reader from(bytes);
    for (const Turn& turn : order())
      if (!read_packet(from, resolutions_[static_cast<std::size_t>(turn.resolution)],
                       static_cast<std::size_t>(turn.precinct), turn.layer))
        return false;
    return true;
  }
  std::vector<float> values() {
    std::vector<float> all = coefficients(resolutions_.front().bands.front());
    for (std::size_t r = 1; r < resolutions_.size(); ++r) {
      const Resolution& one = resolutions_[r];
      std::vector<float> next(one.area.count());
      put(all, resolutions_[r - 1].area, 0, 0, one.area, next);
      for (const BandOfTile& band : one.bands)
        put(coefficients(band), band.area, band.kind != Band::lh ? 1 : 0,
            band.kind != Band::hl ? 1 : 0, one.area, next);
      unwave(next, one.area, coding_.whole);
      all = std::move(next);
    }
    return all;
  }

 private:
  struct Turn {
    int layer, resolution, precinct;
  };

  bool add_resolution(int r, std::size_t& blocks) {
    Resolution& one = resolutions_.emplace_back();
    const int down = coding_.levels - r;
    one.area = {up(area_.x0, down), up(area_.y0, down), up(area_.x1, down), up(area_.y1, down)};
    one.px = coding_.precincts[static_cast<std::size_t>(r)] & 15;
    one.py = coding_.precincts[static_cast<std::size_t>(r)] >> 4;
    if (one.area.count() > 0) {
      one.precincts_wide = up(one.area.x1, one.px) - (one.area.x0 >> one.px);
      one.precincts_high = up(one.area.y1, one.py) - (one.area.y0 >> one.py);
    }
    for (int b = r == 0 ? 0 : 1; b <= (r == 0 ? 0 : 3); ++b) {
      BandOfTile& band = one.bands.emplace_back();
      band.kind = static_cast<Band>(b);
      const int level = r == 0 ? coding_.levels : coding_.levels - r + 1;
      const auto edge = [&](int value, bool odd) {
        return odd ? up(std::int64_t{value} - (std::int64_t{1} << (level - 1)), level)
                   : up(value, level);
      };
      const bool h = band.kind == Band::hl || band.kind == Band::hh,
                 v = band.kind == Band::lh || band.kind == Band::hh;
      band.area = {edge(area_.x0, h), edge(area_.y0, v), edge(area_.x1, h), edge(area_.y1, v)};
      if (!set_step(band, r, level)) return false;
      add_blocks(band, one, r > 0, blocks);
      if (blocks > 4 * area_.count() + 64) return false;
    }
    return true;
  }
  bool set_step(BandOfTile& band, int r, int level) {
    const std::size_t n =
        r == 0 ? 0 : static_cast<std::size_t>(3 * (r - 1)) + static_cast<std::size_t>(band.kind);
    const std::size_t which = coding_.steps == 1 ? 0 : n;
    if (which >= coding_.step.size()) return false;
    const int told = coding_.step[which];
    int exponent = coding_.steps == 0 ? told >> 3 : told >> 11;
    if (coding_.steps == 1) exponent += level - coding_.levels;
    const int gain = band.kind == Band::ll ? 0 : band.kind == Band::hh ? 2 : 1;
    if (!coding_.whole && coding_.steps > 0)
      band.step = std::ldexp(1 + static_cast<float>(told & 2047) / 2048,
                             picture_.precision + gain - exponent);
    band.planes = coding_.guard + exponent - 1;
    return band.planes <= kMostPlanes;
  }
  void add_blocks(BandOfTile& band, const Resolution& in, bool halved, std::size_t& blocks) const {
    const int px = in.px - (halved ? 1 : 0), py = in.py - (halved ? 1 : 0);
    const int bx = std::min(coding_.block_x, px), by = std::min(coding_.block_y, py);
    const int first_x = in.area.x0 >> in.px, first_y = in.area.y0 >> in.py;
    for (int y = 0; y < in.precincts_high; ++y)
      for (int x = 0; x < in.precincts_wide; ++x) {
        Precinct& one = band.precincts.emplace_back();
        const auto along = [](int first, int shift, int low, int high) {
          const std::int64_t from = std::int64_t{first} << shift,
                             to = std::int64_t{first + 1} << shift;
          return std::pair{static_cast<int>(std::clamp<std::int64_t>(from, low, high)),
                           static_cast<int>(std::clamp<std::int64_t>(to, low, high))};
        };
        const auto [x0, x1] = along(first_x + x, px, band.area.x0, band.area.x1);
        const auto [y0, y1] = along(first_y + y, py, band.area.y0, band.area.y1);
        if (++blocks; x0 >= x1 || y0 >= y1) continue;
        one.wide = up(x1, bx) - (x0 >> bx);
        one.high = up(y1, by) - (y0 >> by);
        blocks += static_cast<std::size_t>(one.wide) * static_cast<std::size_t>(one.high);
        if (blocks > 4 * area_.count() + 64) return;
        one.included.shape(one.wide, one.high);
        one.empty_planes.shape(one.wide, one.high);
        for (int j = y0 >> by; j < up(y1, by); ++j)
          for (int i = x0 >> bx; i < up(x1, bx); ++i)
            one.blocks.emplace_back().area = {std::max(x0, i << bx), std::max(y0, j << by),
                                              std::min(x1, (i + 1) << bx),
                                              std::min(y1, (j + 1) << by)};
      }
  }

  // The packets in the order of the file (B.12).
  [[nodiscard]] std::vector<Turn> order() const {
    std::vector<Turn> turns;
    const int resolutions = static_cast<int>(resolutions_.size());
    const auto precincts = [&](int r) {
      const Resolution& one = resolutions_[static_cast<std::size_t>(r)];
      return one.precincts_wide * one.precincts_high;
    };
    const int layers = coding_.layers;
    if (coding_.order == 0) {
      for (int l = 0; l < layers; ++l)
        for (int r = 0; r < resolutions; ++r)
          for (int p = 0; p < precincts(r); ++p) turns.push_back({l, r, p});
    } else if (coding_.order == 1) {
      for (int r = 0; r < resolutions; ++r)
        for (int l = 0; l < layers; ++l)
          for (int p = 0; p < precincts(r); ++p) turns.push_back({l, r, p});
    } else {
      for (int r = 0; r < resolutions; ++r)
        for (int p = 0; p < precincts(r); ++p)
          for (int l = 0; l < layers; ++l) turns.push_back({l, r, p});
      // by place in the picture, then by resolution
      if (coding_.order >= 3)
        std::stable_sort(turns.begin(), turns.end(), [this](const Turn& a, const Turn& b) {
          return std::pair(place(a), a.resolution) < std::pair(place(b), b.resolution);
        });
    }
    return turns;
  }
  [[nodiscard]] std::pair<std::int64_t, std::int64_t> place(const Turn& turn) const {
    const Resolution& one = resolutions_[static_cast<std::size_t>(turn.resolution)];
    const int down = coding_.levels - turn.resolution;
    const std::int64_t x = (one.area.x0 >> one.px) + turn.precinct % one.precincts_wide,
                       y = (one.area.y0 >> one.py) + turn.precinct / one.precincts_wide;
    return {std::max<std::int64_t>(area_.y0, y << (one.py + down)),
            std::max<std::int64_t>(area_.x0, x << (one.px + down))};
  }

  struct Part {
    CodeBlock* block;
    std::size_t segment;
    int bytes;
  };
  bool read_packet(Reader& from, Resolution& in, std::size_t precinct, int layer) {
    if (coding_.starts) {
      Reader ahead = from;
      if (ahead.number(2) == 0xFF91) from.take(6);
    }
    HeadBits bits(from);
    std::vector<Part> parts;
    if (bits.bit() == 1)
      for (BandOfTile& band : in.bands) {
        Precinct& one = band.precincts[precinct];
        for (std::size_t n = 0; n < one.blocks.size(); ++n)
          if (!read_block_head(bits, band, one, n, layer, parts)) return false;
      }
    bits.end();
    if (bits.ended()) return false;
    if (coding_.ends) {
      Reader ahead = from;
      if (ahead.number(2) == 0xFF92) from.take(2);
    }
    for (const Part& part : parts) {
      const Bytes bytes = from.take(static_cast<std::size_t>(part.bytes));
      std::vector<std::uint8_t>& to = part.block->segments[part.segment].bytes;
      to.insert(to.end(), bytes.begin(), bytes.end());
      if (bytes.size() < static_cast<std::size_t>(part.bytes)) return false;
    }
    return true;
  }
  bool read_block_head(HeadBits& bits, const BandOfTile& band, Precinct& in, std::size_t n,
                       int layer, std::vector<Part>& parts) const {
    CodeBlock& block = in.blocks[n];
    const int x = static_cast<int>(n) % in.wide, y = static_cast<int>(n) / in.wide;
    const auto bit = [&bits] { return bits.bit(); };
    if (block.begun) {
      if (bits.bit() == 0) return !bits.ended();
    } else {
      if (!in.included.below(x, y, layer + 1, bit)) return !bits.ended();
      int limit = 1;
      while (!in.empty_planes.below(x, y, limit, bit)) {
        if (++limit > kMostPlanes + 2 || bits.ended()) return false;
      }
      block.planes = band.planes - in.empty_planes.value(x, y);
      if (block.planes < 0) return false;
      block.begun = true;
    }
    int passes = passes_of(bits);
    while (bits.bit() == 1)
      if (++block.length_bits > 31) return false;
    while (passes > 0) {
      if (block.room == 0) {
        block.room = room_of(block);
        block.segments.emplace_back();
      }
      const int some = std::min(passes, static_cast<int>(block.room));
      const int size =
          block.length_bits + static_cast<int>(std::bit_width(static_cast<unsigned>(some))) - 1;
      if (size > 31 || bits.ended()) return false;
      parts.push_back({&block, block.segments.size() - 1, bits.bits(size)});
      block.segments.back().passes += some;
      block.room -= static_cast<std::size_t>(some);
      block.passes += some;
      passes -= some;
    }
    return !bits.ended();
  }
  // Table B.4.
  static int passes_of(HeadBits& bits) {
    if (bits.bit() == 0) return 1;
    if (bits.bit() == 0) return 2;
    int n = bits.bits(2);
    if (n < 3) return 3 + n;
    n = bits.bits(5);
    if (n < 31) return 6 + n;
    return 37 + bits.bits(7);
  }
  [[nodiscard]] std::size_t room_of(const CodeBlock& block) const {
    if ((coding_.style & kEachPass) != 0) return 1;
    if ((coding_.style & kBypass) == 0) return 200;
    if (block.passes < 10) return static_cast<std::size_t>(10 - block.passes);
    return (block.passes - 10) % 3 == 2 ? 1 : 2;
  }

  [[nodiscard]] std::vector<float> coefficients(const BandOfTile& band) const {
    std::vector<float> all(band.area.count());
    for (const Precinct& precinct : band.precincts)
      for (const CodeBlock& block : precinct.blocks) {
        if (block.planes <= 0 || block.segments.empty()) continue;
        const Area& area = block.area;
        const auto values = decode_block(area.wide(), area.high(), block.planes, band.kind,
                                         coding_.style, block.segments);
        std::size_t n = 0;
        for (int y = area.y0; y < area.y1; ++y)
          for (int x = area.x0; x < area.x1; ++x, ++n)
            all[static_cast<std::size_t>(y - band.area.y0) *
                    static_cast<std::size_t>(band.area.wide()) +
                static_cast<std::size_t>(x - band.area.x0)] =
                coding_.whole ? static_cast<float>(values[n] / 2)
                              : 0.5F * band.step * static_cast<float>(values[n]);
      }
    return all;
  }
  // A band's values go to every second place of the grid.
  static void put(const std::vector<float>& from, const Area& band, int odd_x, int odd_y,
                  const Area& area, std::vector<float>& to) {
    std::size_t n = 0;
    for (int y = band.y0; y < band.y1; ++y)
      for (int x = band.x0; x < band.x1; ++x, ++n)
        to[static_cast<std::size_t>(2 * y + odd_y - area.y0) *
               static_cast<std::size_t>(area.wide()) +
           static_cast<std::size_t>(2 * x + odd_x - area.x0)] = from[n];
  }

  const Picture& picture_;
  const Coding& coding_;
  Area area_;
  std::vector<Resolution> resolutions_;
};

struct TileParts {
  std::optional<Coding> coding;
  std::vector<std::uint8_t> bytes;
};

// A tile-part: its own marks, then its packets.
bool read_part(Reader& from, const Picture& picture, std::vector<TileParts>& tiles) {
  const std::size_t begun = from.at() - 2;
  if (!from.has(10)) return false;
  from.number(2);
  const std::uint32_t tile = from.number(2), length = from.number(4);
  from.number(2);
  if (tile >= tiles.size()) return false;
  TileParts& to = tiles[tile];
  if (!to.coding) to.coding = picture.coding;
  for (;;) {
    if (!from.has(2)) return false;
    const std::uint32_t mark = from.number(2);
    if (mark == 0xFF93) break;
    const std::uint32_t size = from.number(2);
    if (size < 2 || !from.has(size - 2) || !read_mark(mark, from.take(size - 2), *to.coding))
      return false;
  }
  const std::size_t head = from.at() - begun;
  if (length != 0 && length < head) return false;
  // the last one may say 0: until the end mark
  const Bytes bytes =
      from.take(length == 0 ? from.left() - std::min<std::size_t>(2, from.left()) : length - head);
  to.bytes.insert(to.bytes.end(), bytes.begin(), bytes.end());
  return true;
}

bool read_stream(Bytes bytes, const Unpacked& wanted, Picture& picture,
                 std::vector<TileParts>& tiles) {
  Reader from(bytes);
  if (from.number(2) != 0xFF4F) return false;
  bool sized = false, coded = false, stepped = false;
  while (from.has(2)) {
    const std::uint32_t mark = from.number(2);
    if (mark == 0xFFD9) return true;
    if (mark == 0xFF90) {
      if (!sized || !coded || !stepped) return false;
      if (!read_part(from, picture, tiles)) return !tiles.front().bytes.empty() && from.left() == 0;
      continue;
    }
    const std::uint32_t size = from.number(2);
    if (size < 2 || !from.has(size - 2)) return false;
    const Bytes part = from.take(size - 2);
    if (mark == 0xFF51) {
      if (!read_size(Reader(part), picture)) return false;
      if (picture.area.wide() != wanted.columns || picture.area.high() != wanted.rows) return false;
      if (std::int64_t{picture.across()} * picture.down() > 65535) return false;
      tiles.resize(static_cast<std::size_t>(picture.across() * picture.down()));
      sized = true;
    } else if (!read_mark(mark, part, picture.coding)) {
      return false;
    }
    coded = coded || mark == 0xFF52;
    stepped = stepped || mark == 0xFF5C;
  }
  return sized;
}

bool decode_tile(const Picture& picture, const TileParts& parts, int number, Unpacked& to) {
  const int x = number % picture.across(), y = number / picture.across();
  const Area& whole = picture.area;
  const Area area = {std::max(whole.x0, picture.tile_x + x * picture.tile_wide),
                     std::max(whole.y0, picture.tile_y + y * picture.tile_high),
                     std::min(whole.x1, picture.tile_x + (x + 1) * picture.tile_wide),
                     std::min(whole.y1, picture.tile_y + (y + 1) * picture.tile_high)};
  const Coding& coding = *parts.coding;
  Tile tile(picture, coding, area);
  if (!tile.shape() || !tile.read_packets(parts.bytes)) return false;
  const std::vector<float> values = tile.values();
  const int half = picture.has_signs ? 0 : 1 << (picture.precision - 1);
  const int low = picture.has_signs ? -(1 << (picture.precision - 1)) : 0,
            high = low + (1 << picture.precision) - 1;
  std::size_t n = 0;
  for (int j = area.y0 - whole.y0; j < area.y1 - whole.y0; ++j)
    for (int i = area.x0 - whole.x0; i < area.x1 - whole.x0; ++i, ++n) {
      const float value = std::clamp(std::nearbyint(values[n]), -1e6F, 1e6F);
      to.values[static_cast<std::size_t>(j) * static_cast<std::size_t>(to.columns) +
                static_cast<std::size_t>(i)] =
          std::clamp(static_cast<int>(value) + half, low, high);
    }
  return true;
}

}  // namespace

bool unpack_jpeg_2000(Bytes bytes, Unpacked& to) {
  // in a JP2 file the codestream begins later
  constexpr std::array<std::uint8_t, 4> kBegin = {0xFF, 0x4F, 0xFF, 0x51};
  const auto begin = std::search(bytes.begin(), bytes.end(), kBegin.begin(), kBegin.end());
  if (begin == bytes.end()) return false;
  Picture picture;
  std::vector<TileParts> tiles;
  if (!read_stream(bytes.subspan(static_cast<std::size_t>(begin - bytes.begin())), to, picture,
                   tiles))
    return false;
  to.values.assign(static_cast<std::size_t>(to.columns) * static_cast<std::size_t>(to.rows), 0);
  for (std::size_t n = 0; n < tiles.size(); ++n)
    if (!tiles[n].coding || !decode_tile(picture, tiles[n], static_cast<int>(n), to)) return false;
  return true;
}

}  // namespace burr::web
