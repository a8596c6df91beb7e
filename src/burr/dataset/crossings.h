// dataset/crossings.h - which voxels left the bone of a recording, and which came back, and when.
//
// A voxel leaves the bone when its field falls below volume::kIso, so what was cut from it before is
// not seen. Thread: one, the player's.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/record/player.h"
#include "burr/sim/row_log.h"
#include "burr/volume/bone.h"

namespace burr::dataset {

struct Crossings {
  std::vector<sim::CrossedVoxel> voxels;  // in order of ticks
  // The bone at the end: whose labels are those of what was added.
  std::unique_ptr<volume::Bone> after;
  // Empty: each voxel has the tick in which it crossed, found by simulating the session again. Else
  // why that was not possible; the ticks are then those of the bone's recorded states, up to 100 ms
  // late.
  std::string late;
};

// before: the bone at the first tick; not changed. Error: interrupted, or not the bone of this
// recording.
[[nodiscard]] Result<Crossings> crossings_of(record::Player& player, const volume::Bone& before,
                                             Progress& progress);
// Without simulating.
[[nodiscard]] Result<Crossings> crossings_of_states(record::Player& player,
                                                    const volume::Bone& before);

}  // namespace burr::dataset
