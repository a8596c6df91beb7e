#include "burr/metrics/opened.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/metrics/distance_map.h"
#include "burr/metrics/identified.h"
#include "burr/metrics/look_directions.h"
#include "burr/metrics/solidity.h"

namespace burr::metrics {
namespace {

using math::Ijk;
using math::Vec3;
using volume::Bone;

// A surface lies a little before the centre of the first voxel behind it: on average over places and
// directions of smooth surfaces, this share of a voxel.
constexpr double kBeforeCentre = 0.3;

// A squared distance to the nearest full voxel, cut off at a largest one [voxel^2].
using Square = std::uint16_t;

// The least square at which a ball of r fits [voxel].
int least_square(double r) {
  const double d = r + kBeforeCentre;
  return std::max(1, static_cast<int>(std::ceil(d * d)));
}

VoxelBox box_of(const volume::Grid& grid, const std::optional<math::Aabb>& world) {
  if (!world) return {Ijk::Zero(), grid.size};
  math::Aabb in_grid;
  for (int n = 0; n < 8; ++n) in_grid.extend(grid.grid_from_world(world->corner(n)));
  Ijk lo, hi;
  for (int a = 0; a < 3; ++a) {
    lo[a] = static_cast<int>(std::clamp(std::floor(in_grid.lo[a]), 0.0, grid.size[a] - 1.0));
    hi[a] = static_cast<int>(std::clamp(std::ceil(in_grid.hi[a]), 0.0, grid.size[a] - 1.0));
  }
  return {lo, hi - lo + Ijk::Ones()};
}

// Grown by a number of voxels, but not out of the grid.
VoxelBox grown(const VoxelBox& box, int by, const Ijk& size) {
  const Ijk lo = (box.first.array() - by).max(0);
  const Ijk hi = ((box.first + box.size).array() + by).min(size.array());
  return {lo, hi - lo};
}

// What lies in both; empty where nothing does.
VoxelBox common(const VoxelBox& a, const VoxelBox& b) {
  const Ijk lo = a.first.cwiseMax(b.first);
  const Ijk hi = (a.first + a.size).cwiseMin(b.first + b.size);
  return {lo, (hi - lo).cwiseMax(0)};
}

// Calls use(ijk) for the first voxel of each row of a box.
template <class Use>
void for_each_row(const VoxelBox& box, const Use& use) {
  for (int k = 0; k < box.size.z(); ++k)
    for (int j = 0; j < box.size.y(); ++j) use(box.first + Ijk(0, j, k));
}

// A brick's voxels (8 x 8 x 8) that hold bone or opaque soft tissue.
using BrickBits = std::array<std::uint8_t, volume::kBrickVoxels>;

class Floods {
 public:
  Floods(const Bone& before, const Bone& after, const Target& target,
         const OpenedSettings& settings)
      : before_(before),
        after_(after),
        target_(target),
        settings_(settings),
        box_(box_of(before.grid(), settings.box)),
        grid_(before.grid()),
        solidity_(before, after, nullptr, settings.glass),
        looks_(cones_about(settings.towards)) {
    for (Vec3& w : looks_) w = grid_.frame.q.conjugate() * w;
    for (std::size_t id = 0; id < before.tissues().tissues.size() && id < hides_.size(); ++id)
      hides_[id] = before.tissues().tissues[id].kind == volume::TissueKind::soft;
    for (const volume::TissueId id : settings.glass) hides_[id] = false;
    find_target();
    find_changed();
  }

  [[nodiscard]] bool has_target() const { return has_target_; }

