#include "burr/edit/carve.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "burr/base/check.h"
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

constexpr std::size_t kMostWork = 1024;  // bricks a side in one tick: 7 mm at 0.1 mm takes 400
// Bricks in one tick from which on they are cut in slices though nobody is in a hurry: each of so
// many loses a hair a tick, and costs as much as if it lost four.
constexpr double kManyBricks = 72;
constexpr int kUsualTurns = 4;  // at most
constexpr std::uint8_t kMixed = 255;

using Layers = std::array<unsigned, 3>;
constexpr Layers kWholeBrick = {kAllLayers, kAllLayers, kAllLayers};

// The grid may end within a brick; nothing grows beyond.
Layers layers_inside(const math::Ijk& brick, const math::Ijk& size) BURR_RT {
  Layers layers = kWholeBrick;
  for (int axis = 0; axis < 3; ++axis)
    layers[static_cast<std::size_t>(axis)] >>=
        std::max(0, kBrickEdge * (brick[axis] + 1) - size[axis]);
  return layers;
}

// Of the excess. Where the hand's side has none left, its image shall have none either.
double share_of(double owed, double all, const Mirror& mirror) BURR_RT {
  if (all <= 0) return mirror.on() && owed > 0 ? 1 : 0;
  return owed / all;
}

// As the kernels do, to a few per cent.
std::int64_t rough_units(int field) { return 6 * std::clamp(field - 16384, 0, 32768); }

// Of the excess that was found what is in these layers, along i, j, k.
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

}  // namespace

CarveKernel carve_kernel() noexcept {
  switch (rt::simd()) {
    case rt::Simd::avx512:
      return {avx512::find_excess, avx512::apply_excess};
    case rt::Simd::avx2:
      return {avx2::find_excess, avx2::apply_excess};
    case rt::Simd::scalar:
      break;
  }
  return {scalar::find_excess, scalar::apply_excess};
}

Carver::Carver(volume::Bone& bone, volume::IsoVertices& surface, UndoStore& undo,
               ChangedQueue* changed, const CarveSettings& settings)
    : bone_(bone),
      surface_(surface),
      undo_(undo),
      changed_(changed),
      settings_(settings),
      kernel_(carve_kernel()),
      highest_(static_cast<std::size_t>(bone.brick_count())),
      uniform_(static_cast<std::size_t>(bone.brick_count()), std::uint8_t{0}),
      energy_of_(256, 1e9),
      scratch_(2 * kMostWork),
      work_(2 * kMostWork) {
  const double h = bone.grid().voxel;
  advance_ = std::max(settings.advance_m / h, settings.advance_least);
  least_margin_ = margin_ = std::max(settings.margin_m / h, settings.margin_least);
  unit_m3_ = h * h * h / static_cast<double>(volume::kVoxelUnits);
  for (std::size_t t = 0; t < bone.tissues().tissues.size(); ++t)
    energy_of_[t] = bone.tissues().tissues[t].cutting_energy;
  for (BrickIndex b = 0; b < bone.brick_count(); ++b) {
    const volume::Field* field = bone.brick_field(b);
    if (field == nullptr) continue;
    highest_[static_cast<std::size_t>(b)] = *std::max_element(field, field + kBrickVoxels);
    const volume::TissueId* tissue = bone.brick_tissue(b);
    int one = -1;
    for (int v = 0; v < kBrickVoxels; ++v)
      if (field[v] != 0) one = one < 0 || one == tissue[v] ? tissue[v] : kMixed;
    uniform_[static_cast<std::size_t>(b)] = static_cast<std::uint8_t>(std::max(one, 0));
  }
}

