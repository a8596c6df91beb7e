#include "burr/phantom/build.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <utility>
#include <vector>

#include "burr/base/check.h"

namespace burr::phantom {
namespace {

using volume::Bone;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickEdge;
using volume::kBrickVoxels;
using volume::TissueId;

// What the formula's bound says about a brick before its voxels are computed.
enum class Kind : std::uint8_t { empty, solid, mixed };

struct Sampled {
  BrickIndex brick = 0;
  Field field[kBrickVoxels];
  TissueId tissue[kBrickVoxels];
};

// One pass over the bricks: finds the empty and the solid ones by the formula's Lipschitz bound,
// and computes the others. Coarse blocks first, so that empty space costs almost nothing.
class Sampler {
 public:
  Sampler(const volume::Grid& grid, const Formula& formula)
      : grid_(grid),
        formula_(formula),
        bricks_((grid.size.array() + kBrickEdge - 1) / kBrickEdge),
        kinds_(static_cast<std::size_t>(bricks_.x()) * static_cast<std::size_t>(bricks_.y()) *
                   static_cast<std::size_t>(bricks_.z()),
               Kind::empty) {}

  // Handles all bricks of one block of kBlock bricks per side; mixed bricks go to `out`.
  static constexpr int kBlock = 8;
  void sample_block(const math::Ijk& first, int edge, std::vector<Sampled>& out) {
    if ((first.array() >= bricks_.array()).any()) return;
    const Kind kind = kind_of(first, edge);
    if (kind == Kind::empty) return;
    if (kind == Kind::solid) return mark_solid(first, edge);
    if (edge == 1) return sample_brick(first, out);
    const int half = edge / 2;
    for (int c = 0; c < 8; ++c)
      sample_block(first + half * math::Ijk(c & 1, (c >> 1) & 1, c >> 2), half, out);
  }

  // A brick that is solid throughout, by the bound.
  void fill_solid(BrickIndex brick, Field* field, TissueId* tissue) const {
    std::fill_n(field, kBrickVoxels, Field{0});  // outside the grid is air
    std::fill_n(tissue, kBrickVoxels, TissueId{0});
    each_voxel(brick_ijk(brick) * kBrickEdge, [&](std::size_t v, const Vec3& p_grid) {
      field[v] = volume::kSolid;
      tissue[v] = 1;
      if (!formula_.tissue) return;
      const Vec3 p = grid_.world_from_grid(p_grid);
      tissue[v] = formula_.tissue(p, formula_.depth(p));
    });
  }

  [[nodiscard]] const std::vector<Kind>& kinds() const { return kinds_; }
  [[nodiscard]] math::Ijk blocks() const { return (bricks_.array() + kBlock - 1) / kBlock; }

 private:
  [[nodiscard]] std::size_t index(const math::Ijk& b) const {
    return static_cast<std::size_t>(b.x() + bricks_.x() * (b.y() + bricks_.y() * b.z()));
  }
  [[nodiscard]] math::Ijk brick_ijk(BrickIndex b) const {
    return {b % bricks_.x(), b / bricks_.x() % bricks_.y(), b / bricks_.x() / bricks_.y()};
  }

  [[nodiscard]] Kind kind_of(const math::Ijk& first, int edge) const {
    const double half = 0.5 * (kBrickEdge * edge - 1);  // from the middle to the outermost centres
    const Vec3 centre =
        grid_.world_from_grid((first * kBrickEdge).cast<double>() + Vec3::Constant(half));
    const double reach = formula_.lipschitz * std::sqrt(3.0) * half * grid_.voxel;
    const double ramp = (volume::kRamp + 1e-6) * grid_.voxel;
    const double depth = formula_.depth(centre);
    if (depth - reach > ramp) return Kind::solid;
    if (depth + reach < -ramp && (!formula_.soft || formula_.soft(centre) + reach < 0))
      return Kind::empty;
    return Kind::mixed;
  }

  void mark_solid(const math::Ijk& first, int edge) {
    const math::Ijk end = (first.array() + edge).min(bricks_.array());
    for (int k = first.z(); k < end.z(); ++k)
      for (int j = first.y(); j < end.y(); ++j)
        for (int i = first.x(); i < end.x(); ++i) kinds_[index({i, j, k})] = Kind::solid;
  }

  void sample_brick(const math::Ijk& brick, std::vector<Sampled>& out) {
    Sampled& to = out.emplace_back();
    to.brick = static_cast<BrickIndex>(index(brick));
    std::fill_n(to.field, kBrickVoxels, Field{0});
    std::fill_n(to.tissue, kBrickVoxels, TissueId{0});
    bool any = false;
    each_voxel(brick * kBrickEdge, [&](std::size_t v, const Vec3& p_grid) {
      const Vec3 p = grid_.world_from_grid(p_grid);
      const double depth = formula_.depth(p);
      to.field[v] = volume::field_from_depth(depth / grid_.voxel);
      to.tissue[v] = formula_.tissue ? formula_.tissue(p, depth)
                                     : static_cast<TissueId>(to.field[v] != 0 ? 1 : 0);
      any = any || to.field[v] != 0 || to.tissue[v] != 0;
    });
    if (any)
      kinds_[index(brick)] = Kind::mixed;
    else
      out.pop_back();
  }

  // Calls what() for the voxels of a brick that lie in the grid.
  template <class Do>
  void each_voxel(const math::Ijk& at, Do&& what) const {
    const math::Ijk n = (grid_.size - at).cwiseMin(kBrickEdge);
    for (int k = 0; k < n.z(); ++k)
      for (int j = 0; j < n.y(); ++j)
        for (int i = 0; i < n.x(); ++i)
          what(static_cast<std::size_t>(i + kBrickEdge * (j + kBrickEdge * k)),
               (at + math::Ijk(i, j, k)).cast<double>());
  }

