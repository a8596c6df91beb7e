#include "burr/scoring/reference.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "burr/base/check.h"
#include "burr/metrics/region.h"
#include "burr/scoring/workpiece.h"
#include "burr/volume/cut_by_depth.h"

namespace burr::scoring {

Result<ReferencePlan> reference_plan(const volume::Bone& before, const scenario::CaseLesson& lesson,
                                     Progress& progress) {
  Workpiece scene(before, before, lesson, progress);
  ReferencePlan plan = reference_plan_of(scene);
  if (scene.stopped()) return error(Trouble::interrupted, "stopped");
  return plan;
}

ReferencePlan reference_plan_of(Workpiece& scene) {
  const scenario::CaseLesson& lesson = scene.lesson();
  BURR_CHECK(lesson.reference && !lesson.reference->remove.empty());
  ReferencePlan plan;
  for (const std::string& name : lesson.reference->remove) {
    metrics::Region region = scene.region(name);
    for (const auto& [structure, thickness] : lesson.reference->leave)
      if (!scene.tissues(structure).empty())
        region = metrics::without(std::move(region),
                                  metrics::within(scene.distance(structure), thickness));
    plan.remove.push_back({name, std::move(region)});
  }
  for (const std::string& name : lesson.reference->fill)
    plan.fill.push_back({name, scene.region(name)});
  return plan;
}

Result<std::vector<SparedStructure>> spared_structures(const volume::Bone& before,
                                                       const scenario::CaseLesson& lesson,
                                                       Progress& progress) {
  Workpiece scene(before, before, lesson, progress);
  std::vector<SparedStructure> all;
  for (const scenario::Structure& one : lesson.structures) {
    std::vector<volume::TissueId> tissues = scene.tissues(one.name);
    if (one.intact != scenario::Intact::unsaid && !tissues.empty())
      all.push_back({one.name, std::move(tissues), scene.distance(one.name)});
  }
  if (scene.stopped()) return error(Trouble::interrupted, "stopped");
  return all;
}

metrics::Region all_of(const std::vector<ReferencePlan::Part>& parts) {
  BURR_CHECK(!parts.empty());
  metrics::Region all = parts.front().region;
  for (std::size_t n = 1; n < parts.size(); ++n)
    all = metrics::either(std::move(all), parts[n].region);
  return all;
}

Status cut_to_reference(volume::Bone& bone, const volume::Bone& before,
                        const scenario::CaseLesson& lesson, Progress& progress) {
  const auto plan = reference_plan(before, lesson, progress);
  if (!plan) return plan.error();
  if (const Status cut = volume::cut_by_depth(bone, all_of(plan->remove), progress); !cut)
    return cut;
  return plan->fill.empty() ? fine() : volume::fill_by_depth(bone, all_of(plan->fill));
}

}  // namespace burr::scoring