// Finds in every brick that the ball meets what stands above it (or lacks below it).
void Carver::gather(const Vec3& centre, double radius, const float keep_out[4], bool deposit,
                    int slices, const Half& half, std::uint32_t& flags) BURR_RT {
  const std::size_t most_work = work_count_ + kMostWork;
  const double reach = radius + volume::kRamp;
  math::Ijk lo, hi;
  for (int axis = 0; axis < 3; ++axis) {
    const double most = bone_.bricks()[axis] - 1;
    lo[axis] = static_cast<int>(
        std::clamp(std::floor((centre[axis] - reach) / kBrickEdge), 0.0, most + 1));
    hi[axis] =
        static_cast<int>(std::clamp(std::floor((centre[axis] + reach) / kBrickEdge), -1.0, most));
  }
  for (int bk = lo.z(); bk <= hi.z(); ++bk)
    for (int bj = lo.y(); bj <= hi.y(); ++bj)
      for (int bi = lo.x(); bi <= hi.x(); ++bi) {
        const unsigned layers = layers_of({bi, bj, bk}, half, slices, slice_);
        if (layers == 0) continue;
        const BrickIndex brick = bone_.brick_at(bi, bj, bk);
        if (!deposit && highest_[static_cast<std::size_t>(brick)] == 0) continue;
        const Vec3 first(kBrickEdge * bi, kBrickEdge * bj, kBrickEdge * bk);
        // nearest voxel of the brick to the centre
        Vec3 nearest;
        for (int axis = 0; axis < 3; ++axis)
          nearest[axis] = std::clamp(centre[axis], first[axis], first[axis] + kBrickEdge - 1);
        const double far = (nearest - centre).norm();
        if (far > reach) continue;
        // the ball's floor is nowhere in the brick lower than what is left of it
        if (!deposit && highest_[static_cast<std::size_t>(brick)] <=
                            volume::kIso + (far - radius) * volume::kFieldPerVoxel)
          continue;
        if (work_count_ == most_work) {
          crowded_ = true;
          return;
        }
        const volume::Field* field = bone_.brick_field(brick);
        if (field == nullptr) {
          if (!deposit) continue;
          if (bone_.ensure_slot(brick) == volume::kNoSlot) {
            flags |= rt::kFlagReserve;
            continue;
          }
          field = bone_.brick_field(brick);
        }
        const Vec3 offset = first - centre;
        const float ball[4] = {static_cast<float>(offset.x()), static_cast<float>(offset.y()),
                               static_cast<float>(offset.z()), static_cast<float>(radius)};
        float outside[4] = {0, 0, 0, -1};
        if (keep_out[3] >= 0)
          for (int axis = 0; axis < 3; ++axis)
            outside[axis] = static_cast<float>(first[axis]) - keep_out[axis];
        outside[3] = keep_out[3];
        std::uint16_t* out = scratch_[work_count_].voxel;
        Excess excess = kernel_.find(field, ball, outside, deposit ? 1 : 0, out);
        Layers keep = deposit ? layers_inside({bi, bj, bk}, bone_.grid().size) : kWholeBrick;
        if (half.mirror.on()) keep[static_cast<std::size_t>(half.mirror.axis)] &= layers;
        if (keep != kWholeBrick && excess.most > 0)
          excess = clipped(excess, field, keep, deposit, out);
        if (excess.most == 0) continue;
        work_[work_count_++] = {brick, excess};
        if (!half.is_image) {
          total_units_ += excess.units;
          ++hand_count_;
        }
      }
}

void Carver::begin_gathering() BURR_RT {
  work_count_ = hand_count_ = 0;
  crowded_ = false;
  total_units_ = 0;
}

// Half of what the one side gave and all of the other's would be no mirror: rather nothing, until
// there are more slices.
void Carver::end_gathering(const Mirror& mirror) BURR_RT {
  if (!mirror.on() || !crowded_) return;
  work_count_ = hand_count_ = 0;
  total_units_ = 0;
}

