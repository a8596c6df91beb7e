// burr verify truths - every touch method on bones for which the right answer is known exactly.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "burr/haptics/force_law.h"
#include "burr/phantom/build.h"
#include "burr/tick/touch_methods.h"
#include "scenes/strokes.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"
#include "verify.h"

namespace burr::app {
namespace {

using haptics::Method;
using math::Vec3;

constexpr double kMm = 1e-3;
constexpr double kDeep = 0.3 * kMm;  // at most half of the burr's radius
// The field resolves an edge to a quarter of a voxel, because the edge lies between its samples.
constexpr double kEdge = 0.25;            // [voxel]
constexpr int kDown = 200, kAlong = 400;  // ticks

double angle_deg(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

// The worst values of one stroke.
struct Found {
  double place = 0;      // felt place, distance from the true place [m]
  double proxy = 0;      // the same for the burr that is drawn      [m]
  double buried = 0;     // how deep the drawn burr lies in bone     [m]
  double direction = 0;  // error of the force's direction      [degree]
  double silent = 0;     // share of ticks with a press but without force
};

// Methods that test whether the centre of the hand is in bone feel it one radius too late.
bool feels_its_centre(Method method) {
  return method == Method::thesis || method == Method::thesis_literal;
}

Found stroke_with(const scenes::Stroke& stroke, const volume::IsoVertices& surface, double r,
                  Method method) {
  haptics::ProxySettings settings;
  settings.radius = r;
  tick::TouchMethods by(surface, settings, method);
  by.now().place(stroke.start);
  const auto hand = [&](double s) {
    if (!feels_its_centre(method)) return stroke.hand(s);
    if (stroke.centre_hand) return stroke.centre_hand(s);
    const Vec3 x = stroke.hand(s);
    return Vec3(x - r * (stroke.true_centre(x) - x).normalized());
  };
  Found found;
  std::uint64_t tick = 0;
  const auto step = [&](const Vec3& x) {
    by.show(tick++);
    return by.now().step(x);
  };
  const Vec3 first = hand(0);
  for (int n = 0; n <= kDown; ++n)
    (void)step(stroke.start + (first - stroke.start) * (static_cast<double>(n) / kDown));
  for (int n = 0; n < 40; ++n) (void)step(first);
  int silent = 0;
  for (int n = 0; n <= kAlong; ++n) {
    const double s = static_cast<double>(n) / kAlong;
    const Vec3 x = hand(s), truth = stroke.true_centre(stroke.hand(s));
    const haptics::Touch touch = step(x);
    const Vec3 force = haptics::force_law(touch, Vec3::Zero(), {1000, 0});
    if (force.norm() < 1e-6) {
      ++silent;
      continue;
    }
    const Vec3 right = truth - stroke.hand(s);
    Vec3 felt = x + touch.depth * touch.normal;
    if (feels_its_centre(method)) felt += r * (method == Method::thesis ? 1 : 0) * touch.normal;
    found.place = std::max(found.place, (felt - truth).norm());
    found.proxy = std::max(found.proxy, (touch.proxy - truth).norm());
    found.buried = std::max(found.buried, stroke.depth(touch.proxy) + r);
    if (right.norm() > 0.1 * kMm)
      found.direction = std::max(found.direction, angle_deg(force, right));
  }
  found.silent = static_cast<double>(silent) / (kAlong + 1);
  return found;
}

struct Worst {
  double place_h = 0, buried_h = 0, direction = 0, silent = 0;
  void take(const Found& found, double h) {
    place_h = std::max(place_h, found.place / h);
    buried_h = std::max(buried_h, found.buried / h);
    direction = std::max(direction, found.direction);
    silent = std::max(silent, found.silent);
  }
};

void truths(const Verify& verify, VerifyReport::Part& part) {
  const std::vector<double> voxels =
      verify.quick ? std::vector<double>{0.25} : std::vector<double>{0.5, 0.25, 0.125};
  const std::vector<double> radii =
      verify.quick ? std::vector<double>{6} : std::vector<double>{2, 6, 20};  // [voxel]
  std::map<std::string, std::map<Method, Worst>> worst;
  std::vector<std::string> order;
  Series series{"truths",
                {"shape", "method", "h_mm", "r_voxel", "place_um", "proxy_um", "buried_um",
                 "direction_deg", "silent_share"},
                {}};
  NoProgress quiet;
  double done = 0;
  for (const double h_mm : voxels)
    for (const double r_h : radii) {
      const double h = h_mm * kMm, r = r_h * h;
      const double deep = std::min(kDeep, r / 2);
      const std::vector<scenes::Stroke> strokes = scenes::strokes(r, h, deep);
      for (std::size_t n = 0; n < strokes.size(); ++n) {
        if (interrupted()) return;
        const scenes::Stroke& stroke = strokes[n];
        progress().report(
            done++ / static_cast<double>(strokes.size() * voxels.size() * radii.size()),
            "ground truths");
        if (order.size() < strokes.size()) order.push_back(stroke.name);
        const auto bone = phantom::bone_from_distance(stroke.grid, {}, stroke.depth);
        const volume::IsoVertices surface(*bone, {}, 2, quiet);
        for (int m = 0; m < haptics::kMethods; ++m) {
          const auto method = static_cast<Method>(m);
          const Found found = stroke_with(stroke, surface, r, method);
          worst[stroke.name][method].take(found, h);
          series.rows.push_back({static_cast<double>(n), static_cast<double>(m), h_mm, r_h,
                                 1e6 * found.place, 1e6 * found.proxy, 1e6 * found.buried,
                                 found.direction, found.silent});
          const std::string which =
              fmt::format("{}.{}.h{}.r{}", stroke.name, haptics::name(method), h_mm, r_h);
          if (method == Method::constraint) {
            // 0.02 mm or a tenth of a voxel, half a degree (docs/understand/touch_truths.md,
            // "Ground truths")
            const double exact = std::max(0.02 * kMm, 0.1 * h) * stroke.radius_error_factor;
            const double allowed = stroke.sharp ? std::max(exact, kEdge * h) : exact;
            const double turned = std::atan2(kEdge * h, deep) * 180 / M_PI;
            // a burr with a radius of two voxels rests on only three or four vertices of the
            // surface
            const double smooth = r_h < 3 ? 0.75 : 0.5;
            part.at_most(which + ".place", 1e3 * allowed, 1e3 * found.place, "mm");
            part.at_most(which + ".direction", stroke.sharp ? turned : smooth, found.direction,
                         "deg");
            part.at_most(which + ".silent", 0, found.silent, "");
          }
          // its burr stands one radius away along one normal: an error of that normal counts r / R
          // times
          if (method == Method::thesis && stroke.convex > 0)
            part.at_most(which + ".place",
                         1e3 * std::max(0.02 * kMm, 0.1 * h) * (1 + r / stroke.convex),
                         1e3 * found.place, "mm");
          if (method == Method::thesis && stroke.name == "groove 90")
            part.at_least(which + ".buried", 0.3 * 1e3 * r, 1e3 * found.buried, "mm");
        }
      }
    }
  part.series.push_back(std::move(series));

  Table table;
  table.caption =
      "Methods by shapes, the worst over all voxel sizes and burrs: distance of the felt position "
      "from the true one [voxel] / angle between the force and its true direction [degree] / how "
      "deep the drawn burr is in bone [voxel] / share of pressing ticks without force. "
      "`voxel-springs` has no proxy: for it, only the direction counts.";
  table.head.push_back("shape");
  for (int m = 0; m < haptics::kMethods; ++m)
    table.head.emplace_back(haptics::name(static_cast<Method>(m)));
  for (const std::string& shape : order) {
    std::vector<std::string> row = {shape};
    for (int m = 0; m < haptics::kMethods; ++m) {
      const Worst& one = worst[shape][static_cast<Method>(m)];
      row.push_back(fmt::format("{:.2f} / {:.1f} / {:.2f} / {:.2f}", one.place_h, one.direction,
                                one.buried_h, one.silent));
    }
    table.rows.push_back(row);
  }
  part.table(std::move(table));
}

const VerifyPart part{
    20, "truths", "Ground truths",
    "A hand strokes each bone, pressing 0.3 mm deep, and the position of the burr is compared with "
    "the formula, for every method. Our method has to be right everywhere, the thesis' on smooth "
    "convex bone; in a groove the thesis' method is predicted to bury the burr.",
    truths};

}  // namespace
}  // namespace burr::app
