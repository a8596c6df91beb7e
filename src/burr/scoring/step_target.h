// scoring/step_target.h - where the work of a step of a case lies on a bone as it is now, and how deep a burr may be
// pressed there before it meets what must be spared. No mark.
//
//     TargetFinder finder(before, lesson, progress);
//     const auto target = finder.find(lesson.steps[n], now, radius);
//
// The target is the bone in the step's region (of a step that adds: the space in it). Its surface is the
// bone that the surgeon sees over it: the outermost on the straight way out, in the step's direction of
// approach. Takes up to seconds: call it on a thread of its own, with bones that nobody changes. Frame:
// world. Units: SI. Thread: any, one at a time. Memory: that of volume/distance_to.h for each structure.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/bone.h"

namespace burr::scoring {

struct StepTarget {
  bool found = false;                  // false: the step names no region, or nothing of it is left
  bool gone = false;                   // nothing of its region is left
  math::Vec3 at = math::Vec3::Zero();  // on the surface over it, near the middle
  math::Vec3 towards = math::Vec3::UnitZ();  // unit, to the surgeon
  double radius = 0;                         // around `at`, across `towards`: of what is over it
  double deepest = 0;                        // of the target below its surface, along the way in
  double thickness = 0;  // of the step's own structure, where that is the surface; 0: it is not
  // The largest press of this burr, anywhere on the surface over the target, that stays a voxel away from
  // what must be spared: a ball of its radius, so far below the surface. At most kMostPress; 0: none.
  double room = 0;
  // Spots of it where this burr can begin, at most kMostSurface; and those where it meets what must be spared
  // however little it is pressed. All are too near: they are the surface then, and room is 0.
  std::vector<math::Vec3> surface, too_near;
  // Of a cut, a region between planes: where they meet the surface of the bone; pairs of ends of lines.
  std::vector<std::array<math::Vec3, 2>> outline;
  // The nearest place of each structure or region that the step spares.
  struct Spared {
    std::string name;
    math::Vec3 at = math::Vec3::Zero();
  };
  std::vector<Spared> spared;
};
inline constexpr double kMostPress = 6e-3;     // [m]
inline constexpr double kLeastPress = 0.2e-3;  // a smaller one cuts nothing
inline constexpr std::size_t kMostSurface = 2000;

// A region between planes: half-spaces alone make it.
[[nodiscard]] bool is_cut(const scenario::CaseRegion& region);

class Workpiece;

class TargetFinder {
 public:
  // before: as it was before the first cut; all are kept by reference, and nobody changes them. lesson: with
  // its landmarks placed.
  TargetFinder(const volume::Bone& before, const scenario::CaseLesson& lesson, Progress& progress);
  ~TargetFinder();
  TargetFinder(const TargetFinder&) = delete;
  TargetFinder& operator=(const TargetFinder&) = delete;

  // radius: of the burr that is to work there. now: of the same grid. Error: interrupted.
  [[nodiscard]] Result<StepTarget> find(const scenario::Step& step, const volume::Bone& now,
                                        double radius);

 private:
  const scenario::CaseLesson& lesson_;
  Progress& progress_;
  std::unique_ptr<Workpiece> scene_;
};

}  // namespace burr::scoring
