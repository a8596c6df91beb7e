// fit/recorded_log.h - a force log out of our own recordings.
//
// At 1000 ticks a second what is removed in one tick is rough; each row is the mean over a window.
// Thread: one.
#pragma once

#include <string_view>

#include "burr/base/result.h"
#include "burr/fit/force_log.h"
#include "burr/record/player.h"

namespace burr::fit {

// One row for each whole window [s] in which the burr cut from beginning to end. `material`: what
// was cut; "": the bone's only solid tissue, or an Error if it has several. Power and tangential
// force are those of the recording; where it has none, power is that of the removal law it was
// made with, and tangential force is left out.
[[nodiscard]] Result<ForceLog> log_of_recording(record::Player& player, double window,
                                                std::string_view material);

}  // namespace burr::fit
