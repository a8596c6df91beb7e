#include "burr/tick/shed.h"

#include <algorithm>

namespace burr::tick {

const char* name(Shed shed) noexcept {
  switch (shed) {
    case Shed::none:
      break;
    case Shed::picture:
      return "the picture";
    case Shed::mesh:
      return "picture and mesh";
    case Shed::removal_2:
      return "picture, mesh and half of the removal";
    case Shed::removal_4:
      return "picture, mesh and three quarters of the removal";
    case Shed::removal_8:
      return "picture, mesh and seven eighths of the removal";
    case Shed::touch:
      return "all that can wait; the burr may lag behind a fast hand";
  }
  return "nothing";
}

ShedGovernor::ShedGovernor(std::int64_t period_ns, const ShedSettings& settings)
    : settings_(settings),
      period_s_(1e-9 * static_cast<double>(period_ns)),
      calm_wanted_(settings.calm) {}

void ShedGovernor::note(std::int64_t wall_ns, std::int64_t late_ns, std::int64_t missed) BURR_RT {
  const double work = 1e-9 * static_cast<double>(wall_ns),
               late = 1e-9 * static_cast<double>(late_ns);
  const bool heavy = work > settings_.work_share * period_s_;
  const bool kept_waiting = missed > 0 || late > settings_.late_share * period_s_;
  const bool over = heavy || (kept_waiting && !settings_.has_realtime_priority);
  // time goes on in the periods that were left out, too
  const double passed = period_s_ * static_cast<double>(1 + std::max<std::int64_t>(missed, 0));
  // ... but one long pause is one mishap, however many it took along
  const double blend = std::min(0.2, passed / settings_.memory);
  share_ += ((over ? 1.0 : 0.0) - share_) * blend;
  heavy_ += ((heavy ? 1.0 : 0.0) - heavy_) * blend;
  since_step_ += passed;
  calm_for_ = share_ > settings_.seldom ? 0 : calm_for_ + passed;

  // a tick that comes late although it is light is not mended by touching less well
  const Shed last = heavy_ > settings_.often ? Shed::touch : Shed::removal_8;
  if (share_ > settings_.often && since_step_ >= settings_.memory && shed_ < last) {
    // a step down that did not last: wait longer before the next one
    if (stepped_down_ && since_step_ < 2 * calm_wanted_)
      calm_wanted_ = std::min(2 * calm_wanted_, settings_.calm_most);
    stepped_down_ = false;
    shed_ = static_cast<Shed>(static_cast<int>(shed_) + 1);
    most_ = std::max(most_, shed_);
    since_step_ = calm_for_ = 0;
  } else if (shed_ != Shed::none && calm_for_ >= calm_wanted_) {
    shed_ = static_cast<Shed>(static_cast<int>(shed_) - 1);
    stepped_down_ = true;
    since_step_ = calm_for_ = 0;
  } else if (shed_ == Shed::none && calm_for_ >= settings_.calm_most) {
    calm_wanted_ = settings_.calm;
  }
}

}  // namespace burr::tick