// Specific cutting energy of what the ball stands in, weighted by volume.  [J/m^3]
double Carver::mean_energy() const BURR_RT {
  double energy = 0, weight = 0;
  for (std::size_t w = 0; w < hand_count_; ++w) {
    const auto units = static_cast<double>(std::max<std::int64_t>(work_[w].excess.units, 0));
    const std::uint8_t one = uniform_[static_cast<std::size_t>(work_[w].brick)];
    double mean = energy_of_[one];
    if (one == kMixed) {
      const volume::TissueId* tissue = bone_.brick_tissue(work_[w].brick);
      double sum = 0, all = 0;
      for (std::uint32_t pairs = work_[w].excess.pairs; pairs != 0; pairs &= pairs - 1) {
        const int first = 2 * kBrickEdge * std::countr_zero(pairs);
        for (int v = first; v < first + 2 * kBrickEdge; ++v) {
          const auto excess = static_cast<double>(scratch_[w].voxel[v]);
          sum += excess * energy_of_[tissue[v]];
          all += excess;
        }
      }
      if (all > 0) mean = sum / all;
    }
    energy += units * mean;
    weight += units;
  }
  return weight > 0 ? energy / weight : last_energy_density_;
}

// Takes (puts) `share` of the excess; returns how much that really was.
Carver::Done Carver::apply(double share, bool deposit, volume::TissueId material,
                           std::uint32_t& flags) BURR_RT {
  Done done;
  const auto fixed = static_cast<std::int32_t>(std::clamp(share, 0.0, 1.0) * 65536.0);
  if (fixed == 0) return done;
  BrickField now;
  for (std::size_t w = 0; w < work_count_; ++w) {
    const BrickIndex brick = work_[w].brick;
    const volume::Field* field = bone_.brick_field(brick);
    const Applied applied = kernel_.apply(field, scratch_[w].voxel, work_[w].excess.pairs, fixed,
                                          deposit ? 1 : 0, now.voxel);
    if (applied.most == 0) continue;
    if (undo_.keep(brick)) flags |= rt::kFlagUndoFull;
    if (deposit) {
      const math::Ijk first = bone_.brick_ijk(brick);
      for (int v = 0; v < kBrickVoxels; ++v)
        if (now.voxel[v] != field[v] && field[v] < volume::kIso / 2)
          bone_.set_tissue(first.x() + (v & 7), first.y() + (v >> 3 & 7), first.z() + (v >> 6),
                           material);
      std::uint8_t& one = uniform_[static_cast<std::size_t>(brick)];
      one = highest_[static_cast<std::size_t>(brick)] == 0 || one == material ? material : kMixed;
    }
    bone_.write_brick(brick, now);
    if (changed_ != nullptr) changed_->push(brick);
    highest_[static_cast<std::size_t>(brick)] = static_cast<std::uint16_t>(applied.highest);
    surface_.changed(brick, applied.most, applied.rows, applied.columns);
    (w < hand_count_ ? done.hand : done.image) += applied.units;
  }
  return done;
}

// As many as requested, or as it takes for the bricks to fit into the list: no tick may take forever.
int Carver::choose_turns(int wanted, std::uint32_t& flags) BURR_RT {
  if (crowded_) {
    crowd_slices_ = std::min(2 * crowd_slices_, kMostSlices);
  } else if (crowd_slices_ > 1 &&
             std::max(hand_count_, work_count_ - hand_count_) < kMostWork / 4) {
    crowd_slices_ /= 2;
  }
  double bricks = 0;
  for (int t = 0; t < slices_; ++t) bricks += parts_[t].bricks;
  if (bricks > kManyBricks * usual_turns_ && usual_turns_ < kUsualTurns) usual_turns_ *= 2;
  if (bricks < 0.4 * kManyBricks * usual_turns_ && usual_turns_ > 1) usual_turns_ /= 2;
  const int late = std::max(wanted, crowd_slices_);
  if (late > 1) flags |= rt::kFlagPutOff;
  const int slices = std::min(late * usual_turns_, kMostSlices);
  if (slices != slices_) {
    slices_ = slices;
    slice_ = 0;
    // nothing is known yet of the others' parts; the first is taken for the mean of all
    std::fill_n(parts_, slices, Part{});
  }
  return slices;
}

