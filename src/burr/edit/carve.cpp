#include "burr/edit/carve.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/rt/flags.h"
#include "burr/rt/simd.h"
#include "burr/volume/volume_of.h"

namespace burr::edit {
namespace {

using math::Vec3;
using volume::BrickField;
using volume::BrickIndex;
using volume::kBrickEdge;
using volume::kBrickVoxels;

// From this number of bricks in one tick on, they are cut in slices even when the servo has time
// enough. Each of so many bricks loses very little in a tick, but costs as much as if it lost four
// times as much.
constexpr double kManyBricks = 72;
constexpr int kPreferredSlices = 4;  // at most

using Layers = std::array<unsigned, 3>;
constexpr Layers kWholeBrick = {kAllLayers, kAllLayers, kAllLayers};

// The layers of the brick that are inside the grid: the grid may end within a brick, and no bone is
// added beyond its end.
Layers layers_inside(const math::Ijk& brick, const math::Ijk& size) BURR_RT {
  Layers layers = kWholeBrick;
  for (int axis = 0; axis < 3; ++axis)
    layers[static_cast<std::size_t>(axis)] >>=
        std::max(0, kBrickEdge * (brick[axis] + 1) - size[axis]);
  return layers;
}

// The share of the excess to remove or add. If the hand's side has no excess left, the image's side
// shall have none left either.
double share_of(double owed, double all, const Mirror& mirror) BURR_RT {
  if (all <= 0) return mirror.on() && owed > 0 ? 1 : 0;
  return owed / all;
}

// The volume of a voxel's field value, within a few per cent of what the kernels compute.  [units]
std::int64_t rough_units(int field) { return 6 * std::clamp(field - 16384, 0, 32768); }

// The part of the excess found that is in these layers along i, j, k.
Excess clipped(const Excess& found, const volume::Field* field, const Layers& layers, bool deposit,
               std::uint16_t* out) BURR_RT {
  Excess left;
  for (std::uint32_t pairs = found.pairs; pairs != 0; pairs &= pairs - 1) {
    const int pair = std::countr_zero(pairs), first = 2 * kBrickEdge * pair;
    for (int v = first; v < first + 2 * kBrickEdge; ++v) {
      for (int axis = 0; axis < 3; ++axis)
        if (!in_layers(v, axis, layers[static_cast<std::size_t>(axis)])) out[v] = 0;
      const int by = out[v];
      if (by == 0) continue;
      left.most = std::max(left.most, by);
      left.pairs |= 1U << pair;
      left.units += deposit ? rough_units(field[v] + by) - rough_units(field[v])
                            : rough_units(field[v]) - rough_units(field[v] - by);
    }
  }
  return left;
}

// The ball, as gather() meets a body.
class PlacedBall {
 public:
  // keep_out: a ball that a deposit must not fill; radius below 0: none
  PlacedBall(FindExcess kernel, const Vec3& centre, double radius, const float keep_out[4],
             bool deposit) BURR_RT : find_(kernel),
                                     centre_(centre),
                                     radius_(radius),
                                     keep_out_(keep_out),
                                     deposit_(deposit),
                                     low_(centre - Vec3::Constant(radius + volume::kRamp)),
                                     high_(centre + Vec3::Constant(radius + volume::kRamp)) {}

  [[nodiscard]] const Vec3& low() const BURR_RT { return low_; }
  [[nodiscard]] const Vec3& high() const BURR_RT { return high_; }
  [[nodiscard]] double nearest(const Vec3& first) const BURR_RT {
    Vec3 voxel;
    for (int axis = 0; axis < 3; ++axis)
      voxel[axis] = std::clamp(centre_[axis], first[axis], first[axis] + kBrickEdge - 1);
    return math::norm(voxel - centre_) - radius_;
  }
  [[nodiscard]] Excess find(const volume::Field* field, const Vec3& first,
                            std::uint16_t* out) const BURR_RT {
    const Vec3 offset = first - centre_;
    const float ball[4] = {static_cast<float>(offset.x()), static_cast<float>(offset.y()),
                           static_cast<float>(offset.z()), static_cast<float>(radius_)};
    float outside[4] = {0, 0, 0, -1};
    if (keep_out_[3] >= 0)
      for (int axis = 0; axis < 3; ++axis)
        outside[axis] = static_cast<float>(first[axis]) - keep_out_[axis];
    outside[3] = keep_out_[3];
    return find_(field, ball, outside, deposit_ ? 1 : 0, out);
  }

