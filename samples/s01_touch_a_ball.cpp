// s01_touch_a_ball - a hand presses into a ball of bone; the burr stays outside and pushes back.
//
// Prints hand, proxy and force while the hand moves slowly across the ball, and compares with the
// formula: the proxy of a burr of radius r on a ball of radius R lies at R + r from its centre, on
// the ray through the hand.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "burr/base/progress.h"
#include "burr/haptics/proxy.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/volume/iso_vertices.h"

int main() {
  using namespace burr;
  const double ball = 10e-3, burr = 2e-3, stiffness = 500;  // [m], [m], [N/m]

  // a bone by formula, and its surface for touch
  const auto bone =
      phantom::bone_from_distance(phantom::cube_grid(30e-3, 120), {}, phantom::ball(ball));
  NoProgress quiet;
  volume::IsoVertices surface(*bone, {}, 2, quiet);

  // the hand stays 1 mm below the surface and moves along a great circle
  haptics::Proxy proxy(surface, {.radius = burr}, {0, 0, 15e-3});
  double worst_mm = 0;
  fmt::print("angle_deg  proxy_mm                     force_N  off_the_formula_mm\n");
  for (int tick = 0; tick <= 1000; ++tick) {
    const double angle = 1e-3 * tick;  // [rad]
    const math::Vec3 out(std::sin(angle), 0, std::cos(angle));
    const math::Vec3 hand = (ball + burr - 1e-3) * out;
    const haptics::Touch touch = proxy.step(hand);
    // the force pulls towards the place where the burr rests on the smooth surface
    const math::Vec3 rest = hand + touch.depth * touch.normal;
    const double off_mm = 1e3 * (rest - (ball + burr) * out).norm();
    if (tick > 100) worst_mm = std::max(worst_mm, off_mm);  // the first ticks come from far away
    if (tick % 200 == 0)
      fmt::print("{:9.1f}  ({:7.3f} {:7.3f} {:7.3f})  {:7.3f}  {:.4f}\n", angle * 180 / M_PI,
                 1e3 * touch.proxy.x(), 1e3 * touch.proxy.y(), 1e3 * touch.proxy.z(),
                 stiffness * touch.depth, off_mm);
  }
  fmt::print("worst {:.4f} mm off, of 0.25 mm voxels\n", worst_mm);
  return worst_mm < 0.02 ? 0 : 1;
}