// What all slices together have to give, from what each found when it last came.  [units]
double Carver::excess_of_all_slices() BURR_RT {
  parts_[slice_] = {total_units_, static_cast<int>(work_count_), true};
  slice_ = (slice_ + 1) % slices_;
  double sum = 0;
  int known = 0;
  for (int t = 0; t < slices_; ++t) {
    sum += static_cast<double>(parts_[t].units);
    known += parts_[t].known ? 1 : 0;
  }
  return sum * slices_ / known;
}

// A debt older than patience at the present rate of asking is not going to be cut.
void Carver::write_off(double asked_units, double dt, int slices) BURR_RT {
  const double blend = std::min(1.0, dt / settings_.patience);
  rate_ += (asked_units / dt - rate_) * blend;
  const double patience =
      settings_.patience + (slices - 1) * dt;  // until it is every brick's slice
  const double most = patience * std::max(rate_, asked_units / dt);
  if (debt_ > most) {
    not_cut_ += debt_ - most;
    debt_ = most;
  }
}

// What the image took was asked of nobody: it counts as asked for.
void Carver::take_account_of(const Done& removed) BURR_RT {
  removed_ += removed.hand + removed.image;
  image_removed_ += removed.image;
  asked_ += static_cast<double>(removed.image);
}

void Carver::carve(const Cut& cut, std::uint32_t& flags) BURR_RT {
  constexpr float kNone[4] = {0, 0, 0, -1};
  const int slices = choose_turns(cut.slices, flags);
  const Sides sides = sides_of(cut.centre + advance_ * cut.push, cut.mirror);
  begin_gathering();
  for (int s = 0; s < sides.count; ++s)
    gather(sides.centre[s], cut.radius + margin_, kNone, false, slices, sides.half[s], flags);
  end_gathering(cut.mirror);
  last_energy_density_ = mean_energy();
  const double asked = cut.energy / last_energy_density_ / unit_m3_;
  asked_ += asked;
  debt_ += asked;
  energy_ += cut.energy;
  // every brick gives the same share of its excess, whichever slice is its own: what is asked until
  // the slice comes round again, and what is still owed
  const double all = excess_of_all_slices(), owed = debt_ + (slices - 1) * asked;
  const bool blocked = all < owed;
  const Done removed = apply(share_of(owed, all, cut.mirror), false, 0, flags);
  take_account_of(removed);
  debt_ -= static_cast<double>(removed.hand);
  margin_ =
      std::clamp(margin_ + (blocked ? settings_.margin_rise : -settings_.margin_fall) * cut.dt,
                 least_margin_, std::max(least_margin_, settings_.margin_most));
  const double before = not_cut_;
  write_off(asked, cut.dt, slices);
  if (not_cut_ > before) flags |= rt::kFlagNotCut;
}

void Carver::deposit(const Cut& cut, std::uint32_t& flags) BURR_RT {
  const double radius = settings_.deposit_share * cut.radius;
  const int slices = choose_turns(cut.slices, flags);
  const Sides sides = sides_of(cut.centre + cut.radius * cut.push, cut.mirror);
  begin_gathering();
  for (int s = 0; s < sides.count; ++s) {
    const Vec3 burr = folded(cut.centre, sides.half[s]);
    const float keep_out[4] = {static_cast<float>(burr.x()), static_cast<float>(burr.y()),
                               static_cast<float>(burr.z()),
                               static_cast<float>(cut.radius + settings_.deposit_gap)};
    gather(sides.centre[s], radius, keep_out, true, slices, sides.half[s], flags);
  }
  end_gathering(cut.mirror);
  const double patience = settings_.patience + (slices - 1) * cut.dt;
  const double asked = cut.volume / unit_m3_;
  added_debt_ = std::min(added_debt_ + asked, asked * patience / cut.dt);
  const double all = excess_of_all_slices(), owed = added_debt_ + (slices - 1) * asked;
  const Done added = apply(share_of(owed, all, cut.mirror), true, cut.material, flags);
  added_ += added.hand + added.image;
  image_added_ += added.image;
  added_debt_ -= static_cast<double>(added.hand);
}

