// rt/machine_check.h - decides whether this computer is good enough for a haptic device: turns
// facts and measured times into sentences and one verdict.
//
// A pure function of plain data: `burr check` measures, tests make the data up. Thread: any. Units
// are in the names.
#pragma once

#include <string>
#include <vector>

#include "burr/rt/machine.h"
#include "burr/rt/stats.h"
#include "burr/rt/thread.h"

namespace burr::rt {

// Measured at 1000 ticks a second: a loop that only waits, and the real tick while milling, each
// alone and under full load (`_loaded`).
struct MachineMeasurements {
  Machine machine;
  ThreadGrant grant;  // what the servo's thread was granted
  TickSummary waiting, milling, waiting_loaded, milling_loaded;
};

enum class Verdict {
  good,        // for a real device
  usable,      // for learning and trying; a real device may lose its force now and then
  not_enough,  // not for a real device
};

// Limits for the measurements under full load. Lateness: how long after its due time a tick began.
struct CheckLimits {
  double work_us = 500;     // p99.9: half of a tick's millisecond
  double late_us = 100;     // p99.9: a tenth of it; the hand does not feel that
  double worst_us = 1000;   // longest lateness: no tick is left out
  double missed_share = 0;  // missed ticks, as a share of all
};
inline constexpr CheckLimits kGood = {};
// 5 ms: watchdog releases the force
inline constexpr CheckLimits kUsable = {900, 1000, 5000, 1e-3};

// One line of the report: what was looked at, its value, and what to change (empty: nothing).
struct CheckLine {
  std::string what, value, change;
};

struct MachineReport {
  Verdict verdict = Verdict::not_enough;
  std::string sentence;              // the verdict, with its reasons
  std::vector<std::string> reasons;  // why it is not better; empty if good
  std::vector<CheckLine> lines;
};

[[nodiscard]] MachineReport judge(const MachineMeasurements& seen);

// "good", "usable" or "not good enough".
[[nodiscard]] const char* name(Verdict verdict) noexcept;

}  // namespace burr::rt
