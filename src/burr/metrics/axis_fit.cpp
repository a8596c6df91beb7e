#include "burr/metrics/axis_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/metrics/corridor_width.h"
#include "burr/metrics/line_and_plane.h"
#include "burr/metrics/main_cut.h"
#include "burr/metrics/same_math.h"
#include "burr/metrics/solidity.h"
#include "burr/volume/sample.h"

namespace burr::metrics {
namespace {

constexpr double kShortest = 1.5;  // corridor that has a direction, in its diameters
constexpr double kNothing = -1e9;  // of a reach [m]
constexpr double kSliver = 0.1;    // a smaller part of a voxel has no border

using math::Vec3;
using volume::Bone;

// Directions across the axis in which a slice is measured.
constexpr std::size_t kAround = 16;
using Around = std::array<Vec3, kAround>;

// The middle of a slice is that of its outline: how far it reaches in each direction, times the direction,
// is averaged (the Steiner point of its hull). The centre of what was removed would lean away from
// the pores of spongy bone, by half a millimetre in a corridor of 5 mm.
struct Slice {
  Vec3 sum = Vec3::Zero();  // place times volume
  double volume = 0;        // [voxel]
  // squares of the place about the plan's entry times volume: xx, yy, zz, xy, xz, yz  [m^2 voxel]
  std::array<double, 6> squares = {};
  // how far it goes in each direction from the plan's entry [m]
  std::array<double, kAround> reach;

  Slice() { reach.fill(kNothing); }

  // h: a voxel's edge; of one that is partly gone, the border lies inside [m]
  void add(const Vec3& place, const Vec3& from_entry, double share, double h,
           const Around& around) {
    const double x = from_entry.x(), y = from_entry.y(), z = from_entry.z();
    sum += share * place;
    volume += share;
    const std::array<double, 6> now = {x * x, y * y, z * z, x * y, x * z, y * z};
    for (std::size_t n = 0; n < now.size(); ++n) squares[n] += share * now[n];
    if (share < kSliver) return;
    for (std::size_t n = 0; n < kAround; ++n)
      reach[n] = std::max(reach[n], math::dot(from_entry, around[n]) + (share - 0.5) * h);
  }
  // along: unit, the planned axis
  [[nodiscard]] Vec3 middle(const Vec3& entry, const Vec3& along, const Around& around) const {
    const Vec3 centre = sum / volume;
    if (reach.front() == kNothing) return centre;
    Vec3 out = entry + math::dot(centre - entry, along) * along;
    for (std::size_t n = 0; n < kAround; ++n)
      out += 2.0 / static_cast<double>(kAround) * reach[n] * around[n];
    return out;
  }
  // Mean square of the distance to the line through the slice's centre along w (unit) [m^2].
  [[nodiscard]] double square_about(const Vec3& entry, const Vec3& w) const {
    const Vec3 c = sum / volume - entry;
    const double xx = squares[0] / volume - c.x() * c.x(), yy = squares[1] / volume - c.y() * c.y(),
                 zz = squares[2] / volume - c.z() * c.z(), xy = squares[3] / volume - c.x() * c.y(),
                 xz = squares[4] / volume - c.x() * c.z(), yz = squares[5] / volume - c.y() * c.z();
    const double along = w.x() * w.x() * xx + w.y() * w.y() * yy + w.z() * w.z() * zz +
                         2 * (w.x() * w.y() * xy + w.x() * w.z() * xz + w.y() * w.z() * yz);
    return xx + yy + zz - along;
  }
  // Diameter of a disc with that mean square, which is r^2 / 2 [m].
  [[nodiscard]] double width(const Vec3& entry, const Vec3& w) const {
    return 2 * std::sqrt(std::max(0.0, 2 * square_about(entry, w)));
  }
};

std::map<int, Slice> slices_of(const MainCut& cut, const PlannedAxis& plan, const Vec3& along,
                               const Around& around, double thick, double h) {
  std::map<int, Slice> slices;
  for (const Gone& one : cut.gone) {
    const Vec3 from_entry = one.place - plan.entry;
    const double t = math::dot(from_entry, along);
    slices[static_cast<int>(std::floor(t / thick))].add(one.place, from_entry, one.share, h,
                                                        around);
  }
  return slices;
}

// Where a depth that was `before` at one end of a step and is `after` at the other passes 0, as a
// share of the step.
double crossing(double before, double after) { return before / (before - after); }

// Along a line, in steps of a quarter of a voxel.
struct AlongAxis {
  const Bone &before, &after;
  Vec3 from, w;
  double step;  // [m]

