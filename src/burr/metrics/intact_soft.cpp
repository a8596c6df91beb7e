#include "burr/metrics/intact_soft.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"
#include "burr/metrics/near.h"

namespace burr::metrics {

Contacts::Contacts() { list_.reserve(kMostContacts); }

Contact* Contacts::open_contact(const Moment& now) {
  constexpr double kPause = 50e-3;  // [s]
  if (now.t - last_ > kPause) {
    ++count_;
    if (list_.size() < kMostContacts) list_.push_back({.begin = now.t});
  }
  return count_ <= kMostContacts ? &list_.back() : nullptr;
}

void Contacts::add(const Moment& now, double depth) {
  Contact* one = open_contact(now);
  last_ = now.t;
  seconds_ += now.dt;
  if (one == nullptr) return;
  one->end = now.t;
  one->mean_force = (one->mean_force * one->seconds + now.force * now.dt) / (one->seconds + now.dt);
  one->seconds += now.dt;
  one->force = std::max(one->force, now.force);
  if (one->seconds <= now.dt || depth > one->depth) {
    one->depth = depth;
    one->at = now.centre;
  }
}

IntactSoftMaker::IntactSoftMaker(const volume::Grid& grid, const VoxelSet& structure,
                                 const volume::DistanceTo& distance, const Worked& worked,
                                 const IntactSoftSettings& settings)
    : grid_(grid),
      structure_(structure),
      distance_(distance),
      worked_(worked),
      settings_(settings),
      through_(grid, structure) {}

void IntactSoftMaker::add(const Moment& now) {
  if (now.gap) last_.known = false;
  if (!now.turning || now.tool.mode != tool::Mode::cut || !now.radius_known()) {
    turned_ = turned_ || (now.turning && now.tool.mode == tool::Mode::cut);
    last_.known = false;
    return;
  }
  turned_ = radius_ = true;
  const double r = now.tool.radius, depth = r - distance_.at(now.centre).distance;
  const double grit = now.tool.kind == tool::BurrKind::diamond ? settings_.more_diamond : 0;
  deepest_less_ = std::max(deepest_less_, depth - grit);
  if (last_.known && std::isfinite(depth)) {
    const double way = math::norm(now.centre - last_.centre);
    between_ = std::max(between_, 0.5 * (depth + last_.depth + way));
    between_less_ = std::max(between_less_, 0.5 * (depth - grit + last_.less + way));
  }
  last_ = {std::isfinite(depth), now.centre, depth, depth - grit};
  if (depth > deepest_) {
    deepest_ = depth;
    deepest_at_ = now.t;
    deepest_place_ = now.centre;
  }
  if (depth - grit > 0.5 * grid_.voxel) contacts_.add(now, depth);
  if (depth <= 0) return;
  // a quarter of a voxel: nearer balls hold the same voxels, nearly
  const double moved = 0.25 * grid_.voxel;
  if (math::squared_norm(now.centre - marked_) < moved * moved && r <= marked_radius_) return;
  through_.mark_ball(now.centre, r);
  marked_ = now.centre;
  marked_radius_ = r;
}

Assessed<IntactSoft> IntactSoftMaker::finish() const {
  if (structure_.count() == 0 || distance_.empty())
    return NotAssessable{"the structure is not in this bone: no voxel has its label"};
  if (!turned_) return NotAssessable{"the burr never turned"};
  if (!radius_) return NotAssessable{kNoRadius};
  const double h = grid_.voxel;
  IntactSoft out;
  const double deepest = std::max(0.0, deepest_), less = std::max(0.0, deepest_less_);
  const auto error = [h](double found, double between) {
    return 0.5 * h + std::max(0.0, between - found);
  };
  out.touched = intact_mark(less, 0.5 * h, error(less, between_less_), worked_);
  out.entered = intact_mark(deepest, settings_.p2, error(deepest, between_), worked_);
  out.volume = static_cast<double>(through_.count()) * h * h * h;
  out.contacts = contacts_.list();
  out.contact_count = contacts_.count();
  if (deepest_ > 0) {
    out.deepest_at = deepest_at_;
    out.deepest_place = deepest_place_;
  }
  return out;
}

}  // namespace burr::metrics
