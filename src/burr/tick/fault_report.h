// tick/fault_report.h - keeps the last ticks before the force was released by a fault, to find out
// why.
//
//     keeper.raise();  ...  keeper.note(row);          // each tick; once the force is zero:
//     FaultReport report;  if (keeper.reports().take(report)) ...
//
// Thread: the servo; reports() has one reader, any thread. Memory: allocated at construction.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "burr/rt/flags.h"
#include "burr/rt/latest.h"
#include "burr/rt/rt.h"
#include "burr/tick/rows.h"

namespace burr::tick {

// Oldest first.
struct FaultReport {
  static constexpr int kTicks = 200;
  std::uint32_t flags = 0;  // what happened, rt/flags.h
  int count = 0;
  std::array<TickRow, kTicks> rows;
};

class FaultKeeper {
 public:
  FaultKeeper() : recent_(FaultReport::kTicks) {}

  // Something went wrong in this tick.
  void raise() BURR_RT { waits_ = true; }
  // The row of the newest tick; ticks count up by one. What was raised is copied out with the first
  // row whose force is zero: first it fades.
  void note(const TickRow& row) BURR_RT {
    renew(row);
    report_.flags |= row.contact.flags &
                     (rt::kFlagNotFinite | rt::kFlagWatchdog | rt::kFlagJump | rt::kFlagHandLost);
    if (!waits_ || row.contact.force != math::Vec3::Zero()) return;
    waits_ = false;
    report_.count = static_cast<int>(std::min<std::uint64_t>(row.tick + 1, FaultReport::kTicks));
    const std::uint64_t first = row.tick + 1 - static_cast<std::uint64_t>(report_.count);
    for (int n = 0; n < report_.count; ++n)
      report_.rows[static_cast<std::size_t>(n)] =
          recent_[(first + static_cast<std::uint64_t>(n)) % FaultReport::kTicks];
    reports_.publish(report_);
    report_.flags = 0;
  }
  // The same row once more, with what was only known later.
  void renew(const TickRow& row) BURR_RT { recent_[row.tick % FaultReport::kTicks] = row; }

  [[nodiscard]] rt::Latest<FaultReport>& reports() BURR_RT { return reports_; }

 private:
  std::vector<TickRow> recent_;  // ring
  FaultReport report_;
  bool waits_ = false;
  rt::Latest<FaultReport> reports_;
};

}  // namespace burr::tick
