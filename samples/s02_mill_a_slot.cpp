// s02_mill_a_slot - a session without a person: a simulated hand mills a slot into a slab.
//
// Prints the account of the removed volume, which must close: asked = removed + debt + not cut.
#include <burr/base/progress.h>
#include <burr/device/simulated_hand.h>
#include <burr/phantom/build.h>
#include <burr/phantom/shapes.h>
#include <burr/sim/session.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <utility>

namespace {

using namespace burr;

// Where the hand is at a time [s, m]. The handle leans by 60 degrees, since a burr cuts with its
// side; the spindle runs.
device::PathPoint point(double t, double x, double z) {
  const math::Quat leaning(Eigen::AngleAxisd(std::numbers::pi / 3, math::Vec3::UnitX()));
  return {.t = t, .world_from_tool = {.p = {x, 0, z}, .q = leaning}, .pedal = 1};
}

}  // namespace

int main() {
  // bone below z = 0
  auto bone = phantom::bone_from_distance(phantom::cube_grid(30e-3, 75), {}, phantom::slab());

  sim::SessionSettings settings;
  settings.servo.burr.radius = 2e-3;
  // from above to a place 1.5 mm below the surface, then 8 mm along x
  device::HandPath path{{point(0, -4e-3, 6e-3), point(0.5, -4e-3, 2e-3), point(1.5, -4e-3, 0.5e-3),
                         point(3.5, 4e-3, 0.5e-3)}};
  auto hand = std::make_unique<device::SimulatedHand>(std::move(path), device::ArmSettings{});

  NoProgress quiet;
  auto session = sim::Session::make(std::move(bone), std::move(hand), settings, quiet);
  if (!session) {
    std::printf("%s\n", session.error().text.c_str());
    return 1;
  }
  (*session)->run(3.5, quiet);

  const sim::Outcome outcome = (*session)->outcome();
  const edit::Ledger& l = outcome.ledger;
  std::printf("%.1f s, peak force %.2f N\n", outcome.seconds, outcome.peak_force);
  std::printf("asked %.3f mm3 = removed %.3f + debt %.3f + not cut %.3f\n", l.asked * 1e9,
              l.removed * 1e9, std::abs(l.debt) * 1e9, l.not_cut * 1e9);
  const double open = std::abs(l.asked - l.removed - l.debt - l.not_cut);
  return l.removed > 1e-9 && open <= 1e-6 * l.asked ? 0 : 1;
}
