// surgeon/plane_cut.h - a path for the simulated hand that divides bone along the plane of a step.
//
//     auto plane = plane_of(lesson, "divide");                    // placed (scenario::place)
//     auto path = cut_along(bone, *plane, blade_of(tool, cutter, lean), 240);
//
// The hand knows the plane exactly and sees no force: it advances at one pace, waits where it should be
// through, and goes back. So it is no surgeon: it shows what the bone does once it is divided.
// Frame: world (LPS). Units: SI. Thread: any.
#pragma once

#include <string_view>

#include "burr/base/result.h"
#include "burr/device/hand_path.h"
#include "burr/scenario/lesson.h"
#include "burr/tool/cutter.h"
#include "burr/tool/tool.h"
#include "burr/volume/bone.h"

namespace burr::surgeon {

struct CutPlane {
  math::Vec3 at = math::Vec3::Zero();       // a point of it              [m]
  math::Vec3 normal = math::Vec3::UnitY();  // unit
  math::Vec3 out = math::Vec3::UnitZ();     // unit, in the plane: to where the hand comes from
};

// Half-way between the two planes that bound the region of the step, cut from the step's first
// approach. Error: there is no such step, with those that there are; its region lies not between two
// parallel planes; the approach does not lie in the plane.
[[nodiscard]] Result<CutPlane> plane_of(const scenario::CaseLesson& lesson, std::string_view step);

// How a tool is held in the plane.
struct Blade {
  double width = 0;   // of what cuts, along the plane             [m]
  double beyond = 0;  // it cuts so far ahead of the tool's origin [m]
  bool lies = false;  // the handle lies along the plane, and the blade advances along the tool's -x
  bool plunges = true;  // straight in, place by place; otherwise to and fro, layer by layer
};
// lean: of the handle from the bone's normal [rad].
[[nodiscard]] Blade blade_of(const tool::Tool& tool, const tool::Cutter& cutter, double lean);
[[nodiscard]] Blade round_blade(double burr_radius);

// Through all bone that the plane meets, and a quarter of a millimetre on. seconds: the whole
// duration, at least 10; where it is too short for the tool, bridges are left. Error: the plane meets
// no bone; seconds out of range.
[[nodiscard]] Result<device::HandPath> cut_along(const volume::Bone& bone, const CutPlane& plane,
                                                 const Blade& blade, double seconds);

// How much bone the plane meets: before and after a cut it says how much of it is left.  [m^2]
[[nodiscard]] double bone_in_plane(const volume::Bone& bone, const CutPlane& plane);

// How long the same cut should take, if in `seconds` it left `left` of the bone in the plane, 0 to 1:
// what is left takes as long as what was cut, and a fifth more, in whole minutes.  [s]
[[nodiscard]] double seconds_needed(double seconds, double left);

}  // namespace burr::surgeon
