#include "burr/scoring/step_target.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "burr/metrics/region.h"
#include "burr/scoring/plane_outline.h"
#include "burr/scoring/workpiece.h"
#include "burr/volume/sample.h"

namespace burr::scoring {
namespace {

using math::Ijk;
using math::Vec3;
using metrics::Region;
using volume::Bone;

constexpr std::size_t kMostRays = 4000;  // of the target's voxels

// The centres of the region's voxels that are inside the bone, or outside of it.
std::vector<Vec3> voxels_in(const Region& region, const Bone& bone, bool inside) {
  const double h = bone.grid().voxel;
  const double brick = 0.5 * volume::kBrickEdge * std::sqrt(3.0) * h;  // half a diagonal
  std::vector<Vec3> found;
  for (volume::BrickIndex b = 0; b < bone.brick_count(); ++b) {
    const volume::Field* field = bone.brick_field(b);
    if (inside && field == nullptr) continue;
    const Ijk first = bone.brick_ijk(b);
    const Vec3 middle = bone.grid().world_from_grid(first.cast<double>() + Vec3::Constant(3.5));
    if (metrics::depth_in(region, middle) < -brick) continue;
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const bool solid = field != nullptr && field[v] >= volume::kIso;
      const Ijk at = first + Ijk(v & 7, (v >> 3) & 7, v >> 6);
      if (solid != inside || !bone.grid().contains(at)) continue;
      const Vec3 p = bone.grid().world_from_grid(at.cast<double>());
      if (metrics::contains(region, p)) found.push_back(p);
    }
  }
  return found;
}

std::vector<Vec3> some_of(std::vector<Vec3> all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<Vec3> some;
  for (std::size_t n = 0; n < most; ++n) some.push_back(all[n * all.size() / most]);
  return some;
}

// Where the surface lies between a point inside and one outside.
Vec3 between(const Bone& bone, Vec3 in, Vec3 out) {
  for (int n = 0; n < 8; ++n) {
    const Vec3 middle = 0.5 * (in + out);
    (volume::depth_at(bone, middle) >= 0 ? in : out) = middle;
  }
  return in;
}

// Of the straight way out from p: the outermost surface. Of a space that is filled: its floor.
std::optional<Vec3> surface_over(const Bone& bone, const Vec3& p, const Vec3& out, bool space) {
  const double step = bone.grid().voxel;
  const Vec3 size = bone.grid().size.cast<double>() * step;
  const double far = size.norm();
  if (space) {
    for (double t = step; t < far; t += step)
      if (const Vec3 q = p - t * out; volume::depth_at(bone, q) >= 0)
        return between(bone, q, q + step * out);
    return std::nullopt;
  }
  double last = 0;
  for (double t = step; t < far; t += step)
    if (volume::depth_at(bone, p + t * out) >= 0) last = t;
  return between(bone, p + last * out, p + (last + step) * out);
}

// How far one of these tissues goes in from the surface.
double thickness_at(const Bone& bone, const Vec3& surface, const Vec3& in,
                    const std::vector<volume::TissueId>& tissues) {
  const double step = 0.5 * bone.grid().voxel;
  double thick = 0;
  for (double t = step; t < kMostPress; t += step) {
    const Vec3 p = surface + t * in;
    const Ijk at = bone.grid().grid_from_world(p).array().round().cast<int>();
    if (!bone.grid().contains(at) || volume::depth_at(bone, p) < 0) break;
    const volume::TissueId id = bone.tissue(at.x(), at.y(), at.z());
    if (std::find(tissues.begin(), tissues.end(), id) == tissues.end()) break;
    thick = t;
  }
  return thick;
}

double median(std::vector<double> all) {
  if (all.empty()) return 0;
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return *middle;
}

Vec3 way_out(const scenario::Step& step, const scenario::CaseLesson& lesson) {
  if (!step.approach.empty()) return step.approach.front().normalized();
  return lesson.approach.empty() ? Vec3::UnitZ() : Vec3(lesson.approach.front().normalized());
}

// All that must stay: what the step spares, and what the case wants intact.
std::set<std::string> to_spare(const scenario::Step& step, const scenario::CaseLesson& lesson) {
  std::set<std::string> names;
  for (const std::string& name : step.spare)
    if (lesson.structure(name) != nullptr) names.insert(name);
  for (const scenario::Structure& one : lesson.structures)
    if (!one.glass &&
        (one.intact == scenario::Intact::soft || one.intact == scenario::Intact::solid))
      names.insert(one.name);
  return names;
}

using Distances = std::vector<std::shared_ptr<const volume::DistanceTo>>;

// Whether a ball that is pressed in at a spot stays a voxel away from all of these, along the approach and along
// the surface's own normal: a mouse presses along that.
bool stays_away(const Bone& bone, const Vec3& spot, const Vec3& towards, double radius,
                double press, const Distances& distances) {
  const double keep = radius + bone.grid().voxel;
  const Vec3 normal = volume::normal(bone, bone.grid().grid_from_world(spot));
  for (const Vec3& out : {towards, normal.norm() > 0 ? normal : towards}) {
    const Vec3 centre = spot + (radius - press) * out;
    for (const auto& one : distances)
      if (one->at(centre).distance < keep) return false;
  }
  return true;
}

// The largest press at which the ball stays away at all spots.
double room_of(const StepTarget& target, const Bone& bone, double radius,
               const Distances& distances) {
  constexpr double kFine = 0.1e-3;
  double room = kMostPress;
  for (double before = 0;
       room > 0 && room != before;) {  // less at one spot may be wrong at another
    before = room;
    for (const Vec3& spot : target.surface)
      while (room > 0 && !stays_away(bone, spot, target.towards, radius, room, distances))
        room -= kFine;
  }
  return std::max(room, 0.0);
}

// A wall of what must be spared, or where it lies bare: no place for this burr, however little it is pressed.
void set_apart_too_near(StepTarget& target, const Bone& bone, double radius,
                        const Distances& distances) {
  const auto near =
      std::stable_partition(target.surface.begin(), target.surface.end(), [&](const Vec3& spot) {
        return stays_away(bone, spot, target.towards, radius, kLeastPress, distances);
      });
  target.too_near.assign(near, target.surface.end());
  if (!target.too_near.empty()) target.room = 0;
  if (near != target.surface.begin()) target.surface.erase(near, target.surface.end());
}

}  // namespace

