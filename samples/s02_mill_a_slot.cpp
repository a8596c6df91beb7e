// s02_mill_a_slot - a whole session without a person: a simulated hand mills a slot into a slab.
//
// Prints the account of removed volume, which must balance: asked = removed + debt + not cut.
#include <fmt/core.h>

#include <cmath>
#include <memory>
#include <utility>

#include "burr/base/progress.h"
#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"

namespace {

int trouble(const burr::Error& error) {
  fmt::print("{}\n", error.text);
  return 1;
}

}  // namespace

int main() {
  using namespace burr;
  auto bone = phantom::bone_from_distance(phantom::cube_grid(30e-3, 75), {}, phantom::slab());

  // where, in which direction, for how long
  sim::SessionSettings settings;
  settings.servo.burr.radius = 2e-3;
  const auto place = surgeon::find_work_place(*bone, settings.servo.burr.radius, {}, {});
  if (!place) return trouble(place.error());
  auto path = surgeon::motion("slot", *place, settings.servo.burr.radius, 3.0);
  if (!path) return trouble(path.error());
  auto hand = std::make_unique<device::SimulatedHand>(std::move(*path), device::ArmSettings{});

  NoProgress quiet;
  auto session = sim::Session::make(std::move(bone), std::move(hand), settings, quiet);
  if (!session) return trouble(session.error());
  (*session)->run(3.0, quiet);

  const sim::Outcome outcome = (*session)->outcome();
  const edit::Ledger& l = outcome.ledger;
  fmt::print("{} ticks, peak force {:.2f} N\n", outcome.ticks, outcome.peak_force);
  fmt::print("asked {:.3f} mm3 = removed {:.3f} + debt {:.3f} + not cut {:.3f}\n", l.asked * 1e9,
             l.removed * 1e9, std::abs(l.debt) * 1e9, l.not_cut * 1e9);
  const double open = std::abs(l.asked - l.removed - l.debt - l.not_cut);
  return l.removed > 0 && open <= 1e-6 * l.asked ? 0 : 1;
}
