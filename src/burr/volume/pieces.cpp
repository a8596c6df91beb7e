#include "burr/volume/pieces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "burr/base/check.h"

namespace burr::volume {

using math::Ijk;

namespace {

constexpr std::uint8_t kAir = 0, kWhole = 1, kMixed = 2;
constexpr int kFace = kBrickEdge * kBrickEdge;

// The labels inside a brick: 0 outside, 1.. the pieces in the order of their first voxels.
struct Labels {
  std::array<std::uint8_t, kBrickVoxels> of{};
  int count = 0;
};

std::uint16_t root_of(std::array<std::uint16_t, kBrickVoxels>& parent, std::uint16_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

Labels labels_of(const Field* field, int most) {
  Labels labels;
  std::array<std::uint16_t, kBrickVoxels> parent;
  std::iota(parent.begin(), parent.end(), std::uint16_t{0});
  constexpr std::array<int, 3> kBack = {1, kBrickEdge, kFace};
  const auto inside = [field](int v) { return field[v] >= kIso; };
  for (int v = 0; v < kBrickVoxels; ++v) {
    if (!inside(v)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((v >> (3 * static_cast<int>(axis)) & 7) == 0 || !inside(v - kBack[axis])) continue;
      const std::uint16_t a = root_of(parent, static_cast<std::uint16_t>(v)),
                          b = root_of(parent, static_cast<std::uint16_t>(v - kBack[axis]));
      parent[std::max(a, b)] = std::min(a, b);  // the root is the first voxel
    }
  }
  for (int v = 0; v < kBrickVoxels; ++v) {
    if (!inside(v)) continue;
    const std::uint16_t first = root_of(parent, static_cast<std::uint16_t>(v));
    if (first == v) labels.count = std::min(labels.count + 1, most);
    labels.of[static_cast<std::size_t>(v)] =
        first == v ? static_cast<std::uint8_t>(labels.count) : labels.of[first];
  }
  return labels;
}

// Voxel p of the face across `axis`, at the low or the high end.
int on_face(int axis, bool high, int p) {
  const int a = p & 7, b = p >> 3, end = high ? kBrickEdge - 1 : 0;
  if (axis == 0) return end + kBrickEdge * a + kFace * b;
  if (axis == 1) return a + kBrickEdge * end + kFace * b;
  return a + kBrickEdge * b + kFace * end;
}

}  // namespace

struct PieceFinder::Local {
  struct One {
    std::int32_t voxels = 0;
    std::array<std::uint8_t, 3> low{7, 7, 7}, high{0, 0, 0};
    std::uint16_t seed = 0;
  };
  std::vector<One> pieces;
  std::array<std::array<std::uint8_t, kFace>, 6> face{};  // 2 axis + (1: high end)
};

PieceFinder::PieceFinder(const Bone& bone, std::uint8_t unread)
    : bone_(bone),
      again_(static_cast<std::size_t>(bone.brick_count()), unread),
      kind_(again_.size(), kAir),
      local_(again_.size()),
      first_(again_.size()) {}

PieceFinder::PieceFinder(Bone& bone) : PieceFinder(bone, 1) { changed_ = &bone.add_watcher(); }

PieceFinder::PieceFinder(const Bone& bone) : PieceFinder(bone, 0) {
  BrickField field;
  for (BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const Field* const at = bone.brick_field(brick);
    if (at == nullptr) continue;
    std::copy_n(at, kBrickVoxels, field.voxel);
    read(brick, field);
  }
  join();
}

PieceFinder::~PieceFinder() = default;

std::size_t PieceFinder::update() {
  if (changed_ != nullptr) changed_->take_all([this](std::size_t brick) { again_[brick] = 1; });
  std::size_t left = 0;
  bool any = false;
  BrickField field;
  for (std::size_t n = 0; n < again_.size(); ++n) {
    if (again_[n] == 0) continue;
    const auto brick = static_cast<BrickIndex>(n);
    if (!bone_.copy_brick(brick, field)) {
      ++left;
      continue;
    }
    again_[n] = 0;
    any = true;
    read(brick, field);
  }
  if (any) join();
  return left;
}

void PieceFinder::read(BrickIndex brick, const BrickField& field) {
  const auto n = static_cast<std::size_t>(brick);
  const auto [least, most] = std::minmax_element(std::begin(field.voxel), std::end(field.voxel));
  local_[n].reset();
  kind_[n] = *most < kIso ? kAir : *least >= kIso ? kWhole : kMixed;
  if (kind_[n] != kMixed) return;
  const Labels labels = labels_of(field.voxel, kMost);
  auto local = std::make_unique<Local>();
  local->pieces.resize(static_cast<std::size_t>(labels.count));
  for (int v = kBrickVoxels - 1; v >= 0; --v) {
    const std::uint8_t label = labels.of[static_cast<std::size_t>(v)];
    if (label == 0) continue;
    Local::One& one = local->pieces[label - 1U];
    ++one.voxels;
    one.seed = static_cast<std::uint16_t>(v);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::uint8_t>(v >> (3 * static_cast<int>(axis)) & 7);
      one.low[axis] = std::min(one.low[axis], at);
      one.high[axis] = std::max(one.high[axis], at);
    }
  }
  for (int side = 0; side < 6; ++side)
    for (int p = 0; p < kFace; ++p)
      local->face[static_cast<std::size_t>(side)][static_cast<std::size_t>(p)] =
          labels.of[static_cast<std::size_t>(on_face(side / 2, side % 2 == 1, p))];
  local_[n] = std::move(local);
}

std::uint32_t PieceFinder::root(std::uint32_t node) {
  while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
  return node;
}

// Joins the pieces of neighbouring bricks, and sums up each of them.
void PieceFinder::join() {
  std::uint32_t nodes = 0;
  for (std::size_t n = 0; n < kind_.size(); ++n) {
    first_[n] = nodes;
    if (kind_[n] != kAir)
      nodes += kind_[n] == kWhole ? 1U : static_cast<std::uint32_t>(local_[n]->pieces.size());
  }
  parent_.resize(nodes);
  std::iota(parent_.begin(), parent_.end(), 0U);
  const Ijk& bricks = bone_.bricks();
  const std::array<int, 3> step = {1, bricks.x(), bricks.x() * bricks.y()};
  const auto label_at = [this](std::size_t brick, std::size_t side, std::size_t p) {
    return kind_[brick] == kWhole ? 1U : unsigned{local_[brick]->face[side][p]};
  };
  for (BrickIndex brick = 0; brick < bone_.brick_count(); ++brick) {
    const auto n = static_cast<std::size_t>(brick);
    if (kind_[n] == kAir) continue;
    const Ijk at = bone_.brick_ijk(brick) / kBrickEdge;
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] + 1 >= bricks[axis]) continue;
      const std::size_t next = n + static_cast<std::size_t>(step[static_cast<std::size_t>(axis)]);
      if (kind_[next] == kAir) continue;
      const std::size_t places = kind_[n] == kWhole && kind_[next] == kWhole ? 1 : kFace;
      for (std::size_t p = 0; p < places; ++p) {
        const unsigned mine = label_at(n, static_cast<std::size_t>(2 * axis + 1), p),
                       other = label_at(next, static_cast<std::size_t>(2 * axis), p);
        if (mine == 0 || other == 0) continue;
        const std::uint32_t a = root(first_[n] + mine - 1), b = root(first_[next] + other - 1);
        parent_[std::max(a, b)] = std::min(a, b);
      }
    }
  }

  pieces_.clear();
  piece_of_node_.assign(nodes, kNone);
  for (BrickIndex brick = 0; brick < bone_.brick_count(); ++brick) {
    const auto n = static_cast<std::size_t>(brick);
    if (kind_[n] == kAir) continue;
    const Ijk corner = bone_.brick_ijk(brick);
    const std::size_t count = kind_[n] == kWhole ? 1 : local_[n]->pieces.size();
    Local::One whole;
    whole.voxels = kBrickVoxels;
    whole.low = {0, 0, 0};
    whole.high = {7, 7, 7};
    for (std::size_t one = 0; one < count; ++one) {
      const Local::One& part = kind_[n] == kWhole ? whole : local_[n]->pieces[one];
      const auto node = static_cast<std::uint32_t>(first_[n] + one);
      std::int32_t& number = piece_of_node_[root(node)];
      if (number == kNone) {
        number = static_cast<std::int32_t>(pieces_.size());
        Piece& fresh = pieces_.emplace_back();
        fresh.low = Ijk::Constant(std::numeric_limits<int>::max());
        fresh.high = Ijk::Constant(-1);
        fresh.seed = corner + Ijk(part.seed & 7, part.seed >> 3 & 7, part.seed >> 6);
      }
      piece_of_node_[node] = number;
      Piece& piece = pieces_[static_cast<std::size_t>(number)];
      piece.voxels += part.voxels;
      const Ijk low(part.low[0], part.low[1], part.low[2]),
          high(part.high[0], part.high[1], part.high[2]);
      piece.low = piece.low.cwiseMin(corner + low);
      piece.high = piece.high.cwiseMax(corner + high);
    }
  }
  // the largest first; those of one size stay in the order of their seeds
  std::vector<std::size_t> order(pieces_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
    return pieces_[a].voxels > pieces_[b].voxels;
  });
  std::vector<Piece> sorted;
  std::vector<std::int32_t> rank(pieces_.size());
  for (std::size_t n = 0; n < order.size(); ++n) {
    sorted.push_back(pieces_[order[n]]);
    rank[order[n]] = static_cast<std::int32_t>(n);
  }
  pieces_ = std::move(sorted);
  for (std::int32_t& number : piece_of_node_)
    if (number != kNone) number = rank[static_cast<std::size_t>(number)];
}