  // Prepares for radii up to `most`. False: no removed voxel is seen, so no ball passes.
  [[nodiscard]] bool prepare(double most) {
    if (changed_.count() == 0) return false;
    cap_ = std::min(least_square(most / grid_.voxel), int{std::numeric_limits<Square>::max()});
    reach_ = static_cast<int>(std::ceil(most / grid_.voxel + kBeforeCentre)) + 1;
    padded_ = {box_.first - Ijk::Ones(), box_.size + 2 * Ijk::Ones()};
    find_offsets();
    // what was cut changes no distance farther away than the largest that counts
    const VoxelBox near = common(grown(changed_, reach_, grid_.size), box_);
    clear_before_.assign(padded_.count(), 0);
    measure(before_, box_, clear_before_);
    clear_after_ = clear_before_;
    measure(after_, near, clear_after_);
    find_removed(near);
    if (std::none_of(removed_.begin(), removed_.end(), [this](Removed& one) { return seen(one); }))
      return false;
    find_old();
    measure_target();
    pass_of_.assign(padded_.count(), 0);
    pass_ = 0;
    return true;
  }

  // The place at which a ball of rho touches the target. rho: at most that of prepare().
  [[nodiscard]] std::optional<Vec3> passes(double rho) {
    const double r = rho / grid_.voxel;
    const int least = least_square(r);
    BURR_CHECK(pass_ < 255);
    ++pass_;
    std::vector<std::size_t> todo;
    for (Removed& one : removed_) {
      if (!enters(one.at, least) || !seen(one)) continue;
      pass_of_[one.at] = pass_;
      todo.push_back(one.at);
      while (!todo.empty()) {
        const std::size_t n = todo.back();
        todo.pop_back();
        const Ijk v = padded_.first + padded_.at(n);
        if (to_target(v) <= r) return grid_.world_from_grid(v.cast<double>());
        for (const std::ptrdiff_t offset : offsets_) {
          const std::size_t m = moved(n, offset);
          if (!enters(m, least)) continue;
          pass_of_[m] = pass_;
          todo.push_back(m);
        }
      }
    }
    return std::nullopt;
  }

 private:
  // A voxel that was cut away, and whether a look reaches it.
  struct Removed {
    enum class Sight : std::uint8_t { not_known, seen, hidden };
    std::size_t at = 0;  // in the padded box
    Sight sight = Sight::not_known;
  };

  static std::size_t moved(std::size_t n, std::ptrdiff_t by) {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(n) + by);
  }
  [[nodiscard]] std::size_t place_of(const Ijk& v) const {
    return padded_.index(v - padded_.first);
  }

  // The centre of a ball may go there: not yet in this pass, wide enough, and not an old way.
  [[nodiscard]] bool enters(std::size_t n, int least) const {
    return pass_of_[n] != pass_ && clear_after_[n] >= least && old_[n] < least;
  }

  void find_offsets() {
    const std::ptrdiff_t row = padded_.size.x(), slice = row * padded_.size.y();
    std::size_t count = 0;
    for (int n = 0; n < 27; ++n)
      if (n != 13) offsets_[count++] = (n % 3 - 1) + (n / 3 % 3 - 1) * row + (n / 9 - 1) * slice;
  }

  // Which voxels of a brick are full; false: none.
  bool full_of(const Bone& bone, volume::BrickIndex brick, BrickBits& full) const {
    const volume::Field* field = bone.brick_field(brick);
    const volume::TissueId* tissue = bone.brick_tissue(brick);
    if (field == nullptr && tissue == nullptr) return false;
    for (std::size_t v = 0; v < full.size(); ++v)
      full[v] = (field != nullptr && field[v] >= volume::kIso) ||
                (tissue != nullptr && hides_[tissue[v]]);
    return true;
  }