  [[nodiscard]] Vec3 at(double l) const { return from + l * w; }
  [[nodiscard]] double was(double l) const { return volume::depth_at(before, at(l)); }
  [[nodiscard]] double is(double l) const { return volume::depth_at(after, at(l)); }
  [[nodiscard]] bool removed(double l) const { return was(l) >= 0 && is(l) < 0; }

  // The last place before the first removed material where the line came from air into bone.
  [[nodiscard]] std::optional<double> entry(double reach) const {
    std::optional<double> found;
    double last = was(0);
    for (double l = step; l <= reach; l += step) {
      const double now = was(l);
      if (last < 0 && now >= 0) found = l - step + crossing(last, now) * step;
      if (removed(l)) return found;  // none: this bone goes on to the place where the search begins
      last = now;
    }
    return std::nullopt;
  }

  struct End {
    double l = 0;
    bool through = false;
  };
  // How far what was removed goes on from the entry.
  [[nodiscard]] End end(double entry, double reach) const {
    End found{entry, false};
    bool any = false;
    for (double l = entry + step; l <= entry + reach; l += step) {
      if (removed(l)) {
        found = {l, false};
        any = true;
      } else if (is(l) >= 0 && any) {
        // a bone that stands; behind an old air space it is not what ended the corridor
        if (found.through) return found;
        return {l - step + crossing(is(l - step), is(l)) * step, false};
      } else if (was(l) < 0 && any && !found.through) {
        found = {l - step + crossing(was(l - step), was(l)) * step, true};
      }
    }
    return found;
  }
};

// Those with at least half of the median width, and a tenth of the median volume: the bone that was
// removed from a slice may be dense or spongy, but the ends of a corridor are narrow.
std::map<int, const Slice*> slices_that_count(const std::map<int, Slice>& slices, const Vec3& entry,
                                              const Vec3& along) {
  std::vector<std::pair<double, double>> volumes, widths;  // weighted by volume
  for (const auto& [number, slice] : slices) {
    volumes.emplace_back(slice.volume, slice.volume);
    widths.emplace_back(slice.width(entry, along), slice.volume);
  }
  std::map<int, const Slice*> counted;
  if (volumes.empty()) return counted;
  const double volume = weighted_quantile(std::move(volumes), 0.5),
               width = weighted_quantile(std::move(widths), 0.5);
  for (const auto& [number, slice] : slices)
    if (slice.volume >= 0.1 * volume && slice.width(entry, along) >= 0.5 * width)
      counted.emplace(number, &slice);
  return counted;
}

// Directions round a circle.
constexpr double kHalfRoot = 0.70710678118654752;
constexpr double kRound[8][2] = {
    {1, 0},  {kHalfRoot, kHalfRoot},   {0, 1},  {-kHalfRoot, kHalfRoot},
    {-1, 0}, {-kHalfRoot, -kHalfRoot}, {0, -1}, {kHalfRoot, -kHalfRoot}};

// Of the lines beside the axis that look for the corridor's end, in its widths. A strut of spongy bone is seldom met: with one
// ring of eight, a corridor in a vertebra read 3.5 mm too short.
constexpr double kRings[] = {0.125, 0.25, 0.375};
constexpr std::size_t kEnough = 3;

// Square to w, not unit.
Vec3 any_across(const Vec3& w) {
  return std::abs(w.x()) < 0.6 ? w.cross(Vec3::UnitX()) : w.cross(Vec3::UnitY());
}

// Unit, square to w (unit): those of kRound and those half-way between.
Around around(const Vec3& w) {
  constexpr double kSmall = 0.38268343236508977, kLarge = 0.92387953251128674;  // of 22.5 degrees
  const Vec3 u = math::normalized(any_across(w)), v = w.cross(u);
  Around out;
  for (std::size_t n = 0; n < 8; ++n) {
    const double x = kRound[n][0], y = kRound[n][1];
    out[2 * n] = x * u + y * v;
    out[2 * n + 1] = (kLarge * x - kSmall * y) * u + (kSmall * x + kLarge * y) * v;
  }
  return out;
}

// A pore of spongy bone at the end looks like the far side; lines beside the axis meet other pores. The median of the axis and of the
// innermost lines that end in bone, kEnough or more: beside a strut one line ends up to 0.7 voxel late. None: `end`.
AlongAxis::End end_beside(const AlongAxis& axis, double width, double entry, double reach,
                          const AlongAxis::End& end) {
  const Vec3 u = math::normalized(any_across(axis.w)), v = axis.w.cross(u);
  const double voxel = 4 * axis.step;
  std::vector<double> ends;
  if (!end.through) ends.push_back(end.l);
  for (std::size_t ring = 0; ring < std::size(kRings) && ends.size() < kEnough; ++ring)
    for (const auto& [x, y] : kRound) {
      AlongAxis beside = axis;
      beside.from += kRings[ring] * width * (x * u + y * v);
      const AlongAxis::End other = beside.end(entry, reach);
      const bool near = end.through ? other.l > end.l : std::abs(other.l - end.l) < voxel;
      if (!other.through && near) ends.push_back(other.l);
    }
  if (ends.empty()) return end;
  std::sort(ends.begin(), ends.end());
  return {0.5 * (ends[(ends.size() - 1) / 2] + ends[ends.size() / 2]), false};
}

// Where no wall stands, the slices themselves say how wide they are.
double width_of(const Bone& before, const MainCut& cut, const CorridorAxis& axis,
                const std::map<int, const Slice*>& counted, const Vec3& entry,
                const Region& region) {
  if (const auto width = corridor_width(before, cut, axis, region)) return *width;
  std::vector<std::pair<double, double>> widths;
  for (const auto& [number, slice] : counted)
    widths.emplace_back(slice->width(entry, axis.along), 1);
  return weighted_quantile(std::move(widths), 0.5);
}

}  // namespace

Assessed<AxisFit> axis_fit(const Bone& before, const Bone& after, const PlannedAxis& plan,
                           const Region& region) {
  BURR_CHECK(same_grid(before, after));
  const double h = before.grid().voxel;
  const double thick = h * std::ceil(0.5e-3 / h - 1e-6);  // whole voxels, so that none counts twice
  const Vec3 along = math::normalized(plan.inward);
  const Around directions = around(along);
  const MainCut cut = main_cut(before, after, region);
  const std::map<int, Slice> slices = slices_of(cut, plan, along, directions, thick, h);
  const std::map<int, const Slice*> counted = slices_that_count(slices, plan.entry, along);
  if (counted.size() < 3) return NotAssessable{"nothing was drilled along the planned axis"};
  std::vector<WeightedPoint> centres;
  for (const auto& [number, slice] : counted)
    centres.push_back({slice->middle(plan.entry, along, directions), 1});

  const LineThrough line = robust_line(centres, plan.entry, along);
  AxisFit out;
  out.inward = math::normalized(line.slope);
  out.angle = angle_between(out.inward, along);
  out.width = width_of(before, cut,
                       {line.at_zero, out.inward,
                        [&](const Vec3& place) {
                          const double t = math::dot(place - plan.entry, along);
                          return counted.contains(static_cast<int>(std::floor(t / thick)));
                        }},
                       counted, plan.entry, region);
  const double length = static_cast<double>(centres.size()) * thick;
  if (length < kShortest * out.width)
    return NotAssessable{
        "the drilled corridor is shorter than one and a half of its diameters, so it has no "
        "certain direction",
        true};
  const double far = 10e-3;
  const AlongAxis axis{before, after, line.at_zero - far * line.slope, out.inward, 0.25 * h};
  const auto entry = axis.entry(2 * far);
  if (!entry)
    return NotAssessable{
        "the drilled corridor's axis does not lead from outside into the bone within 10 mm of the "
        "planned entry"};
  out.entry = axis.at(*entry);
  const Vec3 off = out.entry - plan.entry;
  out.entry_off = math::norm(off - math::dot(off, along) * along);
  AlongAxis::End end = axis.end(*entry, length + far);
  end = end_beside(axis, out.width, *entry, length + far, end);
  out.through = end.through;
  out.apex = axis.at(end.l);
  out.depth = (end.l - *entry) * math::dot(out.inward, along);
  out.reach = math::dot(out.apex - plan.entry, along);
  out.error = 0.25 * h;
  for (const WeightedPoint& one : centres) out.centres.push_back(one.place);
  return out;
}

}  // namespace burr::metrics