void PieceFinder::label(BrickIndex brick, std::array<std::int32_t, kBrickVoxels>& out) const {
  const auto n = static_cast<std::size_t>(brick);
  out.fill(kNone);
  if (kind_[n] == kAir) return;
  if (kind_[n] == kWhole) {
    out.fill(piece_of_node_[first_[n]]);
    return;
  }
  const Field* const field = bone_.brick_field(brick);
  if (field == nullptr) return;
  const Labels labels = labels_of(field, kMost);
  for (std::size_t v = 0; v < out.size(); ++v)
    if (labels.of[v] != 0 && labels.of[v] <= local_[n]->pieces.size())
      out[v] = piece_of_node_[first_[n] + labels.of[v] - 1U];
}

int PieceFinder::piece_of(const Ijk& voxel) const {
  if (!bone_.grid().contains(voxel)) return kNone;
  const Ijk at = voxel / kBrickEdge, in = voxel - at * kBrickEdge;
  std::array<std::int32_t, kBrickVoxels> labels;
  label(bone_.brick_at(at.x(), at.y(), at.z()), labels);
  return labels[static_cast<std::size_t>(in.x() + kBrickEdge * in.y() + kFace * in.z())];
}

namespace {

// The labels of a brick and of those around it, as they are needed.
class Around {
 public:
  Around(const Bone& bone, const PieceFinder& finder) : bone_(bone), finder_(finder) {}
  std::int32_t at(const Ijk& voxel) {
    if ((voxel.array() < 0).any()) return PieceFinder::kNone;
    const Ijk brick = voxel / kBrickEdge, in = voxel - brick * kBrickEdge;
    if ((brick.array() >= bone_.bricks().array()).any()) return PieceFinder::kNone;
    const BrickIndex index = bone_.brick_at(brick.x(), brick.y(), brick.z());
    if (kept_.size() > 4096) kept_.clear();
    const auto [found, fresh] = kept_.try_emplace(index);
    if (fresh) finder_.label(index, found->second);
    return found->second[static_cast<std::size_t>(in.x() + kBrickEdge * in.y() + kFace * in.z())];
  }
  // The piece that this voxel of the ramp lies beside.
  std::int32_t nearest(const Ijk& voxel) {
    constexpr int kReach = static_cast<int>(kRamp);
    int least = std::numeric_limits<int>::max();
    std::int32_t piece = PieceFinder::kNone;
    for (int k = -kReach; k <= kReach; ++k)
      for (int j = -kReach; j <= kReach; ++j)
        for (int i = -kReach; i <= kReach; ++i) {
          const int far = i * i + j * j + k * k;
          if (far > least) continue;
          const std::int32_t other = at(voxel + Ijk(i, j, k));
          if (other == PieceFinder::kNone || (far == least && other >= piece)) continue;
          least = far;
          piece = other;
        }
    return piece == PieceFinder::kNone ? 0 : piece;
  }