  // Squares of the voxels of `inner`, to what is full there and around it.
  void measure(const Bone& bone, const VoxelBox& inner, std::vector<Square>& to) const {
    const VoxelBox around = grown(inner, reach_, grid_.size);
    std::vector<std::uint8_t> full(around.count(), 0);
    BrickBits bits = {};
    for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
      const Ijk first = bone.brick_ijk(brick);
      const VoxelBox part = common({first, Ijk::Constant(volume::kBrickEdge)}, around);
      if (part.count() == 0 || !full_of(bone, brick, bits)) continue;
      for_each_row(part, [&](const Ijk& v) {
        const Ijk in = v - first;
        std::copy_n(&bits[static_cast<std::size_t>(in.x() + 8 * (in.y() + 8 * in.z()))],
                    part.size.x(), &full[around.index(v - around.first)]);
      });
    }
    if (target_.label != nullptr)
      target_.label->for_each([&](const Ijk& v) {
        if (around.has(v - around.first)) full[around.index(v - around.first)] = 0;
      });
    const std::vector<std::int32_t> all = squared_distances(around, full, settings_.threads);
    for_each_row(inner, [&](const Ijk& v) {
      const std::size_t from = around.index(v - around.first), into = place_of(v);
      for (std::size_t i = 0; i < static_cast<std::size_t>(inner.size.x()); ++i)
        to[into + i] = static_cast<Square>(std::min(all[from + i], cap_));
    });
  }

  // The box around the bricks whose content differs.
  void find_changed() {
    Ijk lo = grid_.size, hi = Ijk::Zero();
    BrickBits was = {}, is = {};
    for (volume::BrickIndex brick = 0; brick < before_.brick_count(); ++brick) {
      was.fill(0);
      is.fill(0);
      full_of(before_, brick, was);
      full_of(after_, brick, is);
      if (was == is) continue;
      const Ijk first = before_.brick_ijk(brick);
      lo = lo.cwiseMin(first);
      hi = hi.cwiseMax(first + Ijk::Constant(volume::kBrickEdge));
    }
    if ((hi.array() > lo.array()).all()) changed_ = {lo, hi.cwiseMin(grid_.size) - lo};
  }

  void find_removed(const VoxelBox& near) {
    removed_.clear();
    const int least = least_square(1);
    for_each_row(near, [&](const Ijk& v) {
      const std::size_t row = place_of(v);
      for (std::size_t n = row; n < row + static_cast<std::size_t>(near.size.x()); ++n)
        if (clear_before_[n] == 0 && clear_after_[n] >= least) removed_.push_back({n});
    });
  }

  [[nodiscard]] bool seen(Removed& one) const {
    if (one.sight == Removed::Sight::not_known) {
      const Vec3 from = (padded_.first + padded_.at(one.at)).cast<double>();
      const bool any = std::any_of(looks_.begin(), looks_.end(), [&](const Vec3& w) {
        return !is_blocked(solidity_, from, w, std::numeric_limits<double>::infinity());
      });
      one.sight = any ? Removed::Sight::seen : Removed::Sight::hidden;
    }
    return one.sight == Removed::Sight::seen;
  }

  // For each voxel the largest square with which a ball's centre came there from outside before the
  // cut; 0: none. The widest way to a voxel is as wide as its narrowest place, so voxels are taken
  // from the widest ways down.
  void find_old() {
    old_.assign(padded_.count(), 0);
    std::vector<std::vector<std::size_t>> todo(static_cast<std::size_t>(cap_) + 1);
    const auto reach = [&](std::size_t n, Square way) {
      if (old_[n] != 0 || clear_before_[n] == 0) return;
      old_[n] = std::min(way, clear_before_[n]);
      todo[old_[n]].push_back(n);
    };
    const Ijk last = box_.size - Ijk::Ones();
    for_each_row(box_, [&](const Ijk& v) {
      const Ijk in = v - box_.first;
      const bool side = in.y() == 0 || in.y() == last.y() || in.z() == 0 || in.z() == last.z();
      const std::size_t row = place_of(v);
      const auto end = static_cast<std::size_t>(last.x());
      for (std::size_t i = 0; i <= end; i += side || end == 0 ? 1 : end)
        reach(row + i, std::numeric_limits<Square>::max());
    });
    for (auto way = static_cast<std::size_t>(cap_); way > 0; --way)
      while (!todo[way].empty()) {
        const std::size_t n = todo[way].back();
        todo[way].pop_back();
        for (const std::ptrdiff_t offset : offsets_)
          reach(moved(n, offset), static_cast<Square>(way));
      }
  }

