// apps/burr/bench/machine_trial.h - tests whether this computer is fast enough for a haptic device:
// a loop that only waits, the real tick while milling, and both with full load.
//
// Main thread; takes its time and reports progress.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/rt/machine_check.h"

namespace burr::app {

struct MachineTrial {
  double seconds = 12;    // in three equal parts
  double voxel_mm = 0.2;  // of the built-in bone that is milled
  bool picture = true;    // draw a picture meanwhile
};

struct MachineTrialResult {
  rt::MachineMeasurements seen;
  std::vector<std::string> left_out;  // sentences
};

[[nodiscard]] Result<MachineTrialResult> measure_machine(const MachineTrial& trial);

}  // namespace burr::app
