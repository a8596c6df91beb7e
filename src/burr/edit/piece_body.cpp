#include "burr/edit/piece_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "burr/base/hash.h"
#include "burr/tool/shape_grid.h"

namespace burr::edit {
namespace {

using math::Ijk;
using math::Vec3;
using volume::Bone;

constexpr int kLargestStride = 3;  // voxels to a cell; 33 bytes a voxel while it is made: 180 MB
constexpr int kFarthest = 127;     // that the lattice can say  [cell]

// Distances at every voxel of a box around the piece  [voxel].
class Distances {
 public:
  Distances(const Bone& piece, const Ijk& first, const Ijk& size)
      : piece_(piece), first_(first), size_(size) {
    const std::size_t count = static_cast<std::size_t>(size.x()) *
                              static_cast<std::size_t>(size.y()) *
                              static_cast<std::size_t>(size.z());
    distance_.assign(count, std::numeric_limits<double>::infinity());
    nearest_.assign(count, Vec3::Zero());
    inside_.assign(count, 0);
    each([this](const Ijk& at) { begin(at); });
    for (int round = 0; round < kRounds; ++round)
      for (int way = 0; way < 8; ++way) sweep(way);
  }
  // Below 0 inside.
  [[nodiscard]] double at(const Ijk& node) const {
    const std::size_t n = number(node);
    return inside_[n] != 0 ? -distance_[n] : distance_[n];
  }

 private:
  static constexpr int kRounds = 2;

  [[nodiscard]] std::size_t number(const Ijk& node) const {
    return (static_cast<std::size_t>(node.z()) * static_cast<std::size_t>(size_.y()) +
            static_cast<std::size_t>(node.y())) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(node.x());
  }
  template <class Use>
  void each(const Use& use) const {
    for (int z = 0; z < size_.z(); ++z)
      for (int y = 0; y < size_.y(); ++y)
        for (int x = 0; x < size_.x(); ++x) use(Ijk(x, y, z));
  }
  [[nodiscard]] double field(const Ijk& node) const {
    const Ijk voxel = first_ + node;
    return piece_.grid().contains(voxel)
               ? static_cast<double>(piece_.field(voxel.x(), voxel.y(), voxel.z()))
               : 0.0;
  }

  // Beside the surface: the distance to the plane through the crossings along the axes.
  void begin(const Ijk& at) {
    const double here = field(at) - volume::kIso;
    const std::size_t n = number(at);
    inside_[n] = here >= 0 ? 1 : 0;
    Vec3 plane = Vec3::Zero();  // 1 / the distance along each axis, with its sign
    double least = 1;           // of these distances
    for (int axis = 0; axis < 3; ++axis) {
      double nearest = std::numeric_limits<double>::infinity();
      int side = 0;
      for (const int step : {-1, 1}) {
        Ijk next = at;
        next[axis] += step;
        const double there = field(next) - volume::kIso;
        if ((there >= 0) == (here >= 0)) continue;
        const double along = here / (here - there);
        if (along >= nearest) continue;
        nearest = along;
        side = step;
      }
      if (side == 0) continue;
      least = std::min(least, nearest);
      plane[axis] = side / std::max(nearest, kOnIt);
    }
    const double square = plane.squaredNorm();
    if (square == 0) return;
    distance_[n] = least < kOnIt ? 0 : 1 / std::sqrt(square);
    nearest_[n] = at.cast<double>() + plane / square;
  }