  // The box around the target, and whether any of it lies in the box.
  void find_target() {
    if (target_.label == nullptr) {
      const Vec3 at = grid_.grid_from_world(target_.centre) - box_.first.cast<double>();
      has_target_ = true;
      for (int a = 0; a < 3; ++a) has_target_ &= at[a] >= -0.5 && at[a] <= box_.size[a] - 0.5;
      return;
    }
    Ijk lo = grid_.size, hi = Ijk::Zero();
    target_.label->for_each([&](const Ijk& v) {
      if (!box_.has(v - box_.first)) return;
      has_target_ = true;
      lo = lo.cwiseMin(v);
      hi = hi.cwiseMax(v + Ijk::Ones());
    });
    if (has_target_) target_box_ = {lo, hi - lo};
  }

  void measure_target() {
    if (target_.label == nullptr) return;
    near_target_ = grown(target_box_, reach_, grid_.size);
    std::vector<std::uint8_t> set(near_target_.count(), 0);
    target_.label->for_each([&](const Ijk& v) {
      if (box_.has(v - box_.first)) set[near_target_.index(v - near_target_.first)] = 1;
    });
    target_square_ = squared_distances(near_target_, set, settings_.threads);
  }

  // [voxel]; infinite: farther than any ball reaches
  [[nodiscard]] double to_target(const Ijk& v) const {
    if (target_.label == nullptr)
      return (math::norm(grid_.world_from_grid(v.cast<double>()) - target_.centre) -
              target_.radius) /
             grid_.voxel;
    const Ijk in = v - near_target_.first;
    if (!near_target_.has(in)) return std::numeric_limits<double>::infinity();
    return std::sqrt(static_cast<double>(target_square_[near_target_.index(in)])) - kBeforeCentre;
  }

  const Bone &before_, &after_;
  const Target& target_;
  const OpenedSettings& settings_;
  VoxelBox box_, padded_;  // padded: by a voxel all round, where no ball's centre may go
  volume::Grid grid_;
  std::array<bool, 256> hides_ = {};
  Solidity solidity_;
  std::vector<Vec3> looks_;  // grid axes
  VoxelBox changed_, target_box_, near_target_;
  bool has_target_ = false;
  int cap_ = 0, reach_ = 0;                               // [voxel^2], [voxel]
  std::array<std::ptrdiff_t, 26> offsets_ = {};           // to the neighbours in the padded box
  std::vector<Square> clear_before_, clear_after_, old_;  // of the padded box
  std::vector<std::int32_t> target_square_;               // of near_target_ [voxel^2]
  std::vector<Removed> removed_;
  std::vector<std::uint8_t> pass_of_;  // of the padded box: the last pass that came there
  std::uint8_t pass_ = 0;
};

}  // namespace

Assessed<Opened> opened(const Bone& before, const Bone& after, const Target& target,
                        const OpenedSettings& settings) {
  BURR_CHECK(same_grid(before, after) && !settings.towards.empty());
  const double h = before.grid().voxel;
  if (std::string reason = too_coarse(h, settings.rho / 2); !reason.empty())
    return NotAssessable{std::move(reason)};
  Floods floods(before, after, target, settings);
  if (!floods.has_target()) return NotAssessable{"the place to reach is not in this bone"};
  Opened out;
  out.mark = {false, true, 0, settings.rho, 0.75 * h};
  if (!floods.prepare(settings.rho)) return out;
  if (const auto touch = floods.passes(settings.rho)) {
    out.mark.met = true;
    out.touch = *touch;
    // larger radii need larger distances
    if (settings.most > settings.rho && !floods.prepare(settings.most)) return out;
  }
  double low = out.mark.met ? settings.rho : 0;
  double high = out.mark.met ? std::max(settings.most, settings.rho) : settings.rho;
  while (high - low > h / 8) {
    const double middle = 0.5 * (low + high);
    if (const auto touch = floods.passes(middle)) {
      out.touch = *touch;
      low = middle;
    } else {
      high = middle;
    }
  }
  out.mark.value = low;
  return out;
}

}  // namespace burr::metrics