 private:
  const Bone& bone_;
  const PieceFinder& finder_;
  std::unordered_map<BrickIndex, std::array<std::int32_t, kBrickVoxels>> kept_;
};

}  // namespace

Result<std::unique_ptr<Bone>> piece_as_bone(const Bone& bone, const PieceFinder& finder,
                                            std::size_t piece,
                                            const std::vector<std::size_t>& with) {
  if (piece >= finder.pieces().size())
    return error("the bone has " + std::to_string(finder.pieces().size()) +
                 " pieces; there is no number " + std::to_string(piece + 1));
  const auto wanted = static_cast<std::int32_t>(piece);
  const auto goes = [&](std::int32_t of) {
    return of == wanted || std::find(with.begin(), with.end(), static_cast<std::size_t>(of)) !=
                               with.end();  // kNone is none of them
  };
  auto out = std::make_unique<Bone>(bone.grid(), bone.tissues(), bone.used_slots(), 0, false);
  Around around(bone, finder);
  std::array<std::int32_t, kBrickVoxels> labels;
  // nothing further away belongs to it, unless it is the largest
  const Ijk reach = Ijk::Constant(static_cast<int>(kRamp));
  const Ijk low = finder.pieces()[piece].low - reach, high = finder.pieces()[piece].high + reach;
  for (BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const Field* const field = bone.brick_field(brick);
    if (field == nullptr) continue;
    const Ijk first = bone.brick_ijk(brick), last = first + Ijk::Constant(kBrickEdge - 1);
    if (wanted > 0 && ((last.array() < low.array()).any() || (first.array() > high.array()).any()))
      continue;
    finder.label(brick, labels);
    BrickField mine = {};
    bool any = false;
    const Ijk corner = bone.brick_ijk(brick);
    for (int v = 0; v < kBrickVoxels; ++v) {
      if (field[v] == 0) continue;
      std::int32_t of = labels[static_cast<std::size_t>(v)];
      if (of == PieceFinder::kNone) of = around.nearest(corner + Ijk(v & 7, v >> 3 & 7, v >> 6));
      if (!goes(of)) continue;
      mine.voxel[v] = field[v];
      any = true;
    }
    if (any) out->build_brick(brick, mine.voxel, bone.brick_tissue(brick));
  }
  out->pack();
  return out;
}

}  // namespace burr::volume
