// rt/machine_check.h - is this computer good enough for a hand? Facts and measured tails become
// sentences, and one verdict.
//
// Plain data in, plain data out: `burr check` measures, tests invent. Thread: any. Units in names.
#pragma once

#include <string>
#include <vector>

#include "burr/rt/machine.h"
#include "burr/rt/stats.h"
#include "burr/rt/thread.h"

namespace burr::rt {

// What was seen of 1000 ticks a second: a loop that only waits, and the real tick while milling,
// each alone and with everything else at work.
struct MachineSeen {
  Machine machine;
  ThreadGrant grant;  // of the servo's thread
  TickSummary waiting, milling, waiting_loaded, milling_loaded;
};

enum class Verdict {
  good,        // for a real device
  usable,      // to learn and to try; a real device may let go of the hand at times
  not_enough,  // not for a real device
};

// What decides, while everything else is at work. Lateness: how long after it was due a tick began.
struct CheckBars {
  double work_us = 500;     // p99.9: half of a tick's millisecond
  double late_us = 100;     // p99.9: a tenth of it; a hand does not feel that
  double worst_us = 1000;   // no tick is left out
  double missed_share = 0;  // of all ticks
};
inline constexpr CheckBars kGood = {};
inline constexpr CheckBars kUsable = {900, 1000, 5000, 1e-3};  // 5 ms: the watchdog lets go

// One line: what, as it is, and what to change; `change` empty: nothing.
struct CheckLine {
  std::string what, is, change;
};

struct MachineJudged {
  Verdict verdict = Verdict::not_enough;
  std::string sentence;              // the verdict, with its reasons
  std::vector<std::string> reasons;  // why it is not better; empty: good
  std::vector<CheckLine> lines;
};

[[nodiscard]] MachineJudged judge(const MachineSeen& seen);

// "good", "usable", "not good enough"
[[nodiscard]] const char* name(Verdict verdict) noexcept;

}  // namespace burr::rt
