// scoring/workpiece.h - what the items of a rubric look at: the bone before and after, and the names of
// the case as voxels, distances and regions. For use of this room only.
//
// Each is made once. A distance can only fail because somebody stopped the work: stopped() then says
// so, and nothing that was made afterwards counts. Thread: one at a time.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/metrics/axis_fit.h"
#include "burr/metrics/cavity_shape.h"
#include "burr/metrics/cover.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/open_cavity.h"
#include "burr/metrics/plane_fit.h"
#include "burr/metrics/region.h"
#include "burr/metrics/removed.h"
#include "burr/metrics/voxel_set.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/bone.h"
#include "burr/volume/distance_to.h"

namespace burr::scoring {

class Workpiece {
 public:
  // All are kept by reference. The bones have the same grid.
  Workpiece(const volume::Bone& before, const volume::Bone& after,
            const scenario::CaseLesson& lesson, Progress& progress)
      : before_(before), after_(after), lesson_(lesson), progress_(progress) {}

  [[nodiscard]] const volume::Bone& before() const { return before_; }
  [[nodiscard]] const volume::Bone& after() const { return after_; }
  [[nodiscard]] const scenario::CaseLesson& lesson() const { return lesson_; }
  [[nodiscard]] bool stopped() const { return stopped_; }

  [[nodiscard]] std::vector<volume::TissueId> tissues(const std::string& structure) const;
  [[nodiscard]] std::vector<volume::TissueId> glass() const;
  [[nodiscard]] std::vector<math::Vec3> towards() const;  // at least one
  [[nodiscard]] const metrics::VoxelSet& voxels(const std::string& structure);
  [[nodiscard]] std::shared_ptr<const volume::DistanceTo> distance(const std::string& structure);
  // To all solid tissues, a few voxels far: what a burr touches.
  [[nodiscard]] std::shared_ptr<const volume::DistanceTo> distance_to_solid();
  // "": everywhere
  [[nodiscard]] metrics::Region region(const std::string& name);
  // exposed: as an area that was opened; otherwise along any line (metrics/cover.h)
  [[nodiscard]] const metrics::Assessed<metrics::Cover>& cover(const std::string& structure,
                                                               const std::string& region,
                                                               std::size_t most_samples,
                                                               bool exposed);
  [[nodiscard]] metrics::Region regions(const std::vector<std::string>& names);  // all in one; some
  // Of that region, by name; the corridor along a curve in it; the cut at a plane in it; the cavity whose
  // plan it is, of all that was cut `within` a region (empty: anywhere).
  [[nodiscard]] const metrics::Assessed<metrics::Removed>& removed(const std::string& region);
  [[nodiscard]] const metrics::Assessed<metrics::AxisFit>& axis(const std::string& curve,
                                                                const std::string& region);
  [[nodiscard]] const metrics::Assessed<metrics::PlaneFit>& cut_at(const std::string& plane,
                                                                   const std::string& region);
  [[nodiscard]] const metrics::Assessed<metrics::CavityShape>& cavity(const std::string& region,
                                                                      const std::string& within);
  // Share that was removed of what the case says to remove: the regions of its reference, or without
  // one those of its steps. What must stay whole earns nothing below metrics::kLeastWork.
  [[nodiscard]] double worked();

 private:
  metrics::Region region_of(const scenario::Shape& shape);
  std::shared_ptr<const volume::DistanceTo> made_distance(
      const std::vector<volume::TissueId>& tissues, double reach);

  const volume::Bone &before_, &after_;
  const scenario::CaseLesson& lesson_;
  Progress& progress_;
  bool stopped_ = false;
  std::map<std::string, metrics::VoxelSet> voxels_;
  std::map<std::string, std::shared_ptr<const volume::DistanceTo>> distances_;
  std::map<std::tuple<std::string, std::string, std::size_t, bool>,
           metrics::Assessed<metrics::Cover>>
      covers_;
  std::optional<metrics::OpenCavity> open_;
  std::map<std::string, metrics::Assessed<metrics::Removed>> removed_;
  std::map<std::pair<std::string, std::string>, metrics::Assessed<metrics::AxisFit>> axes_;
  std::map<std::pair<std::string, std::string>, metrics::Assessed<metrics::PlaneFit>> planes_;
  std::map<std::pair<std::string, std::string>, metrics::Assessed<metrics::CavityShape>> cavities_;
  std::shared_ptr<const volume::DistanceTo> to_solid_;
  double worked_ = -1;  // below 0: not known yet
};

}  // namespace burr::scoring
