#include <fmt/core.h>

#include <cmath>
#include <string_view>

#include "burr/math/sums.h"
#include "burr/metrics/breach.h"
#include "burr/metrics/divided.h"
#include "burr/metrics/new_surface.h"
#include "burr/metrics/same_math.h"
#include "burr/scoring/measure.h"

namespace burr::scoring {
namespace {

// A region round a planned corridor is several times as wide as the corridor.
constexpr double kLeastShape = 0.02;  // share of the region

// Where next to nothing was removed there is no shape to measure; that is unmet, so that idle work does
// not lose items from the denominator.
std::optional<Outcome> idle(const Item& item, Workpiece& scene) {
  const auto& gone = scene.removed(item.region);
  if (!gone) return not_assessable(item, gone.reason());
  if (gone->share >= kLeastShape) return {};
  Outcome out;
  out.id = item.id;
  out.verdict = Verdict::unmet;
  out.quantity = item.how->quantity;
  out.earned = false;
  out.reason = fmt::format(
      "only {:.1f} % of the bone in its region was removed, so there is no shape to measure",
      100 * gone->share);
  return out;
}

Outcome at_most(const Item& item, double value, double most, double error, const char* what) {
  return decided(item, {value <= most, true, value, most, error}, what, false);
}

// There is no shape, and that is the work's doing: a bone in which something was cut has one, where it was cut as
// planned. So the items stay in the denominator: too early to say where too little was done, otherwise not met.
template <class Shape>
Outcome without(const Item& item, const metrics::Assessed<Shape>& shape) {
  Outcome none = not_assessable(item, shape.reason());
  none.verdict = Verdict::unmet;
  none.earned = !shape.too_little_done();
  return none;
}

Outcome axis(const Item& item, Workpiece& scene) {
  const std::vector<math::Vec3>& course = scene.lesson().landmark(item.along)->points;
  const math::Vec3 whole = course.back() - course.front();
  const math::Vec3 inward = math::normalized(whole);
  const auto& fit = scene.axis(item.along, item.region);
  if (!fit) return without(item, fit);
  const std::string_view how = item.how->name;
  const double h = scene.before().grid().voxel;
  Outcome out;
  if (how == "axis_entry") {
    out = at_most(item, fit->entry_off, item.limit("most_mm"), fit->error,
                  "distance of the entry from the planned one");
    out.place = fit->entry;
  } else if (how == "axis_apex") {
    // across the planned axis; how deep it goes is another item
    const math::Vec3 off = fit->apex - course.front();
    out = at_most(item, (off - off.dot(inward) * inward).norm(), item.limit("most_mm"), 0.5 * h,
                  "distance of the end from the planned axis");
    out.place = fit->apex;
  } else if (how == "axis_angle") {
    // each end of the axis is known to the error of the entry
    out = at_most(item, fit->angle, item.limit("most_deg"), 2 * fit->error / fit->depth,
                  "angle to the planned axis");
    out.place = fit->apex;
  } else if (how == "axis_tilt") {
    // both as they are seen along the plane's normal
    const math::Vec3 normal = *scene.lesson().landmark(item.plane)->normal;
    const auto seen = [&normal](const math::Vec3& w) {
      return math::Vec3(w - math::dot(w, normal) * normal);
    };
    constexpr double kShortest = 0.2;  // of what is seen of an axis of length 1
    if (math::norm(seen(inward)) < kShortest || math::norm(seen(fit->inward)) < kShortest)
      return not_assessable(item, "the axis is nearly square to the plane");
    out = at_most(item, metrics::angle_between(seen(fit->inward), seen(inward)),
                  item.limit("most_deg"), 2 * fit->error / fit->depth,
                  "angle to the planned axis, seen across the plane");
    out.place = fit->apex;
  } else if (how == "axis_breach") {
    // the screw goes as far as planned, whether or not the corridor does
    const double length = whole.norm();
    const metrics::Breach worst = metrics::breach(
        scene.before(), scene.glass(), fit->entry + item.limit("from_share") * length * fit->inward,
        fit->entry + item.limit("to_share") * length * fit->inward, item.limit("screw_mm"));
    out = at_most(item, worst.out, item.limit("most_mm"), 0.5 * h,
                  worst.out > 0 ? "a screw would stick out by" : "bone beside a screw (below 0)");
    out.place = worst.at;
  } else if (how == "axis_depth") {
    out = at_most(item, std::abs(fit->reach - whole.norm()), item.limit("off_mm"), 0.5 * h,
                  fit->reach > whole.norm() ? "too deep by" : "not deep enough by");
    out.place = fit->apex;
  } else {
    out = at_most(item, std::abs(fit->width - item.limit("width_mm")), item.limit("off_mm"),
                  0.5 * h, fit->width > item.limit("width_mm") ? "too wide by" : "too narrow by");
    out.place = fit->centres.empty() ? fit->entry : fit->centres[fit->centres.size() / 2];
  }
  return out;
}

Outcome plane(const Item& item, Workpiece& scene) {
  const auto& fit = scene.cut_at(item.plane, item.region);
  if (!fit) return without(item, fit);
  const std::string_view how = item.how->name;
  Outcome out;
  if (how == "plane_offset")
    out = at_most(item, std::abs(fit->offset), item.limit("most_mm"), fit->error,
                  "distance from the planned plane");
  else if (how == "plane_angle")
    out = at_most(item, fit->angle, item.limit("most_deg"), 2 * fit->error / std::sqrt(fit->area),
                  "angle to the planned plane");
  else
    out = at_most(item, fit->uneven, item.limit("most_mm"), fit->error,
                  "distance of the face from its own plane (95 %)");
  out.place = fit->worst_at;
  return out;
}

Outcome cavity(const Item& item, Workpiece& scene) {
  const auto& shape = scene.cavity(item.region, item.within);
  if (!shape) return without(item, shape);
  const std::string_view how = item.how->name;
  Outcome out;
  if (how == "cavity_depth") {
    const double off = shape->depth - item.limit("depth_mm");
    out = at_most(item, std::abs(off), item.limit("off_mm"), shape->error,
                  off > 0 ? "too deep by" : "not deep enough by");
  } else if (how == "cavity_floor") {
    out = at_most(item, shape->uneven, item.limit("most_mm"), shape->error,
                  "unevenness of the floor (rms)");
  } else {
    if (!shape->outline) {
      // all was cut to where the region ends: what has no edge keeps to none
      Outcome none = not_assessable(item, "the cut has no edge near the planned one");
      none.verdict = Verdict::unmet;
      return none;
    }
    out = at_most(item, *shape->outline, item.limit("most_mm"), shape->error,
                  "distance of the rim from the planned one (95 %)");
  }
  out.place = shape->deepest;
  return out;
}

// The least distance of what was cut to a structure; with `along`, of the corridor too.
Outcome clearance(const Item& item, Workpiece& scene) {
  const auto points =
      metrics::new_surface(scene.before(), scene.after(), scene.region(item.region));
  const auto distance = scene.distance(item.structure);
  double least = distance->reach();
  std::optional<math::Vec3> nearest;
  for (const metrics::SurfacePoint& point : points) {
    const double d = distance->at(point.place).distance;
    if (d >= least) continue;
    least = d;
    nearest = point.place;
  }
  if (!item.along.empty()) {
    // where a corridor leaves the bone it has no surface there, and is as near all the same
    const auto& fit = scene.axis(item.along, item.region);
    const double step = 0.5 * scene.before().grid().voxel;
    for (double l = 0; fit && l <= fit->depth; l += step) {
      const math::Vec3 at = fit->entry + l * fit->inward;
      const double d = std::max(0.0, distance->at(at).distance - 0.5 * fit->width);
      if (d >= least) continue;
      least = d;
      nearest = at;
    }
  }
  const double enough = item.limit("least_mm");
  Outcome out =
      decided(item, {least >= enough, true, least, enough, 0.5 * scene.before().grid().voxel},
              "least distance of what was cut", true);
  out.place = nearest;
  return out;
}

Outcome divided(const Item& item, Workpiece& scene) {
  const double enough = item.limit("share");
  const auto pieces =
      metrics::divided(scene.before(), scene.after(), scene.region(item.region), enough);
  if (!pieces) return not_assessable(item, pieces.reason());
  return decided(item, {pieces->share >= enough, true, pieces->share, enough, 0},
                 "share of the smaller piece", true);
}

}  // namespace

std::optional<Outcome> measure_shape(const Item& item, Workpiece& scene) {
  const std::string_view how = item.how->name;
  Outcome (*const measure)(const Item&, Workpiece&) = how.starts_with("axis_")     ? axis
                                                      : how.starts_with("plane_")  ? plane
                                                      : how.starts_with("cavity_") ? cavity
                                                      : how == "clearance"         ? clearance
                                                      : how == "divided"           ? divided
                                                                                   : nullptr;
  if (measure == nullptr) return {};
  if (auto nothing = idle(item, scene)) return nothing;
  return measure(item, scene);
}

}  // namespace burr::scoring
