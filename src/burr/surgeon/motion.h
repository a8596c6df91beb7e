// surgeon/motion.h - built-in paths for the simulated hand, to work on a bone without a person.
//
// Frame: world (LPS). Units: SI.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/device/hand_path.h"
#include "burr/volume/bone.h"

namespace burr::surgeon {

// Where the work begins: a point on the bone and the direction in.
struct WorkPlace {
  math::Vec3 at = math::Vec3::Zero();      // on the surface            [m]
  math::Vec3 into = -math::Vec3::UnitZ();  // unit, into the bone
};

// The topmost bone (largest world z) under the volume's centre, with the surface normal averaged
// over a burr's width; if there is none, the bone nearest to that line. With `at`: the surface
// nearest along `into` through that point.
[[nodiscard]] Result<WorkPlace> find_work_place(const volume::Bone& bone, double burr_radius,
                                                const std::optional<math::Vec3>& at,
                                                const std::optional<math::Vec3>& into);

// stroke: strokes along a line; plunge: straight in; slot: one groove; pocket: circles that get
// wider and deeper; touch: strokes with the spindle off.
[[nodiscard]] std::vector<std::string> motion_names();

// The hand comes from 5 mm above, then works for the rest of `seconds` (at least 1); the spindle is
// on from the start.
[[nodiscard]] Result<device::HandPath> motion(std::string_view name, const WorkPlace& place,
                                              double burr_radius, double seconds);

// Reads a CSV file with the header t,x,y,z[,qw,qx,qy,qz][,spindle]; seconds and metres, or
// x_mm,y_mm,z_mm; spindle 0..1.
[[nodiscard]] Result<device::HandPath> read_path(const std::string& file);

}  // namespace burr::surgeon
