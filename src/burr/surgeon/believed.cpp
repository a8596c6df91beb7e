#include "burr/surgeon/believed.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "burr/people/random_stream.h"

namespace burr::surgeon {
namespace {

using math::Vec3;
using scenario::Shape;
using scenario::ShapeKind;

constexpr double kReach = 12e-3;              // of distances [m]
constexpr std::size_t kMostKept = 2'500'000;  // of a distance's voxels; the rest is interpolated
constexpr std::uint64_t kErrorStream = 2;     // of random numbers, for structures
constexpr std::uint64_t kPlanStream = 4;      // and for regions

double to_line(const std::vector<Vec3>& line, double from, double to, const Vec3& p) {
  double all = 0;
  for (std::size_t n = 1; n < line.size(); ++n) all += (line[n] - line[n - 1]).norm();
  double nearest = std::numeric_limits<double>::infinity(), at = 0;
  for (std::size_t n = 1; n < line.size(); ++n) {
    const Vec3 piece = line[n] - line[n - 1];
    const double length = piece.norm();
    const double low = std::max(from * all - at, 0.0), high = std::min(to * all - at, length);
    at += length;
    if (length <= 0 || low > high) continue;
    const double along = std::clamp((p - line[n - 1]).dot(piece) / length, low, high);
    nearest = std::min(nearest, (p - line[n - 1] - piece * (along / length)).norm());
  }
  return nearest;
}

std::vector<volume::TissueId> tissues_in(const scenario::Structure& structure,
                                         const volume::TissueTable& table) {
  std::vector<volume::TissueId> ids;
  for (std::size_t id = 1; id < table.tissues.size(); ++id)
    if (std::find(structure.names.begin(), structure.names.end(), table.tissues[id].name) !=
        structure.names.end())
      ids.push_back(static_cast<volume::TissueId>(id));
  return ids;
}

// names of all structures that matter to a surgeon
std::set<std::string> needed(const scenario::CaseLesson& lesson) {
  std::set<std::string> names;
  for (const scenario::Structure* one : spared_of(lesson)) names.insert(one->name);
  for (const scenario::CaseRegion& region : lesson.regions)
    for (const auto* shapes : {&region.add, &region.take})
      for (const Shape& shape : *shapes) {
        if (!shape.structure.empty()) names.insert(shape.structure);
        if (!shape.other.empty()) names.insert(shape.other);
      }
  return names;
}

}  // namespace

std::vector<const scenario::Structure*> spared_of(const scenario::CaseLesson& lesson) {
  std::vector<const scenario::Structure*> spared;
  for (const scenario::Structure& one : lesson.structures)
    if (!one.glass &&
        (one.intact == scenario::Intact::solid || one.intact == scenario::Intact::soft))
      spared.push_back(&one);
  return spared;
}

Result<Believed> Believed::make(const volume::Bone& bone, const scenario::CaseLesson& lesson,
                                double rms, std::uint64_t seed, Progress& progress) {
  Believed out;
  people::RandomStream random(seed, kErrorStream);
  const std::set<std::string> names = needed(lesson);
  for (const scenario::Structure& one : lesson.structures) {
    // drawn for every structure, so that one more that matters changes no other
    const double x = random.normal(), y = random.normal(), z = random.normal();
    if (names.count(one.name) == 0) continue;
    const std::vector<volume::TissueId> ids = tissues_in(one, bone.tissues());
    if (ids.empty()) continue;
    volume::DistanceSettings settings;
    settings.reach = kReach;
    settings.most_kept = kMostKept;
    auto made = volume::DistanceTo::make(bone, ids, settings, progress);
    if (!made) return made.error();
    out.seen_[one.name] = {std::move(*made), rms * Vec3(x, y, z)};
  }
  people::RandomStream plan(seed, kPlanStream);
  for (const scenario::CaseRegion& region : lesson.regions) {
    PlanError& error = out.plan_[region.name];
    for (Vec3* end : {&error.first, &error.last})
      for (int axis = 0; axis < 3; ++axis) (*end)[axis] = rms * plan.normal();
  }
  return out;
}

double Believed::distance(const std::string& structure, const Vec3& p) const {
  const auto found = seen_.find(structure);
  return found == seen_.end() ? std::numeric_limits<double>::infinity()
                              : found->second.distance.at(p - found->second.error).distance;
}

Vec3 Believed::error_of(const std::string& structure) const {
  const auto found = seen_.find(structure);
  return found == seen_.end() ? Vec3(Vec3::Zero()) : found->second.error;
}

bool Believed::known(const std::string& structure) const { return seen_.count(structure) > 0; }

Believed::PlanError Believed::plan_error_of(const std::string& region) const {
  const auto found = plan_.find(region);
  return found == plan_.end() ? PlanError{} : found->second;
}

Shape Believed::moved(Shape shape, const PlanError& error) {
  shape.a.at += error.first;
  shape.b.at += error.last;
  double all = 0, at = 0;
  for (std::size_t n = 1; n < shape.points.size(); ++n)
    all += (shape.points[n] - shape.points[n - 1]).norm();
  Vec3 before = shape.points.empty() ? Vec3(Vec3::Zero()) : shape.points.front();
  for (Vec3& point : shape.points) {
    at += (point - before).norm();
    before = point;
    point += error.first + (all > 0 ? at / all : 0) * (error.last - error.first);
  }
  return shape;
}

double Believed::depth_in(const Shape& shape, const Vec3& p) const {
  switch (shape.kind) {
    case ShapeKind::ball:
      return shape.radius - (p - shape.a.at).norm();
    case ShapeKind::capsule:
      return shape.radius - to_line({shape.a.at, shape.b.at}, 0, 1, p);
    case ShapeKind::box: {
      const Vec3 out = (p - shape.a.at).cwiseAbs() - 0.5 * shape.size;
      return out.maxCoeff() <= 0 ? -out.maxCoeff() : -out.cwiseMax(0.0).norm();
    }
    case ShapeKind::half_space:
      return (p - shape.a.at).dot(shape.normal);
    case ShapeKind::tube:
      return shape.radius - to_line(shape.points, shape.from, shape.to, p);
    case ShapeKind::within:
      return shape.radius - distance(shape.structure, p);
    case ShapeKind::between:
      return shape.radius - std::max(distance(shape.structure, p), distance(shape.other, p));
  }
  return 0;
}

Believed::Depth Believed::region(const scenario::CaseRegion& region) const {
  const PlanError error = plan_error_of(region.name);
  scenario::CaseRegion seen = region;
  for (auto* shapes : {&seen.add, &seen.take})
    for (Shape& shape : *shapes) shape = moved(std::move(shape), error);
  return [this, seen = std::move(seen)](const Vec3& p) {
    double depth = -std::numeric_limits<double>::infinity();
    for (const Shape& shape : seen.add) depth = std::max(depth, depth_in(shape, p));
    for (const Shape& shape : seen.take) depth = std::min(depth, -depth_in(shape, p));
    return depth;
  };
}

}  // namespace burr::surgeon
