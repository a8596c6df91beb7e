// burr verify thesis - the four verification cases of the thesis, with its own method and with
// burr's.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "burr/device/simulated_hand.h"
#include "burr/haptics/force_law.h"
#include "burr/haptics/touch_method.h"
#include "burr/phantom/build.h"
#include "verify.h"

namespace burr::app {
namespace {

using haptics::Method;
using math::Vec3;

constexpr double kMm = 1e-3, kDt = 1e-3;
constexpr double kSide = 5.125 * kMm;  // half the cube's edge, through voxel centres
constexpr double kVoxel = 0.25 * kMm, kRadius = 1.5 * kMm;

struct Case {
  const char* name;
  double stiffness, friction;  // docs/understand/touch_methods.md, "The thesis' four cases"
};
constexpr std::array<Case, 4> kCases = {{{"1 stiff", 1000, 0.3},
                                         {"2 soft", 200, 0.3},
                                         {"3 high friction", 500, 0.8},
                                         {"4 low friction", 500, 0.1}}};

struct Row {
  double t = 0, probe = 0, proxy = 0;  // height above the side [m]
  double spring = 0, depth = 0, force = 0, law = 0;
};

// A firmly held hand: lowered onto the side, pushed 2 mm beyond it and dragged 6 mm along it.
std::vector<Row> drag(const Case& one, Method method, const volume::IsoVertices& surface) {
  const double centre = method == Method::thesis ? 0 : kRadius;  // its centre at the contact
  const double z = kSide + centre;
  device::HandPath path;
  const auto point = [&](double t, double x, double above) {
    device::PathPoint p;
    p.t = t;
    p.world_from_tool.p = {x, 0.4 * kMm, z + above};
    path.points.push_back(p);
  };
  point(0, -3 * kMm, 2 * kMm);
  point(1, -3 * kMm, -2 * kMm);
  point(1.5, -3 * kMm, -2 * kMm);
  point(3.5, 3 * kMm, -2 * kMm);
  point(4, 3 * kMm, -2 * kMm);
  device::SimulatedHand hand(path, {.mass = 0.1, .damping = 20, .stiffness = 700});
  haptics::ProxySettings settings;
  settings.radius = kRadius;
  settings.friction_static = settings.friction_kinetic = one.friction;
  const Vec3 start = path.points.front().world_from_tool.p;
  const auto by = haptics::make_method(method, surface, settings, start);
  std::vector<Row> rows;
  for (int n = 0; n < 4000; ++n) {
    const Vec3 x = hand.state(kDt).world_from_tool.p;
    const haptics::Touch touch = by->step(x);
    const Vec3 force = haptics::force_law(touch, Vec3::Zero(), {one.stiffness, 0});
    hand.write_force(force);
    Row row;
    row.t = n * kDt;
    row.probe = x.z() - kSide - centre;
    row.proxy = touch.proxy.z() - kSide - kRadius;
    const Vec3 spring = touch.depth * touch.normal + touch.tangential;
    row.spring = spring.norm();
    row.depth = touch.touching ? std::max(0.0, -row.probe) : 0;
    row.force = force.norm();
    row.law = std::abs(row.force - one.stiffness * row.spring);
    rows.push_back(row);
  }
  return rows;
}

// True while the hand slides at full speed.
bool slides(const Row& row) { return row.t > 2.5 && row.t < 3.4; }

void cases(const Verify&, VerifyReport::Part& part) {
  NoProgress quiet;
  const phantom::Depth cube = phantom::box(Vec3::Constant(kSide));
  const Vec3 half = Vec3::Constant(std::ceil((kSide + 5 * kMm) / kVoxel) * kVoxel);
  const auto bone = phantom::bone_from_distance(phantom::box_grid(-half, half, kVoxel), {}, cube);
  const volume::IsoVertices surface(*bone, {}, 2, quiet);
  for (const Method method : {Method::thesis, Method::constraint}) {
    const std::string who(haptics::name(method));
    Plot place{"Figure 13 of the thesis by " + who +
                   ": proxy and probe relative to the side of the cube; the proxy stays on it.",
               2,
               {}};
    Plot spring{
        "Figure 14: length of the spring, and depth of the probe. Coulomb friction in "
        "steady sliding makes their ratio sqrt(1 + mu^2): 1.28 for high friction, 1.04 and "
        "1.005 for medium and low.",
        2,
        {}};
    Plot force{"Figure 15: force before the output chain, k times the spring's length.", 2, {}};
    std::array<double, 4> depth{}, felt{};
    for (std::size_t n = 0; n < kCases.size(); ++n) {
      const Case& one = kCases[n];
      const std::vector<Row> rows = drag(one, method, surface);
      Series series{fmt::format("thesis_case_{}_{}", n + 1, who),
                    {"t_s", "probe_mm", "proxy_mm", "spring_mm", "depth_mm", "force_N"},
                    {}};
      Line proxy{"proxy", {}, {}}, probe{"probe", {}, {}}, length{"spring", {}, {}},
          deep{"depth", {}, {}}, newton{"force", {}, {}};
      double off = 0, law = 0, ratio = 0, worst_ratio = 0;
      int count = 0;
      const double right = std::sqrt(1 + one.friction * one.friction);
      for (const Row& row : rows) {
        series.rows.push_back({row.t, 1e3 * row.probe, 1e3 * row.proxy, 1e3 * row.spring,
                               1e3 * row.depth, row.force});
        for (Line* line : {&proxy, &probe, &length, &deep, &newton}) line->x.push_back(row.t);
        proxy.y.push_back(1e3 * row.proxy);
        probe.y.push_back(1e3 * row.probe);
        length.y.push_back(1e3 * row.spring);
        deep.y.push_back(1e3 * row.depth);
        newton.y.push_back(row.force);
        law = std::max(law, row.law);
        if (row.spring > 0) off = std::max(off, std::abs(row.proxy));
        if (!slides(row)) continue;
        ratio = row.spring / row.depth;
        worst_ratio = std::max(worst_ratio, std::abs(ratio - right));
        depth[n] += row.depth;
        felt[n] += row.force;
        ++count;
      }
      depth[n] /= count;
      felt[n] /= count;
      const std::string which = fmt::format("case{}.{}", n + 1, who);
      part.at_most(which + ".proxy_off_the_side", 0.02, 1e3 * off, "mm");
      part.at_most(which + ".force_less_k_length", 1e-9, law, "N");
      part.near(which + ".spring_over_depth", right, right + worst_ratio, 0.01 * right, "");
      part.series.push_back(std::move(series));
      const std::string title = fmt::format("case {}: k = {:.1f} N/mm, mu = {}", one.name,
                                            1e-3 * one.stiffness, one.friction);
      place.axes.push_back({title, "time [s]", "above the side [mm]", {proxy, probe}});
      spring.axes.push_back({title, "time [s]", "length [mm]", {length, deep}});
      force.axes.push_back({title, "time [s]", "force [N]", {newton}});
    }
    part.at_least(who + ".soft_is_deeper_than_stiff", 1e3 * depth[0], 1e3 * depth[1], "mm");
    part.at_most(who + ".soft_is_felt_least", std::min({felt[0], felt[2], felt[3]}), felt[1], "N");
    part.plot(std::move(place));
    part.plot(std::move(spring));
    part.plot(std::move(force));
  }
}

const VerifyPart part{
    10, "thesis", "The thesis' four cases",
    "A burr of 3 mm is pushed against one side of a cube and dragged along it, without milling and "
    "without vibration, in four cases: stiff, soft, high friction, low friction (M. Eriksson 2006, "
    "section 1.6.3; the thesis). The cube is 10.25 mm, with voxels of 0.25 mm; the thesis' own "
    "figures give no numbers. Each case is run once with the thesis' own method and once with "
    "ours.",
    cases};

}  // namespace
}  // namespace burr::app