bool is_cut(const scenario::CaseRegion& region) {
  const auto plane = [](const scenario::Shape& shape) {
    return shape.kind == scenario::ShapeKind::half_space;
  };
  return !region.add.empty() && !region.take.empty() &&
         std::all_of(region.add.begin(), region.add.end(), plane) &&
         std::all_of(region.take.begin(), region.take.end(), plane);
}

TargetFinder::TargetFinder(const Bone& before, const scenario::CaseLesson& lesson,
                           Progress& progress)
    : lesson_(lesson),
      progress_(progress),
      scene_(std::make_unique<Workpiece>(before, before, lesson, progress)) {}

TargetFinder::~TargetFinder() = default;

Result<StepTarget> TargetFinder::find(const scenario::Step& step, const Bone& now, double radius) {
  StepTarget out;
  out.towards = way_out(step, lesson_);
  const scenario::CaseRegion* region = lesson_.region(step.region);
  if (region == nullptr) return out;
  const Region where = scene_->region(step.region);
  const std::vector<Vec3> target = some_of(voxels_in(where, now, !step.adds), kMostRays);
  if (scene_->stopped() || progress_.cancelled()) return error(Trouble::interrupted, "stopped");
  for (const Vec3& p : target)
    if (const auto over = surface_over(now, p, out.towards, step.adds)) {
      out.surface.push_back(*over);
      out.deepest = std::max(out.deepest, std::abs((*over - p).dot(out.towards)));
    }
  out.found = !out.surface.empty();
  out.gone = !out.found;
  if (out.gone) return out;
  Distances distances;
  for (const std::string& name : to_spare(step, lesson_)) {
    distances.push_back(scene_->distance(name));
    if (scene_->stopped()) return error(Trouble::interrupted, "stopped");
  }
  out.surface = some_of(std::move(out.surface), kMostSurface);
  out.room = room_of(out, now, radius, distances);
  set_apart_too_near(out, now, radius, distances);

  Vec3 middle = Vec3::Zero();
  for (const Vec3& spot : out.surface) middle += spot / static_cast<double>(out.surface.size());
  const auto off = [&](const Vec3& from, const Vec3& p) {
    const Vec3 way = p - from;
    return (way - way.dot(out.towards) * out.towards).norm();
  };
  out.at = *std::min_element(out.surface.begin(), out.surface.end(), [&](auto& a, auto& b) {
    return (a - middle).norm() < (b - middle).norm();
  });
  for (const Vec3& spot : out.surface) out.radius = std::max(out.radius, off(out.at, spot));
  if (is_cut(*region)) out.outline = outline_of(*region, where, now);

  if (const scenario::Structure* own = lesson_.structure(step.structure)) {
    std::vector<double> thick;
    for (const Vec3& spot : out.surface)
      if (const double t = thickness_at(now, spot, -out.towards, scene_->tissues(own->name)); t > 0)
        thick.push_back(t);
    // caries breaks through the enamel of the tooth's fissure at half of the spots
    if (4 * thick.size() >= out.surface.size()) out.thickness = median(std::move(thick));
  }
  for (const std::string& name : step.spare) {
    if (const scenario::CaseRegion* kept = lesson_.region(name);
        kept != nullptr && lesson_.structure(name) == nullptr) {
      out.spared.push_back({name, kept->add.front().a.at});
      continue;
    }
    double least = std::numeric_limits<double>::infinity();
    Vec3 nearest = Vec3::Zero();
    scene_->voxels(name).for_each([&](const Ijk& v) {
      const Vec3 p = now.grid().world_from_grid(v.cast<double>());
      if (const double far = (p - out.at).squaredNorm(); far < least) {
        least = far;
        nearest = p;
      }
    });
    if (std::isfinite(least)) out.spared.push_back({name, nearest});
  }
  return out;
}

}  // namespace burr::scoring