// As gather(), with the plain test "is the voxel inside the mill".
void Carver::gather_inside(const Vec3& centre, double radius, int amount, const Half& half,
                           std::uint32_t& flags) BURR_RT {
  const std::size_t most_work = work_count_ + kMostWork;
  const math::Ijk last = bone_.bricks().array() - 1;
  const math::Ijk lo = ((centre.array() - radius) / kBrickEdge)
                           .floor()
                           .max(0)
                           .min(last.cast<double>().array() + 1)
                           .cast<int>();
  const math::Ijk hi = ((centre.array() + radius) / kBrickEdge)
                           .floor()
                           .max(-1)
                           .min(last.cast<double>().array())
                           .cast<int>();
  for (int bk = lo.z(); bk <= hi.z(); ++bk)
    for (int bj = lo.y(); bj <= hi.y(); ++bj)
      for (int bi = lo.x(); bi <= hi.x(); ++bi) {
        const unsigned layers = layers_of({bi, bj, bk}, half, 1, 0);
        const BrickIndex brick = bone_.brick_at(bi, bj, bk);
        if (layers == 0 || highest_[static_cast<std::size_t>(brick)] == 0) continue;
        if (work_count_ == most_work) {
          crowded_ = true;
          flags |= rt::kFlagPutOff;
          return;
        }
        const volume::Field* field = bone_.brick_field(brick);
        std::uint16_t* out = scratch_[work_count_].voxel;
        const Vec3 first = Vec3(kBrickEdge * bi, kBrickEdge * bj, kBrickEdge * bk) - centre;
        Excess excess;
        for (int v = 0; v < kBrickVoxels; ++v) {
          const Vec3 p = first + Vec3(v & 7, v >> 3 & 7, v >> 6);
          const bool in =
              p.squaredNorm() <= radius * radius && in_layers(v, half.mirror.axis, layers);
          const int loses = in ? std::min(int{field[v]}, amount) : 0;
          out[v] = static_cast<std::uint16_t>(loses);
          if (loses == 0) continue;
          excess.most = std::max(excess.most, loses);
          excess.pairs |= 1U << (v >> 4);
          excess.units += volume::volume_units(std::int32_t{field[v]}) -
                          volume::volume_units(int{field[v]} - loses);
        }
        if (excess.most == 0) continue;
        work_[work_count_++] = {brick, excess};
        hand_count_ += half.is_image ? 0 : 1;
      }
}

void Carver::lower(const Cut& cut, double amount, std::uint32_t& flags) BURR_RT {
  const Sides sides = sides_of(cut.centre + advance_ * cut.push, cut.mirror);
  begin_gathering();
  for (int s = 0; s < sides.count; ++s)
    gather_inside(sides.centre[s], cut.radius + least_margin_,
                  static_cast<int>(std::clamp(amount, 0.0, 65535.0)), sides.half[s], flags);
  end_gathering(cut.mirror);
  last_energy_density_ = mean_energy();
  const Done removed = apply(1, false, 0, flags);
  take_account_of(removed);
  asked_ += static_cast<double>(removed.hand);
  energy_ += static_cast<double>(removed.hand) * unit_m3_ * last_energy_density_;
}

void Carver::idle(double dt) BURR_RT {
  work_count_ = hand_count_ = 0;
  crowded_ = false;
  rate_ += (0 - rate_) * std::min(1.0, dt / settings_.patience);
  const double most = settings_.patience * rate_;
  if (debt_ > most) {
    not_cut_ += debt_ - most;
    debt_ = most;
  }
}

