// scoring/reference.h - the bone as the reference result of a case leaves it, made by formula.
//
//     after = before and not (the regions of `remove`, without what is nearer than `mm` to a structure of
//             `leave`), and the regions of `fill` besides
//
// It tests a rubric: work that follows the plan exactly must meet the rubric's product.
// Thread: one. Cost: a pass over all bricks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/metrics/region.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/bone.h"
#include "burr/volume/distance_to.h"

namespace burr::scoring {

// What the reference says, as regions.
struct ReferencePlan {
  struct Part {
    std::string name;  // of the region
    metrics::Region region;
  };
  std::vector<Part> remove;  // each without what `leave` keeps; at least one
  std::vector<Part> fill;
};
// lesson: with its landmarks placed and a reference. Error: interrupted.
[[nodiscard]] Result<ReferencePlan> reference_plan(const volume::Bone& before,
                                                   const scenario::CaseLesson& lesson,
                                                   Progress& progress);
class Workpiece;
[[nodiscard]] ReferencePlan reference_plan_of(Workpiece& scene);
// One region of several parts, at least one.
[[nodiscard]] metrics::Region all_of(const std::vector<ReferencePlan::Part>& parts);

// What a case says must stay intact in some way, and how far a point is from it.
struct SparedStructure {
  std::string name;
  std::vector<volume::TissueId> tissues;
  std::shared_ptr<const volume::DistanceTo> distance;
};
// Error: interrupted.
[[nodiscard]] Result<std::vector<SparedStructure>> spared_structures(
    const volume::Bone& before, const scenario::CaseLesson& lesson, Progress& progress);

// bone: equal to `before`; becomes the result. lesson: with its landmarks placed and a reference.
// Errors: interrupted; Trouble::data if the bone has no room for what is added.
[[nodiscard]] Status cut_to_reference(volume::Bone& bone, const volume::Bone& before,
                                      const scenario::CaseLesson& lesson, Progress& progress);

}  // namespace burr::scoring