  // The nearest points of the neighbours that were passed already.
  void sweep(int way) {
    const Ijk step((way & 1) != 0 ? -1 : 1, (way & 2) != 0 ? -1 : 1, (way & 4) != 0 ? -1 : 1);
    for (int k = 0; k < size_.z(); ++k)
      for (int j = 0; j < size_.y(); ++j)
        for (int i = 0; i < size_.x(); ++i) {
          const Ijk at(step.x() > 0 ? i : size_.x() - 1 - i, step.y() > 0 ? j : size_.y() - 1 - j,
                       step.z() > 0 ? k : size_.z() - 1 - k);
          const std::size_t n = number(at);
          for (int axis = 0; axis < 3; ++axis) {
            Ijk before = at;
            before[axis] -= step[axis];
            if (before[axis] < 0 || before[axis] >= size_[axis]) continue;
            const std::size_t b = number(before);
            if (!(distance_[b] < std::numeric_limits<double>::infinity())) continue;
            const double far = (nearest_[b] - at.cast<double>()).norm();
            if (far >= distance_[n]) continue;
            distance_[n] = far;
            nearest_[n] = nearest_[b];
          }
        }
  }

  static constexpr double kOnIt = 1e-6;  // [voxel]
  const Bone& piece_;
  Ijk first_, size_;
  std::vector<double> distance_;
  std::vector<Vec3> nearest_;
  std::vector<char> inside_;
};

// Nodes of a lattice with `stride` voxels to a cell that has two cells of air around the box.
std::array<int, 3> nodes_of(const Ijk& low, const Ijk& high, int stride) {
  std::array<int, 3> size{};
  for (int axis = 0; axis < 3; ++axis)
    size[static_cast<std::size_t>(axis)] =
        (high[axis] - low[axis] + 4 * stride + stride - 1) / stride + 1;
  return size;
}

bool fits(const std::array<int, 3>& size) {
  double nodes = 1;
  for (const int n : size) {
    if (n > tool::kMostAlongAxis) return false;
    nodes *= n;
  }
  return nodes <= tool::kMostNodes;
}

}  // namespace

Result<BodyGrid> body_of(const Bone& piece, const Ijk& low, const Ijk& high, const Vec3& centre) {
  int stride = 1;
  while (stride < kLargestStride && !fits(nodes_of(low, high, stride))) ++stride;
  tool::GridCells cells;
  cells.size = nodes_of(low, high, stride);
  if (!fits(cells.size))
    return error(Trouble::usage, "the piece is too large to be held; move it by numbers");
  const Ijk nodes(cells.size[0], cells.size[1], cells.size[2]),
      first = low - Ijk::Constant(2 * stride);
  const Distances distances(piece, first, Ijk(stride * (nodes - Ijk::Ones()) + Ijk::Ones()));
  cells.phi.reserve(static_cast<std::size_t>(nodes.prod()));
  for (int z = 0; z < nodes.z(); ++z)
    for (int y = 0; y < nodes.y(); ++y)
      for (int x = 0; x < nodes.x(); ++x) {
        const double cell = std::clamp(distances.at(stride * Ijk(x, y, z)) / stride,
                                       -1.0 * kFarthest, 1.0 * kFarthest);
        cells.phi.push_back(static_cast<std::int16_t>(std::lround(tool::kPerCell * cell)));
      }
  const volume::Grid& grid = piece.grid();
  const Vec3 middle = first.cast<double>() + 0.5 * stride * (nodes - Ijk::Ones()).cast<double>();

  BodyGrid out;
  tool::Part part;
  part.role = tool::Role::rubs;
  part.shape.kind = tool::ShapeKind::grid;
  part.shape.a = stride * grid.voxel;
  part.shape.grid = tool::keep_grid(cells);
  part.tool_from_part = {grid.frame.q * Vec3(grid.voxel * (middle - centre)), grid.frame.q};
  if (part.shape.grid == nullptr || !tool::add_part(out.tool, part))
    return error(Trouble::usage, "the piece is too thin to be held; move it by numbers");
  out.hash = base::mix(0, static_cast<std::uint64_t>(stride));
  for (const int n : cells.size) out.hash = base::mix(out.hash, static_cast<std::uint64_t>(n));
  for (const std::int16_t phi : cells.phi)
    out.hash = base::mix(out.hash, static_cast<std::uint64_t>(static_cast<std::uint16_t>(phi)));
  for (int axis = 0; axis < 3; ++axis) out.hash = base::mix(out.hash, part.tool_from_part.p[axis]);
  return out;
}

}  // namespace burr::edit
