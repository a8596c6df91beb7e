// A burr that slips off rough bone: the hand feels the spring follow, and while it presses on no bone
// nothing is cut and no energy is spent.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "burr/device/replayed_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/sim/session.h"
#include "burr/tick/servo.h"

namespace burr::tick {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;

TEST(Slip, CutsNothingInFreeAir) {
  NoProgress quiet;
  auto owned = std::make_unique<device::ReplayedHand>(device::DeviceSpec{});
  device::ReplayedHand& hand = *owned;
  sim::SessionSettings settings;
  settings.servo.burr.radius = 1 * kMm;
  settings.servo.undo_bricks = 512;
  settings.surface.reserve_blocks = 1 << 12;
  auto made = sim::Session::make(
      phantom::bone_from_distance(
          phantom::box_grid(Vec3::Constant(-9 * kMm), Vec3::Constant(9 * kMm), 0.3 * kMm), {},
          phantom::gyroid(6 * kMm), 64),
      std::move(owned), settings, quiet);
  ASSERT_TRUE(made.ok());
  int felt_in_air = 0, cut = 0;
  for (int n = 0; n < 12'000; ++n) {
    const double t = n * 1e-3;
    device::HandState now;
    now.world_from_tool.p = n < 1000 ? Vec3(0, 0, (14 - 6.5 * n / 1000) * kMm)
                                     : Vec3(5 * std::sin(4 * t), 5 * std::sin(2.7 * t), 7.5) * kMm;
    now.pedal = 1;
    hand.set(now);
    const TickRow& row = (*made)->servo().tick(false);
    if (row.contact.active > 0) {
      cut += row.cutting_w > 0 ? 1 : 0;
      continue;
    }
    ASSERT_EQ(row.cutting_w, 0) << n;
    ASSERT_FALSE(row.contact.touching) << n;
    felt_in_air += row.contact.force.norm() > 0.02 ? 1 : 0;
  }
  EXPECT_GT(cut, 500);
  EXPECT_GT(felt_in_air, 20);
}

}  // namespace
}  // namespace burr::tick
