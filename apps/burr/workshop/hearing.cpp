#include "workshop/hearing.h"

#include <algorithm>
#include <utility>

namespace burr::app {
namespace {

constexpr double kOver = 10e-3;  // removal is told over so long, or longer  [s]

}  // namespace

Hearing::Hearing(const tick::ServoSettings& settings, ToSpare to_spare)
    : rate_hz_(settings.rate_hz), radius_(settings.burr.radius), to_spare_(std::move(to_spare)) {
  teeth_ = settings.burr.teeth;
  now_.teeth = settings.burr.kind == tool::BurrKind::diamond ? 0 : teeth_;
  now_.irrigated = settings.irrigated;
}

void Hearing::obey(const tick::Command& command) {
  if (command.kind == tick::CommandKind::irrigation) now_.irrigated = command.value > 0;
  if (command.kind == tick::CommandKind::burr_kind) now_.teeth = command.value > 0 ? 0 : teeth_;
  if (command.kind == tick::CommandKind::burr_radius && command.value > 0 &&
      command.value <= 0.5 * tool::kLargestDiameter)
    radius_ = command.value;
}

const sound::Heard& Hearing::hear(const tick::TickRow& row) {
  now_.spindle_rad_s = row.spindle_rad_s;
  now_.cutting_nm = row.cutting_nm;
  now_.touching = row.contact.touching;
  if (to_spare_) now_.to_spare = to_spare_(row.contact.proxy) - radius_;

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

}  // namespace burr::app