  const volume::Grid& grid_;
  const Formula& formula_;
  math::Ijk bricks_;
  std::vector<Kind> kinds_;  // (bricks); each entry is written by one worker only
};

// Runs work(0) .. work(count - 1) on `threads` threads, in any order; the first thread reports
// progress.
template <class Work>
void share(int count, int threads, Progress& progress, std::string_view stage, Work&& work) {
  std::atomic<int> next = 0;
  const auto worker = [&](bool speaks) {
    for (int n = next++; n < count && !progress.cancelled(); n = next++) {
      if (speaks) progress.report(static_cast<double>(n) / count, stage);
      work(n);
    }
  };
  std::vector<std::thread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(worker, false);
  worker(true);
  for (std::thread& other : others) other.join();
}

}  // namespace

volume::Grid cube_grid(double edge, int n, const Vec3& centre) {
  BURR_CHECK(edge > 0 && n > 0);
  volume::Grid grid;
  grid.size = {n, n, n};
  grid.voxel = edge / n;
  grid.frame.p = centre - Vec3::Constant(0.5 * (n - 1) * grid.voxel);
  return grid;
}

volume::Grid box_grid(const Vec3& lo, const Vec3& hi, double voxel) {
  BURR_CHECK(voxel > 0 && (hi.array() > lo.array()).all());
  volume::Grid grid;
  grid.size = ((hi - lo) / voxel - Vec3::Constant(1e-9)).array().ceil().cast<int>();
  grid.voxel = voxel;
  const Vec3 covered = (grid.size - math::Ijk::Ones()).cast<double>() * voxel;
  grid.frame.p = 0.5 * (lo + hi - covered);
  return grid;
}

volume::Grid peers_grid(int n) { return cube_grid(kPeersCube, n); }

Result<std::unique_ptr<Bone>> bone_from_formula(const volume::Grid& grid,
                                                volume::TissueTable tissues, const Formula& formula,
                                                std::size_t reserve_bricks, int threads,
                                                Progress& progress) {
  BURR_CHECK(formula.depth != nullptr && formula.lipschitz > 0 && threads > 0);
  Sampler sampler(grid, formula);

  // compute everything once; each worker keeps the bricks it found
  const math::Ijk blocks = sampler.blocks();
  std::vector<std::vector<Sampled>> found(static_cast<std::size_t>(blocks.prod()));
  share(blocks.prod(), threads, progress, "shaping bone", [&](int n) {
    const math::Ijk block(n % blocks.x(), n / blocks.x() % blocks.y(), n / blocks.x() / blocks.y());
    sampler.sample_block(block * Sampler::kBlock, Sampler::kBlock,
                         found[static_cast<std::size_t>(n)]);
  });
  if (progress.cancelled()) return error(Trouble::interrupted, "stopped while shaping the bone");

  // now the memory needed is known
  const std::vector<Kind>& kinds = sampler.kinds();
  const auto count = static_cast<std::size_t>(
      std::count_if(kinds.begin(), kinds.end(), [](Kind kind) { return kind != Kind::empty; }));
  auto bone = std::make_unique<Bone>(grid, std::move(tissues), count, reserve_bricks, false);
  std::vector<BrickIndex> solid;
  for (BrickIndex b = 0; b < bone->brick_count(); ++b) {
    const Kind kind = kinds[static_cast<std::size_t>(b)];
    if (kind != Kind::empty) bone->ensure_slot(b);
    if (kind == Kind::solid) solid.push_back(b);
  }

  // every brick has its slot, so workers may fill them in parallel
  for (std::vector<Sampled>& block : found) {
    for (const Sampled& from : block) {
      bone->build_brick(from.brick, from.field, from.tissue);
    }
    block = {};
  }
  constexpr int kAtOnce = 256;
  const int parts = (static_cast<int>(solid.size()) + kAtOnce - 1) / kAtOnce;
  share(parts, threads, progress, "filling bone", [&](int n) {
    const std::size_t first = static_cast<std::size_t>(n) * kAtOnce;
    volume::BrickField field;
    TissueId tissue[kBrickVoxels];
    for (std::size_t s = first; s < std::min(first + kAtOnce, solid.size()); ++s) {
      sampler.fill_solid(solid[s], field.voxel, tissue);
      bone->build_brick(solid[s], field.voxel, tissue);
    }
  });
  if (progress.cancelled()) return error(Trouble::interrupted, "stopped while shaping the bone");
  bone->pack();
  progress.report(1, "filling bone");
  return bone;
}

std::unique_ptr<Bone> bone_from_distance(const volume::Grid& grid,
                                         const volume::TissueTable& tissues, const Depth& depth,
                                         std::size_t reserve_bricks, int threads,
                                         double lipschitz) {
  NoProgress nobody;
  Formula formula;
  formula.depth = depth;
  formula.lipschitz = lipschitz;
  return std::move(
      bone_from_formula(grid, tissues, formula, reserve_bricks, threads, nobody).value());
}

volume::TissueTable bone_that_costs(double cutting_energy) {
  volume::TissueTable table;
  volume::Tissue& bone = table.tissues[1];
  const double times = cutting_energy / bone.cutting_energy;
  bone.cutting_energy = cutting_energy;
  for (double* one : {&bone.force.chip_tangential, &bone.force.chip_radial,
                      &bone.force.edge_tangential, &bone.force.edge_radial})
    *one *= times;
  return table;
}

std::unique_ptr<Bone> peers_bone(int n, std::size_t reserve_bricks, int threads) {
  return bone_from_distance(peers_grid(n), {}, ball(kPeersBall), reserve_bricks, threads);
}

}  // namespace burr::phantom
