// s04_own_tools - a rack of custom burrs, carried as data, tried on the same bone.
//
// A tool is a burr (radius, kind), the speed of its spindle and its motor. Each tool of the rack is
// pressed into the same slab in the same way. Prints what each removes and how far its spindle
// slows down, and checks: a diamond burr removes less than a steel burr of the same size, and a
// weak motor loses more speed than a strong one.
#include <burr/base/progress.h>
#include <burr/device/simulated_hand.h>
#include <burr/phantom/build.h>
#include <burr/phantom/shapes.h>
#include <burr/tick/servo.h>
#include <burr/tool/burr_tool.h>
#include <burr/tool/spindle.h>
#include <burr/volume/iso_vertices.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <numbers>

namespace {

using namespace burr;

struct Tool {
  const char* name;
  tool::Burr burr;
  double rpm;  // at full pedal
  tool::Motor motor;
};

constexpr Tool kRack[] = {
    {"steel 5 mm", {.radius = 2.5e-3, .kind = tool::BurrKind::cutting}, 40'000, {}},
    {"diamond 5 mm", {.radius = 2.5e-3, .kind = tool::BurrKind::diamond}, 40'000, {}},
    {"steel 3 mm", {.radius = 1.5e-3, .kind = tool::BurrKind::cutting}, 40'000, {}},
    {"steel 5 mm, weak motor", {.radius = 2.5e-3, .teeth = 6}, 40'000, {.torque = 1e-3}},
};

struct Outcome {
  double removed = 0;       // [m^3]
  double lowest_speed = 1;  // of the set speed, while cutting [-]
};

Outcome try_on_bone(const Tool& tool) {
  const auto bone = phantom::bone_from_distance(phantom::cube_grid(20e-3, 50), {}, phantom::slab());
  NoProgress quiet;
  volume::IsoVertices surface(*bone, {}, 2, quiet);

  tick::ServoSettings settings;
  settings.burr = tool.burr;
  settings.motor = tool.motor;
  settings.spindle_rad_s = tool.rpm * 2 * std::numbers::pi / 60;

  // to the bone in one second, then pulled 4 mm below its surface for another
  const math::Quat leaning(Eigen::AngleAxisd(std::numbers::pi / 3, math::Vec3::UnitX()));
  const auto pose = [&](double height) {
    return math::Pose{.p = {0, 0, tool.burr.radius + height}, .q = leaning};
  };
  device::SimulatedHand hand({{{0, pose(2e-3), 1}, {1, pose(0), 1}, {2, pose(-4e-3), 1}}}, {});
  Outcome result;
  if (!hand.open()) return result;

  tick::Servo servo(*bone, surface, hand, settings);
  for (int tick = 0; tick < 2000; ++tick) {
    const tick::TickRow& row = servo.tick(false);
    result.removed = row.ledger.removed;
    if (row.cutting_w > 0)
      result.lowest_speed =
          std::min(result.lowest_speed, row.spindle_rad_s / settings.spindle_rad_s);
  }
  return result;
}

}  // namespace

int main() {
  Outcome results[std::size(kRack)];
  for (std::size_t n = 0; n < std::size(kRack); ++n) {
    results[n] = try_on_bone(kRack[n]);
    std::printf("%-24s removed %7.3f mm3, spindle never below %5.1f %%\n", kRack[n].name,
                results[n].removed * 1e9, results[n].lowest_speed * 100);
  }
  const auto& [steel, diamond, small, weak] = results;
  return steel.removed > 1e-9 && small.removed > 1e-9 && diamond.removed < 0.9 * steel.removed &&
                 weak.lowest_speed < steel.lowest_speed
             ? 0
             : 1;
}
