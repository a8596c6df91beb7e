// apps/burr/commands/mill_way.h - where the simulated hand of `burr mill` goes, and whether a cut along a
// plane went through.
//
// Thread: main. Units: SI.
#pragma once

#include <optional>
#include <string>

#include "burr/base/result.h"
#include "burr/device/hand_path.h"
#include "burr/surgeon/motion.h"
#include "burr/surgeon/plane_cut.h"
#include "burr/volume/bone.h"
#include "commands/mill_options.h"

namespace burr::app {

// A cut along a plane: through what it should go.
struct StepCut {
  surgeon::CutPlane plane;
  double area = 0,
         seconds = 0;  // of bone in the plane before the cut [m^2]; the duration asked for
};

// The file, the built-in motion, or the cut along the plane of a step of the case. place: gets where the
// work is. cut: gets the cut, if it is one.
[[nodiscard]] Result<device::HandPath> hand_path(const MillOptions& options,
                                                 const volume::Bone& bone,
                                                 surgeon::WorkPlace& place,
                                                 std::optional<StepCut>& cut);

// Is the cut through? A sentence if not, and how much of the bone in the plane is left, 0 to 1.
struct CutLeft {
  double share = 0, needs_s = 0;  // needs_s: 0: it is through
  std::string sentence;
};
[[nodiscard]] std::optional<CutLeft> left_of(const std::optional<StepCut>& cut,
                                             const volume::Bone& bone);

// The hand stays where the path ends, with the spindle off.
void rest_at_end(device::HandPath& path);

}  // namespace burr::app
