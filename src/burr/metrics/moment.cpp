#include "burr/metrics/moment.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"

namespace burr::metrics {
namespace {

bool usable(const tick::TickRow& row) {
  return row.contact.proxy.allFinite() && row.contact.normal.allFinite() &&
         row.contact.force.allFinite() && row.hand.world_from_tool.finite() &&
         std::isfinite(row.ledger.removed) && std::isfinite(row.spindle_rad_s);
}

}  // namespace

bool MomentMaker::make(const tick::TickRow& row, bool gap, Moment& moment) {
  if (!usable(row)) {
    ++unusable_;
    return false;
  }
  moment.tick = row.tick;
  moment.t = static_cast<double>(row.tick) / rate_hz_;
  moment.dt = 1 / rate_hz_;
  moment.centre = row.contact.proxy;
  moment.hand = row.hand.world_from_tool.p;
  moment.shaft = row.hand.world_from_tool.q * math::Vec3::UnitZ();
  moment.normal = row.contact.normal;
  moment.force = math::norm(row.contact.force);
  moment.touching = row.contact.touching;
  moment.turning =
      std::abs(row.spindle_rad_s) > kTurning * std::max(std::abs(row.tool.full_speed), 1.0);
  moment.gap = gap;
  moment.tool = row.tool;
  const double rise = removed_ ? row.ledger.removed - *removed_ : 0;
  moment.removed = gap ? 0 : std::max(0.0, rise);
  if (gap) lost_removed_ += std::max(0.0, rise);
  removed_ = row.ledger.removed;
  return true;
}

bool MomentReader::next(Moment& moment) {
  bool gap = false;
  while (steps_.next(step_)) {
    gap = gap || step_.gap;
    if (maker_.make(step_.row, gap, moment)) return true;
    gap = true;
  }
  return false;
}

}  // namespace burr::metrics
