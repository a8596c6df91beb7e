// s03_own_force_law - a force custom law: a spring that grows stiffer with depth.
//
// Touch says where the burr rests on the bone and how far the hand is from there; the law turns
// that into a force. A simulated hand is pulled 2 mm below the surface by its own spring and comes
// to rest where the two springs balance. Prints that depth and compares it with the equation.
//
// A real device gets its force through haptics/safety/limit.h, as in tick/servo.cpp. See
// docs/develop/how_to_add_a_force_law.md.
#include <burr/base/progress.h>
#include <burr/device/simulated_hand.h>
#include <burr/haptics/touch_method.h>
#include <burr/phantom/build.h>
#include <burr/phantom/shapes.h>
#include <burr/volume/iso_vertices.h>

#include <cmath>
#include <cstdio>
#include <memory>

namespace {

using namespace burr;

constexpr double kLinear = 300;  // [N/m]
constexpr double kCubic = 2e8;   // [N/m^3]

// The law: same input, same bits; no clock, no memory.
double spring(double depth) { return kLinear * depth + kCubic * depth * depth * depth; }  // [N]

math::Vec3 own_law(const haptics::Touch& touch) BURR_RT {
  return touch.touching ? math::Vec3(spring(touch.depth) * touch.normal) : math::Vec3::Zero();
}

}  // namespace

int main() {
  const double radius = 2e-3, pulled = 2e-3, dt = 1e-3;  // [m], [m], [s]
  const auto bone = phantom::bone_from_distance(phantom::cube_grid(30e-3, 75), {}, phantom::slab());
  NoProgress quiet;
  const volume::IsoVertices surface(*bone, {}, 2, quiet);

  // from 5 mm above the bone to a place 2 mm too deep, in one second; then it stays there
  const math::Pose above{.p = {0, 0, radius + 5e-3}}, below{.p = {0, 0, radius - pulled}};
  const device::ArmSettings arm;
  device::SimulatedHand hand({{{0, above, 0}, {1, below, 0}}}, arm);
  if (!hand.open()) return 1;
  const auto touch =
      haptics::make_method(haptics::Method::constraint, surface, {.radius = radius}, above.p);

  double depth = 0, force = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    const haptics::Touch now = touch->step(hand.state(dt).world_from_tool.p);
    const math::Vec3 answer = own_law(now);
    hand.write_force(answer);
    depth = now.depth;
    force = answer.norm();
  }

  // the arm's spring pulls with stiffness * (pulled - depth); bisection for the balance
  double low = 0, high = pulled;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (spring(middle) < arm.stiffness * (pulled - middle) ? low : high) = middle;
  }
  std::printf("the hand rests %.4f mm deep at %.3f N; the equation says %.4f mm and %.3f N\n",
              1e3 * depth, force, 1e3 * low, spring(low));
  return std::abs(depth - low) < 2e-6 ? 0 : 1;
}
