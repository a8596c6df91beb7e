#include "burr/surgeon/plane_cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "burr/base/printable.h"

namespace burr::surgeon {
namespace {

using device::HandPath;
using math::Vec3;
using tool::Drive;

constexpr double kParallel = 0.9998;  // cosine of about a degree
constexpr double kAbove = 5e-3;       // the hand begins so far above the bone             [m]
constexpr double kOver = 1e-3;        // the blade reaches so far over the bone's edge     [m]
constexpr double kThrough = 0.25e-3;  // and the teeth so far beyond the bone              [m]
constexpr double kOverlap = 2e-3;     // of two plunges beside each other                  [m]
constexpr double kLayer = 0.5e-3;     // of strokes to and fro                             [m]
constexpr double kWay = 0.8;          // to the bone, and from one place to the next       [s]
constexpr double kWaits = 0.2;        // share of the time in which the hand waits at the end
constexpr double kLeast = 10, kMost = 36'000;  // [s]

// Where the plane meets bone, along `along` and `out` from plane.at.
struct Section {
  double low = std::numeric_limits<double>::infinity(), high = -low;  // along
  double floor = std::numeric_limits<double>::infinity(), top = -floor;
};

// use(from plane.at, in voxels), for each voxel inside the bone at most `within` voxels off the plane.
template <class Use>
void each_voxel_near(const volume::Bone& bone, const CutPlane& plane, double within,
                     const Use& use) {
  const volume::Grid& grid = bone.grid();
  const Vec3 at = grid.grid_from_world(plane.at);
  const Vec3 normal = grid.frame.q.conjugate() * plane.normal;
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const volume::Field* const field = bone.brick_field(brick);
    if (field == nullptr) continue;
    const math::Ijk first = bone.brick_ijk(brick);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      if (field[v] < volume::kIso) continue;
      const Vec3 p = (first + math::Ijk(v & 7, v >> 3 & 7, v >> 6)).cast<double>() - at;
      if (std::abs(p.dot(normal)) <= within) use(p);
    }
  }
}

Section section_of(const volume::Bone& bone, const CutPlane& plane, const Vec3& along) {
  const volume::Grid& grid = bone.grid();
  const math::Quat to_grid = grid.frame.q.conjugate();
  const Vec3 side = to_grid * along, out = to_grid * plane.out;
  Section found;
  each_voxel_near(bone, plane, 1, [&](const Vec3& p) {
    found.low = std::min(found.low, p.dot(side) * grid.voxel);
    found.high = std::max(found.high, p.dot(side) * grid.voxel);
    found.floor = std::min(found.floor, p.dot(out) * grid.voxel);
    found.top = std::max(found.top, p.dot(out) * grid.voxel);
  });
  return found;
}

math::Quat axes(const Vec3& x, const Vec3& z) {
  math::Mat3 turn;
  turn.col(0) = x;
  turn.col(1) = z.cross(x);
  turn.col(2) = z;
  return math::Quat(turn).normalized();
}

std::string step_ids(const scenario::CaseLesson& lesson) {
  std::vector<std::string> ids;
  for (const scenario::Step& step : lesson.steps) ids.push_back(step.id);
  return fmt::format("{}", fmt::join(ids, ", "));
}

}  // namespace

Result<CutPlane> plane_of(const scenario::CaseLesson& lesson, std::string_view id) {
  const scenario::Step* const step = lesson.step(id);
  if (step == nullptr)
    return error(Trouble::usage,
                 fmt::format("`motion` step:{}: the case has no such step; its steps are {}",
                             base::printable(std::string(id)), step_ids(lesson)));
  const scenario::CaseRegion* const region = lesson.region(step->region);
  const bool slab = region != nullptr && region->add.size() == 1 && region->take.size() == 1 &&
                    region->add[0].kind == scenario::ShapeKind::half_space &&
                    region->take[0].kind == scenario::ShapeKind::half_space &&
                    region->add[0].normal.dot(region->take[0].normal) > kParallel;
  if (!slab)
    return error(Trouble::usage,
                 fmt::format("`motion` step:{}: the region of this step does not lie "
                             "between two parallel planes, so there is no plane to "
                             "cut along; use `path`",
                             id));
  CutPlane plane;
  plane.normal = region->add[0].normal;
  const Vec3 across = region->take[0].a.at - region->add[0].a.at;
  plane.at = region->add[0].a.at + 0.5 * across.dot(plane.normal) * plane.normal;
  const std::vector<Vec3>& ways = step->approach.empty() ? lesson.approach : step->approach;
  const Vec3 way = ways.empty() ? Vec3::UnitZ() : ways.front();
  const Vec3 out = way - way.dot(plane.normal) * plane.normal;
  if (out.norm() < 0.5)
    return error(
        Trouble::usage,
        fmt::format("`motion` step:{}: the approach of this step runs across its plane; give "
                    "a direction within the plane, or use `path`",
                    id));
  plane.out = out.normalized();
  return plane;
}