 private:
  FindExcess find_;
  Vec3 centre_;
  double radius_;
  const float* keep_out_;
  bool deposit_;
  Vec3 low_, high_;
};

}  // namespace

CarveKernel carve_kernel() noexcept {
  if constexpr (rt::kWideKernels) {
    if (rt::simd() == rt::Simd::avx512) return {avx512::find_excess, avx512::apply_excess};
    if (rt::simd() == rt::Simd::avx2) return {avx2::find_excess, avx2::apply_excess};
  }
  return {scalar::find_excess, scalar::apply_excess};
}

Carver::Carver(BoneWriter& writer, const CarveSettings& settings, std::size_t which)
    : writer_(writer),
      bone_(writer.bone()),
      account_(writer.account()),
      debt_(account_.debts[which]),
      settings_(settings),
      kernel_(carve_kernel()),
      shapes_(shape_kernel()),
      reached_(writer) {
  const double h = bone_.grid().voxel;
  advance_ = std::max(settings.advance_m / h, settings.advance_least);
  least_margin_ = margin_ = std::max(settings.margin_m / h, settings.margin_least);
}

// Collects the bricks that the body touches and the excess of each: the field above the limit that
// the body sets (or, to add material, what is missing below it).
template <class Body>
void Carver::gather(const Body& body, bool deposit, int slices, const Half& half,
                    std::uint32_t& flags) BURR_RT {
  reached_.begin_side();
  math::Ijk lo, hi;
  for (int axis = 0; axis < 3; ++axis) {
    const double most = bone_.bricks()[axis] - 1;
    lo[axis] =
        static_cast<int>(std::clamp(std::floor(body.low()[axis] / kBrickEdge), 0.0, most + 1));
    hi[axis] = static_cast<int>(std::clamp(std::floor(body.high()[axis] / kBrickEdge), -1.0, most));
  }
  for (int bk = lo.z(); bk <= hi.z(); ++bk)
    for (int bj = lo.y(); bj <= hi.y(); ++bj)
      for (int bi = lo.x(); bi <= hi.x(); ++bi) {
        const unsigned layers = layers_of({bi, bj, bk}, half, slices, slice_);
        if (layers == 0) continue;
        const BrickIndex brick = bone_.brick_at(bi, bj, bk);
        if (!deposit && writer_.highest(brick) == 0) continue;
        const Vec3 first(kBrickEdge * bi, kBrickEdge * bj, kBrickEdge * bk);
        const double nearest = body.nearest(first);
        if (nearest > volume::kRamp) continue;
        // nothing to cut: nowhere in the brick is the field above the limit that the body sets
        if (!deposit && writer_.highest(brick) <= volume::kIso + nearest * volume::kFieldPerVoxel)
          continue;
        std::uint16_t* out = reached_.next();
        if (out == nullptr) return;
        const volume::Field* field = bone_.brick_field(brick);
        if (field == nullptr) {
          if (!deposit || !writer_.make_room(brick, flags)) continue;
          field = bone_.brick_field(brick);
        }
        Excess excess = body.find(field, first, out);
        Layers keep = deposit ? layers_inside({bi, bj, bk}, bone_.grid().size) : kWholeBrick;
        if (half.mirror.on()) keep[static_cast<std::size_t>(half.mirror.axis)] &= layers;
        if (keep != kWholeBrick && excess.most > 0)
          excess = clipped(excess, field, keep, deposit, out);
        if (excess.most > 0) reached_.add(brick, excess, half);
      }
}

// As many as requested, or as many as are needed so that the bricks fit into the list, which limits
// the time of a tick.
int Carver::choose_slices(int wanted, std::uint32_t& flags) BURR_RT {
  if (reached_.crowded()) {
    crowd_slices_ = std::min(2 * crowd_slices_, kMostSlices);
  } else if (crowd_slices_ > 1 &&
             std::max(reached_.hand_count(), reached_.count() - reached_.hand_count()) <
                 Reached::kMostBricksPerSide / 4) {
    crowd_slices_ /= 2;
  }
  double bricks = 0;
  for (int t = 0; t < slices_; ++t) bricks += parts_[t].bricks;
  if (bricks > kManyBricks * preferred_slices_ && preferred_slices_ < kPreferredSlices)
    preferred_slices_ *= 2;
  if (bricks < 0.4 * kManyBricks * preferred_slices_ && preferred_slices_ > 1)
    preferred_slices_ /= 2;
  const int late = std::max(wanted, crowd_slices_);
  if (late > 1) flags |= rt::kFlagPutOff;
  const int slices = std::min(late * preferred_slices_, kMostSlices);
  if (slices != slices_) {
    slices_ = slices;
    slice_ = 0;
    // the excess of the other slices is not known yet; the first slice counts as the mean of all
    std::fill_n(parts_, slices, Part{});
  }
  return slices;
}

// The excess of all slices together, from what each slice found at its last turn.  [units]
double Carver::excess_of_all_slices() BURR_RT {
  parts_[slice_] = {reached_.hand_units(), static_cast<int>(reached_.count()), true};
  slice_ = (slice_ + 1) % slices_;
  double sum = 0;
  int known = 0;
  for (int t = 0; t < slices_; ++t) {
    sum += static_cast<double>(parts_[t].units);
    known += parts_[t].known ? 1 : 0;
  }
  return sum * slices_ / known;
}

// Debt that is older than `debt_timeout` at the present rate of removal is given up.
void Carver::write_off(double asked_units, double dt, int slices) BURR_RT {
  const double blend = std::min(1.0, dt / settings_.debt_timeout);
  rate_ += (asked_units / dt - rate_) * blend;
  const double debt_timeout =
      settings_.debt_timeout + (slices - 1) * dt;  // until every brick has had its slice
  const double most = debt_timeout * std::max(rate_, asked_units / dt);
  if (debt_ > most) {
    account_.not_cut += debt_ - most;
    debt_ = most;
  }
}

void Carver::carve(const Cut& cut, std::uint32_t& flags) BURR_RT {
  constexpr float kNone[4] = {0, 0, 0, -1};
  const int slices = choose_slices(cut.slices, flags);
  reached_.begin();
  if (cut.body != nullptr) {
    const ToolBody body = advanced(*cut.body, advance_);
    const Sides sides = sides_of(body.grid_from_tool.p, cut.mirror);
    for (int s = 0; s < sides.count; ++s)
      gather(PlacedBody(shapes_, body, sides.half[s], margin_), false, slices, sides.half[s],
             flags);
  } else {
    const Sides sides = sides_of(cut.centre + advance_ * cut.push, cut.mirror);
    for (int s = 0; s < sides.count; ++s)
      gather(PlacedBall(kernel_.find, sides.centre[s], cut.radius + margin_, kNone, false), false,
             slices, sides.half[s], flags);
  }
  reached_.end(cut.mirror);
  const double asked = cut.energy / reached_.mean_energy() / writer_.unit_m3();
  account_.asked += asked;
  debt_ += asked;
  account_.energy += cut.energy;
  // every brick loses the same share of its excess, whatever its slice: enough for what is asked
  // until the slice's next turn, and for the debt
  const double all = excess_of_all_slices(), owed = debt_ + (slices - 1) * asked;
  const bool blocked = all < owed;
  const Reached::Done removed = reached_.take(share_of(owed, all, cut.mirror), flags);
  account_.took(removed.hand, removed.image);
  debt_ -= static_cast<double>(removed.hand);
  margin_ =
      std::clamp(margin_ + (blocked ? settings_.margin_rise : -settings_.margin_fall) * cut.dt,
                 least_margin_, std::max(least_margin_, settings_.margin_most));
  const double before = account_.not_cut;
  write_off(asked, cut.dt, slices);
  if (account_.not_cut > before) flags |= rt::kFlagNotCut;
}

void Carver::deposit(const Cut& cut, std::uint32_t& flags) BURR_RT {
  const double radius = settings_.deposit_share * cut.radius;
  const int slices = choose_slices(cut.slices, flags);
  const Sides sides = sides_of(cut.centre + cut.radius * cut.push, cut.mirror);
  reached_.begin();
  for (int s = 0; s < sides.count; ++s) {
    const Vec3 burr = folded(cut.centre, sides.half[s]);
    const float keep_out[4] = {static_cast<float>(burr.x()), static_cast<float>(burr.y()),
                               static_cast<float>(burr.z()),
                               static_cast<float>(cut.radius + settings_.deposit_gap)};
    gather(PlacedBall(kernel_.find, sides.centre[s], radius, keep_out, true), true, slices,
           sides.half[s], flags);
  }
  reached_.end(cut.mirror);
  const double debt_timeout = settings_.debt_timeout + (slices - 1) * cut.dt;
  const double asked = cut.volume / writer_.unit_m3();
  added_debt_ = std::min(added_debt_ + asked, asked * debt_timeout / cut.dt);
  const double all = excess_of_all_slices(), owed = added_debt_ + (slices - 1) * asked;
  const Reached::Done added = reached_.put(share_of(owed, all, cut.mirror), cut.material, flags);
  account_.put(added.hand, added.image);
  added_debt_ -= static_cast<double>(added.hand);
}

void Carver::idle(double dt) BURR_RT {
  reached_.begin();
  rate_ += (0 - rate_) * std::min(1.0, dt / settings_.debt_timeout);
  const double most = settings_.debt_timeout * rate_;
  if (debt_ > most) {
    account_.not_cut += debt_ - most;
    debt_ = most;
  }
}

}  // namespace burr::edit
