// edit/tool_body.h - the parts of a tool that cut, placed in the bone's grid for one tick.
//
// A part leaves at most floor = 1/2 + (phi - margin) / (2 kRamp) of a voxel, phi its signed
// distance (tool/shape.h). What is above the floor is the excess, times the weight of the place:
//
//     even      1                      a saw's teeth, an edge that is pushed or struck
//     turning   r / full, >= least     r: distance to the tool's axis; a point on the axis does not
//                                      move, so the pole of a drill cuts nothing by itself
//
// The weight is the speed of that element over the fastest one's (docs/understand/cutting.md,
// "Tools of any shape"). Parts that rub are not in this list.
//
// Thread: any. Frame: p_grid [voxel]. Memory: none.
#pragma once

#include <array>

#include "burr/edit/mirror.h"
#include "burr/edit/shape_kernel.h"
#include "burr/math/pose.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/tool/tool.h"
#include "burr/volume/bone.h"

namespace burr::edit {

// How the surface of the tool moves over the bone.
enum class Sweep { even, turning };

struct ToolBody {
  struct Part {
    tool::Shape shape;          // [voxel]
    math::Pose tool_from_part;  // [voxel]
  };
  std::array<Part, tool::Tool::kMostParts> parts;
  int count = 0;
  math::Pose grid_from_tool;  // [voxel]
  // Where the hand wants the tool to go: per voxel of advance, a move [voxel] and a turn [rad]
  // about the tool's origin. The carver takes its advance along it.
  math::Vec3 ahead = math::Vec3::Zero(), turn = math::Vec3::Zero();
  Sweep sweep = Sweep::even;
  double least_weight = 0.15;  // of a turning tool, on its axis  [-]
};

// The cutting parts of `tool`, whose sizes are in m, in a grid of voxels of `voxel_m`. The pose and
// the way ahead are for the caller to set.
[[nodiscard]] ToolBody cutting_body(const tool::Tool& tool, double voxel_m) BURR_RT;

// The same after an advance of `by` [voxel].
[[nodiscard]] ToolBody advanced(const ToolBody& body, double by) BURR_RT;

// The body as the carver meets it: its image across the mirror where `half` is the image's side.
class PlacedBody {
 public:
  // margin: how much larger the parts cut than they are  [voxel]
  PlacedBody(const ShapeKernel& kernel, const ToolBody& body, const Half& half,
             double margin) BURR_RT;

  // Box around all that the parts reach, ramp included.  [voxel]
  [[nodiscard]] const math::Vec3& low() const BURR_RT { return low_; }
  [[nodiscard]] const math::Vec3& high() const BURR_RT { return high_; }
  // No voxel of the brick that begins at `first` is nearer to the surface of a part.  [voxel]
  [[nodiscard]] double nearest(const math::Vec3& first) const BURR_RT;
  // What is above the floor in that brick.
  [[nodiscard]] Excess find(const volume::Field* field, const math::Vec3& first,
                            std::uint16_t* out) const BURR_RT;

 private:
  ShapeKernel kernel_;
  std::array<ToolBody::Part, tool::Tool::kMostParts> parts_;
  std::array<KernelPart, tool::Tool::kMostParts> kernel_parts_;
  std::array<math::Vec3, tool::Tool::kMostParts> origin_;  // of the parts, on this side
  int count_ = 0;
  int flipped_ = -1;  // axis along which this side is the image
  double margin_ = 0;
  math::Vec3 low_, high_;
};

}  // namespace burr::edit