Blade blade_of(const tool::Tool& tool, const tool::Cutter& cutter, double lean) {
  Blade blade;
  blade.lies = lean > 0.25 * M_PI;
  blade.plunges = cutter.drive == Drive::oscillating || cutter.drive == Drive::reciprocating;
  const Vec3 side = blade.lies ? Vec3::UnitZ() : Vec3::UnitX();
  const Vec3 ahead = blade.lies ? Vec3(-Vec3::UnitX()) : Vec3(-Vec3::UnitZ());
  double low = 0, high = 0;
  for (int n = 0; n < tool.count; ++n) {
    const tool::Part& part = tool.parts[static_cast<std::size_t>(n)];
    if (part.role != tool::Role::cuts) continue;
    const math::Quat in_part = part.tool_from_part.q.conjugate();
    const Vec3& middle = part.tool_from_part.p;
    high = std::max(high, middle.dot(side) + tool::support(part.shape, in_part * side));
    low = std::min(low, middle.dot(side) - tool::support(part.shape, in_part * -side));
    blade.beyond =
        std::max(blade.beyond, middle.dot(ahead) + tool::support(part.shape, in_part * ahead));
  }
  blade.width = high - low;
  return blade;
}

Blade round_blade(double burr_radius) {
  return {.width = 2 * burr_radius, .beyond = burr_radius, .lies = false, .plunges = false};
}

Result<HandPath> cut_along(const volume::Bone& bone, const CutPlane& plane, const Blade& blade,
                           double seconds) {
  if (!(seconds >= kLeast) || seconds > kMost)
    return error(Trouble::usage, fmt::format("`seconds` {}: a cut along a plane takes {} to {} s",
                                             seconds, kLeast, kMost));
  Vec3 along = plane.normal.cross(plane.out);
  if (along.z() < 0) along = -along;  // a handle that lies points upwards
  const Section section = section_of(bone, plane, along);
  if (section.high < section.low)
    return error("the plane of this step meets no bone; check the bone and the case's landmarks");
  const math::Quat held = blade.lies ? axes(plane.out, along) : axes(along, plane.out);

  // of the tool's origin
  const double top = section.top + blade.beyond, floor = section.floor - kThrough + blade.beyond;
  const double middle = 0.5 * (section.low + section.high);
  const double reach =
      std::max(0.0, 0.5 * (section.high - section.low + 2 * kOver - blade.width));  // to both sides
  HandPath path;
  double t = 0;
  const auto go = [&](double after, double side, double depth, double pedal) {
    t += path.points.empty() ? 0 : after;
    path.points.push_back({t, {plane.at + side * along + depth * plane.out, held}, pedal});
  };
  if (blade.plunges) {
    const double stride = std::max(0.5 * blade.width, blade.width - kOverlap);
    const int places = 1 + static_cast<int>(std::ceil(2 * reach / stride - 1e-9));
    const double each = seconds / places - 3 * kWay;
    if (!(each > 0))
      return error(
          Trouble::usage,
          fmt::format("`seconds` {}: this blade goes in at {} places; give more than {:.0f}",
                      seconds, places, std::ceil(3 * kWay * places)));
    for (int n = 0; n < places; ++n) {
      const double side = places > 1 ? middle - reach + 2 * reach * n / (places - 1) : middle;
      go(kWay, side, top + kAbove, 1);
      go(kWay, side, top, 1);
      go((1 - kWaits) * each, side, floor, 1);
      go(kWaits * each, side, floor, 1);
      go(kWay, side, top + kAbove, 1);
    }
  } else {
    const int layers = std::max(1, static_cast<int>(std::ceil((top - floor) / kLayer)));
    // the last passes wait for the burr, which lags behind the hand
    const int more = static_cast<int>(std::ceil(kWaits * layers));
    const double each = (seconds - 3 * kWay) / (layers + more);
    double side = middle - reach;
    go(0, side, top + kAbove, 1);
    go(kWay, side, top, 1);
    for (int n = 1; n <= layers + more; ++n) {
      const double depth = std::max(floor, top - kLayer * n);
      go(0.1 * each, side, depth, 1);
      side = 2 * middle - side;
      go(0.9 * each, side, depth, 1);
    }
    go(kWay, side, top + kAbove, 1);
  }
  go(kWay, middle, top + 2 * kAbove, 0);
  return path;
}

double bone_in_plane(const volume::Bone& bone, const CutPlane& plane) {
  const Vec3 normal = bone.grid().frame.q.conjugate() * plane.normal;
  double voxels = 0;  // of a sheet one voxel thick: its upper side belongs to the next one
  each_voxel_near(bone, plane, 0.5, [&](const Vec3& p) {
    if (p.dot(normal) < 0.5) ++voxels;
  });
  return voxels * bone.grid().voxel * bone.grid().voxel;
}

double seconds_needed(double seconds, double left) {
  constexpr double kMore = 1.2, kMinute = 60;
  const double cut = std::max(1 - left, seconds * kMore / kMost);
  return std::min(kMost, kMinute * std::ceil(kMore * seconds / cut / kMinute));
}

}  // namespace burr::surgeon
