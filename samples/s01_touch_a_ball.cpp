// s01_touch_a_ball - a hand presses into a ball of bone; the burr stays outside and pushes back.
//
// The hand goes 1 mm below the surface, along a great circle of the ball. Prints the proxy (the
// place of the burr) and the force, and compares both with the formula: a burr of radius r on a
// ball of radius R lies R + r from its centre, and the spring of 500 N/m gives 0.5 N.
#include <burr/base/progress.h>
#include <burr/device/replayed_hand.h>
#include <burr/phantom/build.h>
#include <burr/phantom/shapes.h>
#include <burr/tick/servo.h>
#include <burr/volume/iso_vertices.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

int main() {
  using namespace burr;
  const double ball = 10e-3, deep = 1e-3;  // [m]

  // a bone by formula, and its surface for touch
  const auto bone =
      phantom::bone_from_distance(phantom::cube_grid(30e-3, 120), {}, phantom::ball(ball));
  NoProgress quiet;
  volume::IsoVertices surface(*bone, {}, 2, quiet);

  // the hand goes where we set it, tick by tick; the servo answers with a force
  device::ReplayedHand hand(device::DeviceSpec{});
  tick::ServoSettings settings;
  settings.mode = tick::ToolMode::touch;
  settings.burr.radius = 2e-3;
  settings.force.stiffness = 500;  // [N/m]
  settings.friction_scale = 0;
  tick::Servo servo(*bone, surface, hand, settings);

  double worst_mm = 0, worst_n = 0;
  std::printf("angle_deg  proxy_mm                     force_N  off_mm\n");
  for (int tick = 0; tick <= 2000; ++tick) {
    // one second down to the bone, one second along it
    const double angle = std::max(0.0, 1e-3 * (tick - 1000));   // [rad]
    const double height = std::max(-deep, 5e-3 - 1e-5 * tick);  // of the burr above the bone [m]
    const math::Vec3 out(std::sin(angle), 0, std::cos(angle));
    device::HandState state;
    state.world_from_tool.p = (ball + settings.burr.radius + height) * out;
    hand.set(state);

    const haptics::Contact& contact = servo.tick(false).contact;
    if (tick < 1000) continue;
    const math::Vec3 rest = (ball + settings.burr.radius) * out;  // by the formula
    // where the burr rests on the smooth surface, from which the force is made
    const math::Vec3 found = state.world_from_tool.p + contact.depth * contact.normal;
    const double off_mm = 1e3 * (found - rest).norm();
    worst_mm = std::max(worst_mm, off_mm);
    worst_n = std::max(worst_n, (contact.force - settings.force.stiffness * deep * out).norm());
    if (tick % 200 == 0)
      std::printf("%9.1f  (%7.3f %7.3f %7.3f)  %7.3f  %.4f\n", angle * 180 / std::numbers::pi,
                  1e3 * contact.proxy.x(), 1e3 * contact.proxy.y(), 1e3 * contact.proxy.z(),
                  contact.force.norm(), off_mm);
  }
  std::printf("at most %.4f mm and %.4f N off the formula, in voxels of 0.25 mm\n", worst_mm,
              worst_n);
  return worst_mm < 0.02 && worst_n < 0.01 ? 0 : 1;
}
