// A hand that is lifted on purpose, tick by tick: the force fades within 5 ms, nothing is cut, and
// it comes back in free air only.
#include <gtest/gtest.h>

#include <vector>

#include "burr/haptics/contact.h"
#include "burr/tick/servo.h"
#include "tick/slab_bench.h"

namespace burr::tick {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;

struct Bench : test::SlabBench {
  Bench() : SlabBench(0.25 * kMm) {}
  // One tick with the tip's centre so high over the slab.
  double tick(double z_mm, bool lifted, double pedal = 1) {
    device::HandState now;
    now.world_from_tool.p = {0, 0, z_mm * kMm};
    now.pedal = pedal;
    now.buttons = lifted ? device::kLifted : 0;
    hand->set(now);
    row = session->servo().tick(false);
    return row.contact.force.norm();
  }
};

TEST(Lift, TheForceFadesInFiveTicksAndNothingIsCut) {
  Bench bench;
  for (int n = 0; n < 700; ++n) bench.tick(3, false);
  double force = 0;
  for (int n = 0; n < 200; ++n) force = bench.tick(1.5, false);
  ASSERT_GT(force, 0.2);
  const double removed = bench.row.ledger.removed;
  ASSERT_GT(removed, 0);
  double last = force;
  for (int n = 1; n <= 5; ++n) {
    const double now = bench.tick(1.5, true);
    EXPECT_NEAR(now, force * (1 - n / 5.0), 1e-9);
    last = now;
  }
  EXPECT_EQ(last, 0);
  const double after_fade = bench.row.ledger.removed;
  for (int n = 0; n < 300; ++n) EXPECT_EQ(bench.tick(1.5, true), 0);
  EXPECT_EQ(bench.row.ledger.removed, after_fade);
  EXPECT_FALSE(bench.row.contact.touching);
}

TEST(Lift, LaidDownInBoneItWaitsForFreeAirAndThenRampsUp) {
  Bench bench;
  for (int n = 0; n < 700; ++n) bench.tick(3, false);
  for (int n = 0; n < 100; ++n) bench.tick(1.5, false, 0);
  for (int n = 0; n < 50; ++n) bench.tick(0.5, true, 0);
  for (int n = 0; n < 50; ++n) EXPECT_EQ(bench.tick(0.5, false, 0), 0) << "it is in bone";
  for (int n = 0; n < 20; ++n) EXPECT_EQ(bench.tick(3, false, 0), 0);
  double before = 0;
  for (int n = 0; n < 20; ++n) {
    const double now = bench.tick(1.5, false, 0);
    EXPECT_LE(now - before, 0.06 + 1e-9) << "the start ramp";
    before = now;
  }
  EXPECT_GT(before, 0);
}

}  // namespace
}  // namespace burr::tick
