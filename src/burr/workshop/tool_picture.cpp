#include "burr/workshop/tool_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/workshop/tool_looks.h"

namespace burr::workshop {
namespace {

constexpr double kShown = 44e-3,
                 kBelow = 14e-3;  // of a tool: height, and part below its origin [m]
constexpr double kLeast = 8e-3;   // that a picture of a tip shows  [m]

// The picture shows z from `low` on, so high.  [m]
render::Scene empty(double low, double high) {
  render::Scene scene;
  scene.burr.visible = true;
  scene.camera.target = {0, 0, low + high / 2};
  scene.camera.distance = 0.3;
  scene.camera.azimuth = 0.6;
  scene.camera.elevation = 0.2;
  scene.camera.field_of_view = 2 * std::atan(0.5 * high / scene.camera.distance);
  scene.look.background_top = {0.93F, 0.94F, 0.95F};
  scene.look.background_bottom = {0.78F, 0.80F, 0.83F};
  return scene;
}

render::Scene with_look(render::Scene scene, const tool::Tool& tool) {
  scene.burr.other = look_of(tool);
  return scene;
}

// A sixth of the picture stays free below the tip, and there is room for the width.
render::Scene around(double low, double high, double wide, double aspect) {
  const double shown = std::max({1.7 * (high - low), 1.5 * wide / aspect, kLeast});
  return empty(low - shown / 6, shown);
}

}  // namespace

render::Scene tool_picture(const tool::Tool& tool) {
  return with_look(empty(-kBelow, kShown), tool);
}

render::Scene tip_picture(const tool::Tool& tool, double aspect) {
  double low = 0, high = 0, wide = 0;
  for (int n = 0; n < tool.count; ++n) {
    const tool::Part& part = tool.parts[static_cast<std::size_t>(n)];
    if (part.role != tool::Role::cuts) continue;
    const auto reach = [&part](const math::Vec3& way) {
      return way.dot(part.tool_from_part.p) +
             tool::support(part.shape, part.tool_from_part.q.conjugate() * way);
    };
    low = std::min(low, -reach(-math::Vec3::UnitZ()));
    high = std::max(high, reach(math::Vec3::UnitZ()));
    for (const int axis : {0, 1})
      wide = std::max(wide, reach(math::Vec3::Unit(axis)) + reach(-math::Vec3::Unit(axis)));
  }
  return with_look(around(low, high, wide, aspect), tool);
}

render::Scene tip_picture(const tool::Burr& burr, double aspect) {
  render::Scene scene = around(-burr.radius, burr.radius, 2 * burr.radius, aspect);
  scene.burr.radius = burr.radius;
  scene.burr.shaft_radius = burr.shaft_radius;
  scene.burr.shaft_length = burr.shaft_length;
  scene.burr.diamond = burr.kind == tool::BurrKind::diamond;
  return scene;
}

}  // namespace burr::workshop
