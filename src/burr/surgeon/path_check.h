// surgeon/path_check.h - what is probably wrong with a hand path for a bone, before it is followed.
//
// Frame: world (LPS). Units: SI. Thread: any, before the session begins.
#pragma once

#include <string>
#include <vector>

#include "burr/device/hand_path.h"
#include "burr/volume/bone.h"

namespace burr::surgeon {

// Sentences for the user, each with its remedy; empty: nothing is doubted. They say
// - that the burr is inside bone at the first point: then nothing is felt or cut until it has been in
//   free air, by the rule of haptics/safety;
// - that the burr never reaches the box around the bone, and how far away it stays.
// name: of the path's file, as it is to be shown.
[[nodiscard]] std::vector<std::string> doubts(const device::HandPath& path,
                                              const volume::Bone& bone, double burr_radius,
                                              const std::string& name);

}  // namespace burr::surgeon
