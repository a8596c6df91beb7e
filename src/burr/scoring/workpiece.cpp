#include "burr/scoring/workpiece.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include "burr/base/check.h"
#include "burr/math/pose.h"
#include "burr/math/sums.h"

namespace burr::scoring {
namespace {

using math::Vec3;
using metrics::Region;
using scenario::ShapeKind;

constexpr double kReach = 12e-3;  // of distances: farther does not matter to any measure [m]
constexpr int kThreads = 2;

// The part from..to of a curve, as shares of its length.
std::vector<Vec3> part_of(const std::vector<Vec3>& curve, double from, double to) {
  double all = 0;
  for (std::size_t n = 1; n < curve.size(); ++n) all += (curve[n] - curve[n - 1]).norm();
  std::vector<Vec3> part;
  double at = 0;
  for (std::size_t n = 1; n < curve.size(); ++n) {
    const Vec3 piece = curve[n] - curve[n - 1];
    const double length = piece.norm();
    const double begin = std::max(from * all - at, 0.0), end = std::min(to * all - at, length);
    at += length;
    if (length <= 0 || begin > end) continue;
    if (part.empty()) part.emplace_back(curve[n - 1] + piece * (begin / length));
    part.emplace_back(curve[n - 1] + piece * (end / length));
  }
  return part.empty() ? curve : part;
}

}  // namespace

std::vector<volume::TissueId> Workpiece::tissues(const std::string& structure) const {
  const scenario::Structure* found = lesson_.structure(structure);
  if (found == nullptr) return {};
  const std::vector<std::string_view> names(found->names.begin(), found->names.end());
  return metrics::tissues_named(before_.tissues(), names);
}

std::vector<volume::TissueId> Workpiece::glass() const {
  std::vector<volume::TissueId> all;
  for (const scenario::Structure& one : lesson_.structures)
    if (one.glass)
      for (const volume::TissueId id : tissues(one.name)) all.push_back(id);
  return all;
}

std::vector<Vec3> Workpiece::towards() const {
  return lesson_.approach.empty() ? std::vector<Vec3>{Vec3::UnitZ()} : lesson_.approach;
}

const metrics::VoxelSet& Workpiece::voxels(const std::string& structure) {
  const auto found = voxels_.find(structure);
  if (found != voxels_.end()) return found->second;
  return voxels_.emplace(structure, metrics::VoxelSet::of_tissues(before_, tissues(structure)))
      .first->second;
}

std::shared_ptr<const volume::DistanceTo> Workpiece::distance(const std::string& structure) {
  auto& kept = distances_[structure];
  if (!kept) kept = made_distance(tissues(structure), kReach);
  return kept;
}

std::shared_ptr<const volume::DistanceTo> Workpiece::distance_to_solid() {
  if (to_solid_) return to_solid_;
  std::vector<volume::TissueId> solid;
  const auto& all = before_.tissues().tissues;
  for (std::size_t id = 0; id < all.size(); ++id)
    if (all[id].kind == volume::TissueKind::solid)
      solid.push_back(static_cast<volume::TissueId>(id));
  to_solid_ = made_distance(solid, 4 * before_.grid().voxel);
  return to_solid_;
}

std::shared_ptr<const volume::DistanceTo> Workpiece::made_distance(
    const std::vector<volume::TissueId>& tissues, double reach) {
  volume::DistanceSettings settings;
  settings.reach = reach;
  settings.threads = kThreads;
  auto made = volume::DistanceTo::make(before_, tissues, settings, progress_);
  stopped_ = stopped_ || !made.ok();
  return std::make_shared<const volume::DistanceTo>(made.ok() ? std::move(*made)
                                                              : volume::DistanceTo());
}

Region Workpiece::region_of(const scenario::Shape& shape) {
  switch (shape.kind) {
    case ShapeKind::ball:
      return metrics::in_ball(shape.a.at, shape.radius);
    case ShapeKind::capsule:
      return metrics::in_capsule(shape.a.at, shape.b.at, shape.radius);
    case ShapeKind::box: {
      math::Pose world_from_box;
      world_from_box.p = shape.a.at;
      return metrics::in_box(world_from_box, 0.5 * shape.size);
    }
    case ShapeKind::half_space:
      return metrics::in_half_space(shape.a.at, -shape.normal);
    case ShapeKind::tube:
      return metrics::near_line(part_of(shape.points, shape.from, shape.to), shape.radius);
    case ShapeKind::within:
      return metrics::within(distance(shape.structure), shape.radius);
    case ShapeKind::between:
      return metrics::both(metrics::within(distance(shape.structure), shape.radius),
                           metrics::within(distance(shape.other), shape.radius));
  }
  return {};
}

Region Workpiece::region(const std::string& name) {
  if (name.empty()) return {};
  const scenario::CaseRegion* found = lesson_.region(name);
  BURR_CHECK(found != nullptr && !found->add.empty());
  Region all = region_of(found->add.front());
  for (std::size_t n = 1; n < found->add.size(); ++n)
    all = metrics::either(std::move(all), region_of(found->add[n]));
  for (const scenario::Shape& shape : found->take)
    all = metrics::without(std::move(all), region_of(shape));
  return all;
}

Region Workpiece::regions(const std::vector<std::string>& names) {
  Region all = region(names.front());
  for (std::size_t n = 1; n < names.size(); ++n)
    all = metrics::either(std::move(all), region(names[n]));
  return all;
}

const metrics::Assessed<metrics::Cover>& Workpiece::cover(const std::string& structure,
                                                          const std::string& region,
                                                          std::size_t most_samples, bool exposed) {
  const auto key = std::tuple(structure, region, most_samples, exposed);
  const auto found = covers_.find(key);
  if (found != covers_.end()) return found->second;
  metrics::CoverSettings settings;
  settings.towards = towards();
  settings.glass = glass();
  settings.most_samples = most_samples;
  settings.threads = kThreads;
  if (exposed && !open_)
    open_.emplace(before_, after_,
                  metrics::OpenCavitySettings{.glass = glass(), .threads = kThreads});
  if (exposed) settings.exposed = &*open_;
  return covers_
      .emplace(key, metrics::cover_of(before_, after_, voxels(structure), this->region(region),
                                      settings))
      .first->second;
}

const metrics::Assessed<metrics::Removed>& Workpiece::removed(const std::string& region) {
  const auto found = removed_.find(region);
  if (found != removed_.end()) return found->second;
  return removed_.emplace(region, metrics::removed_of(before_, after_, this->region(region), {}))
      .first->second;
}

const metrics::Assessed<metrics::AxisFit>& Workpiece::axis(const std::string& curve,
                                                           const std::string& region) {
  const auto key = std::pair(curve, region);
  const auto found = axes_.find(key);
  if (found != axes_.end()) return found->second;
  const std::vector<math::Vec3>& points = lesson_.landmark(curve)->points;
  const metrics::PlannedAxis plan = {points.front(),
                                     math::normalized(points.back() - points.front())};
  return axes_.emplace(key, metrics::axis_fit(before_, after_, plan, this->region(region)))
      .first->second;
}

const metrics::Assessed<metrics::PlaneFit>& Workpiece::cut_at(const std::string& plane,
                                                              const std::string& region) {
  const auto key = std::pair(plane, region);
  const auto found = planes_.find(key);
  if (found != planes_.end()) return found->second;
  const scenario::Landmark& planned = *lesson_.landmark(plane);
  return planes_
      .emplace(key, metrics::plane_fit(before_, after_, {planned.points.front(), *planned.normal},
                                       this->region(region), {}))
      .first->second;
}

const metrics::Assessed<metrics::CavityShape>& Workpiece::cavity(const std::string& region,
                                                                 const std::string& within) {
  const auto key = std::pair(region, within);
  const auto found = cavities_.find(key);
  if (found != cavities_.end()) return found->second;
  return cavities_
      .emplace(key, metrics::cavity_shape(before_, after_, towards().front(), this->region(within),
                                          this->region(region)))
      .first->second;
}

double Workpiece::worked() {
  if (worked_ >= 0) return worked_;
  std::vector<std::string> names;
  if (lesson_.reference) names = lesson_.reference->remove;
  if (names.empty())
    for (const scenario::Step& step : lesson_.steps)
      if (!step.region.empty() && !step.adds) names.push_back(step.region);
  worked_ = 0;
  if (names.empty()) return worked_;
  const auto gone = metrics::removed_of(before_, after_, regions(names), {});
  if (gone) worked_ = std::max(0.0, gone->share);
  return worked_;
}

}  // namespace burr::scoring