void Carver::note_whole(BrickIndex brick, const BrickField& before, const BrickField& now) BURR_RT {
  int most = 0, highest = 0;
  std::uint64_t rows = 0;
  unsigned columns = 0;
  for (int v = 0; v < kBrickVoxels; ++v) {
    const int change = std::abs(int{now.voxel[v]} - int{before.voxel[v]});
    highest = std::max(highest, int{now.voxel[v]});
    if (change == 0) continue;
    most = std::max(most, change);
    rows |= 1ULL << (v >> 3);
    columns |= 1U << (v & 7);
  }
  highest_[static_cast<std::size_t>(brick)] = static_cast<std::uint16_t>(highest);
  if (most > 0) surface_.changed(brick, most, rows, columns);
}

void Carver::restore(const KeptBrick& kept) BURR_RT {
  if (bone_.ensure_slot(kept.brick) == volume::kNoSlot)
    return;  // cannot be: it had one when it was kept
  BrickField before;
  std::memcpy(&before, bone_.brick_field(kept.brick), sizeof before);
  const math::Ijk first = bone_.brick_ijk(kept.brick);
  const volume::TissueId* tissue = bone_.brick_tissue(kept.brick);
  bool same_tissue = true;
  for (int v = 0; v < kBrickVoxels; ++v)
    if (tissue[v] != kept.tissue[v]) {
      same_tissue = false;
      bone_.set_tissue(first.x() + (v & 7), first.y() + (v >> 3 & 7), first.z() + (v >> 6),
                       kept.tissue[v]);
    }
  if (!same_tissue) uniform_[static_cast<std::size_t>(kept.brick)] = kMixed;
  bone_.write_brick(kept.brick, kept.field);
  if (changed_ != nullptr) changed_->push(kept.brick);
  note_whole(kept.brick, before, kept.field);
}

void Carver::rewrite(const KeptBrick& now, std::uint32_t& flags) BURR_RT {
  if (bone_.ensure_slot(now.brick) == volume::kNoSlot) {
    flags |= rt::kFlagReserve;
    return;
  }
  if (undo_.keep(now.brick)) flags |= rt::kFlagUndoFull;
  const volume::Field* field = bone_.brick_field(now.brick);
  std::int64_t gone = 0;
  for (int v = 0; v < kBrickVoxels; ++v) {
    const int before = field[v], after = now.field.voxel[v];
    if (before == after) continue;
    const std::int64_t by = volume::volume_units(after) - volume::volume_units(before);
    (after < before ? gone : added_) += after < before ? -by : by;
  }
  removed_ += gone;
  asked_ += static_cast<double>(gone);
  restore(now);
}

void Carver::swap(KeptBrick& kept) BURR_RT {
  KeptBrick now;
  now.brick = kept.brick;
  const volume::Field* field = bone_.brick_field(kept.brick);
  if (field == nullptr) return;
  std::memcpy(&now.field, field, sizeof now.field);
  std::memcpy(now.tissue, bone_.brick_tissue(kept.brick), sizeof now.tissue);
  restore(kept);
  kept = now;
}

bool Carver::clear_of(const KeptBrick& kept, const Vec3& centre, double radius) const BURR_RT {
  const Vec3 first = bone_.brick_ijk(kept.brick).cast<double>();
  for (int v = 0; v < kBrickVoxels; ++v) {
    if (kept.field.voxel[v] < volume::kIso / 2) continue;
    const Vec3 p = first + Vec3(v & 7, v >> 3 & 7, v >> 6);
    if ((p - centre).squaredNorm() < (radius + 1) * (radius + 1)) return false;
  }
  return true;
}

Ledger Carver::ledger() const BURR_RT {
  Ledger ledger;
  ledger.asked = asked_ * unit_m3_;
  ledger.removed = static_cast<double>(removed_) * unit_m3_;
  ledger.debt = debt_ * unit_m3_;
  ledger.not_cut = not_cut_ * unit_m3_;
  ledger.added = static_cast<double>(added_) * unit_m3_;
  ledger.energy = energy_;
  return ledger;
}

}  // namespace burr::edit
