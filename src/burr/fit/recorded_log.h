// fit/recorded_log.h - makes a force log from a recording of burr.
//
// At 1000 ticks a second the removal of a single tick is uneven; each row is the mean over a
// window. Thread: one.
#pragma once

#include <string_view>

#include "burr/base/result.h"
#include "burr/fit/force_log.h"
#include "burr/record/player.h"

namespace burr::fit {

// One row for each whole window [s] in which the burr cut from beginning to end. `material`: what
// was cut; "": the bone's only solid tissue, or an Error if it has several. Power and tangential
// force are those of the recording. If it has none, power is computed by the removal law of the
// recording, and tangential force is left out.
[[nodiscard]] Result<ForceLog> log_of_recording(record::Player& player, double window,
                                                std::string_view material);

}  // namespace burr::fit
