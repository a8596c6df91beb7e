#include "burr/metrics/opened.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/metrics/distance_map.h"
#include "burr/metrics/identified.h"
#include "burr/metrics/look.h"
#include "burr/metrics/solidity.h"

namespace burr::metrics {
namespace {

using math::Ijk;
using math::Vec3;
using volume::Bone;

// A surface lies a little before the centre of the first voxel behind it: on average over places and
// directions of smooth surfaces, this share of a voxel.
constexpr double kBeforeCentre = 0.3;

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

class Floods {
 public:
  Floods(const Bone& before, const Bone& after, const Target& target,
         const OpenedSettings& settings)
      : settings_(settings), box_(box_of(before.grid(), settings.box)), grid_(before.grid()) {
    for (const volume::TissueId id : settings.glass) glass_[id] = true;
    clear_before_ = clearance(before, target);
    clear_after_ = clearance(after, target);
    measure(target);
    find_seeds(before, after);
  }

  [[nodiscard]] bool has_target() const { return has_target_; }

  // The place at which a ball of rho touches the target.
  [[nodiscard]] std::optional<Vec3> passes(double rho) const {
    const double r = rho / grid_.voxel;
    const std::vector<std::uint8_t> old = old_of(r);
    std::vector<std::uint8_t> been = old;
    std::vector<std::size_t> todo;
    for (const std::size_t n : seeds_)
      if (clear_after_[n] >= r && been[n] == 0) {
        been[n] = 1;
        todo.push_back(n);
      }
    while (!todo.empty()) {
      const std::size_t n = todo.back();
      todo.pop_back();
      if (to_target(n) <= r) return world(n);
      spread(n, clear_after_, r, been, todo);
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] Vec3 world(std::size_t n) const {
    return grid_.world_from_grid((box_.first + box_.at(n)).cast<double>());
  }

  // [voxel], of every voxel of the box; below 0: in bone or in tissue
  [[nodiscard]] std::vector<float> clearance(const Bone& bone, const Target& target) const {
    std::vector<std::uint8_t> full(box_.count());
    for (std::size_t n = 0; n < full.size(); ++n) {
      const Ijk v = box_.first + box_.at(n);
      if (target.label != nullptr && target.label->has(v)) continue;
      const volume::TissueId tissue = bone.tissue(v.x(), v.y(), v.z());
      full[n] = bone.field(v.x(), v.y(), v.z()) >= volume::kIso ||
                (bone.tissues()[tissue].kind == volume::TissueKind::soft && !glass_[tissue]);
    }
    const std::vector<std::int32_t> square = squared_distances(box_, full, settings_.threads);
    std::vector<float> clear(full.size());
    for (std::size_t n = 0; n < full.size(); ++n)
      clear[n] = static_cast<float>(std::sqrt(static_cast<double>(square[n])) - kBeforeCentre);
    return clear;
  }

  void measure(const Target& target) {
    if (target.label == nullptr) {
      centre_ = target.centre;
      radius_ = target.radius;
      const Vec3 at = grid_.grid_from_world(centre_) - box_.first.cast<double>();
      has_target_ = true;
      for (int a = 0; a < 3; ++a) has_target_ &= at[a] >= -0.5 && at[a] <= box_.size[a] - 0.5;
      return;
    }
    std::vector<std::uint8_t> set(box_.count());
    for (std::size_t n = 0; n < set.size(); ++n) {
      set[n] = target.label->has(box_.first + box_.at(n));
      has_target_ = has_target_ || set[n] != 0;
    }
    target_square_ = squared_distances(box_, set, settings_.threads);
  }

  // [voxel]
  [[nodiscard]] double to_target(std::size_t n) const {
    if (target_square_.empty()) return (math::norm(world(n) - centre_) - radius_) / grid_.voxel;
    return std::sqrt(static_cast<double>(target_square_[n])) - kBeforeCentre;
  }

  // Removed voxels that a look reaches.
  void find_seeds(const Bone& before, const Bone& after) {
    const Solidity solidity(before, after, nullptr, settings_.glass);
    std::vector<Vec3> looks = cones_about(settings_.towards);
    for (Vec3& w : looks) w = grid_.frame.q.conjugate() * w;
    for (std::size_t n = 0; n < clear_after_.size(); ++n) {
      if (!(clear_before_[n] < 0 && clear_after_[n] >= 1)) continue;
      const Vec3 from = (box_.first + box_.at(n)).cast<double>();
      for (const Vec3& w : looks)
        if (!is_blocked(solidity, from, w, std::numeric_limits<double>::infinity())) {
          seeds_.push_back(n);
          break;
        }
    }
  }

  // Where the centre of a ball came from outside before the cut.
  [[nodiscard]] std::vector<std::uint8_t> old_of(double r) const {
    std::vector<std::uint8_t> been(box_.count(), 0);
    std::vector<std::size_t> todo;
    for (std::size_t n = 0; n < been.size(); ++n) {
      const Ijk v = box_.at(n);
      const bool border = (v.array() == 0).any() || (v.array() == box_.size.array() - 1).any();
      if (!border || clear_before_[n] < r) continue;
      been[n] = 1;
      todo.push_back(n);
    }
    while (!todo.empty()) {
      const std::size_t n = todo.back();
      todo.pop_back();
      spread(n, clear_before_, r, been, todo);
    }
    return been;
  }

  void spread(std::size_t n, const std::vector<float>& clear, double r,
              std::vector<std::uint8_t>& been, std::vector<std::size_t>& todo) const {
    const Ijk at = box_.at(n);
    for (int dk = -1; dk <= 1; ++dk)
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) {
          const Ijk near = at + Ijk(di, dj, dk);
          if (!box_.has(near)) continue;
          const std::size_t m = box_.index(near);
          if (been[m] != 0 || clear[m] < r) continue;
          been[m] = 1;
          todo.push_back(m);
        }
  }

  const OpenedSettings& settings_;
  VoxelBox box_;
  volume::Grid grid_;
  std::array<bool, 256> glass_ = {};
  std::vector<float> clear_before_, clear_after_;  // [voxel]
  std::vector<std::int32_t> target_square_;        // [voxel^2], or empty: a landmark
  Vec3 centre_ = Vec3::Zero();
  double radius_ = 0;
  bool has_target_ = false;
  std::vector<std::size_t> seeds_;
};

}  // namespace

Assessed<Opened> opened(const Bone& before, const Bone& after, const Target& target,
                        const OpenedSettings& settings) {
  BURR_CHECK(same_grid(before, after) && !settings.towards.empty());
  const double h = before.grid().voxel;
  if (std::string reason = too_coarse(h, settings.rho / 2); !reason.empty())
    return NotAssessable{std::move(reason)};
  const Floods floods(before, after, target, settings);
  if (!floods.has_target()) return NotAssessable{"the place to reach is not in this bone"};
  Opened out;
  const auto asked = floods.passes(settings.rho);
  double low = asked ? settings.rho : 0, high = asked ? settings.most : settings.rho;
  if (asked) out.touch = *asked;
  while (high - low > h / 8) {
    const double middle = 0.5 * (low + high);
    if (const auto touch = floods.passes(middle)) {
      out.touch = *touch;
      low = middle;
    } else {
      high = middle;
    }
  }
  out.mark = {asked.has_value(), true, low, settings.rho, 0.75 * h};
  return out;
}

}  // namespace burr::metrics
