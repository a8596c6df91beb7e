// apps/burr/window/mill/tick_watch.h - tells from the rows that the window receives how well the
// haptic loop keeps its ticks.
//
// Thread: main.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

#include "burr/rt/stats.h"
#include "burr/tick/servo.h"
#include "window/parts/hud.h"

namespace burr::app {

class TickWatch {
 public:
  using Clock = std::chrono::steady_clock;

  void see(const tick::TickRow& row, double rate_hz, Clock::time_point now);

  [[nodiscard]] bool begun() const { return first_.has_value(); }
  // sheds: the servo puts some work off
  [[nodiscard]] TickHealth health(bool sheds, Clock::time_point now) const;
  [[nodiscard]] const rt::TickStats& stats() const { return stats_; }
  [[nodiscard]] std::uint64_t missed() const { return missed_; }

 private:
  rt::TickStats stats_;
  std::optional<std::pair<std::uint64_t, Clock::time_point>> first_;
  std::uint64_t missed_ = 0;
  Clock::time_point missed_at_{}, lost_at_{};
};

}  // namespace burr::app
