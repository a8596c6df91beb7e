#include "burr/workshop/sound_tracker.h"

#include <algorithm>
#include <utility>

namespace burr::workshop {
namespace {

constexpr double kOver = 10e-3;  // shortest time over which removal is averaged  [s]

}  // namespace

SoundTracker::SoundTracker(const tick::ServoSettings& settings, ToSpare to_spare)
    : teeth_(settings.burr.teeth), rate_hz_(settings.rate_hz), to_spare_(std::move(to_spare)) {}

const sound::SoundState& SoundTracker::update(const tick::TickRow& row) {
  now_.spindle_rad_s = row.spindle_rad_s;
  now_.cutting_nm = row.cutting_nm;
  now_.touching = row.contact.touching;
  now_.teeth = row.tool.kind == tool::BurrKind::diamond ? 0 : teeth_;
  now_.irrigated = row.tool.irrigated;
  if (to_spare_) now_.to_spare = to_spare_(row.contact.proxy) - row.tool.radius;

  const Account account = {row.tick, row.ledger.removed, row.ledger.energy};
  if (!before_ || account.tick < before_->tick) before_ = account;  // the first; a jump back
  const double seconds = static_cast<double>(account.tick - before_->tick) / rate_hz_;
  if (seconds < kOver) return now_;
  const double removed = std::max(0.0, account.removed - before_->removed);
  const double energy = std::max(0.0, account.energy - before_->energy);
  now_.removal_m3_s = removed / seconds;
  if (removed > 0) now_.hardness_j_m3 = energy / removed;
  before_ = account;
  return now_;
}

}  // namespace burr::workshop
