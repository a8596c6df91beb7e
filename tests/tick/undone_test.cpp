// What the account says is missing from the bone is what is missing, also after undo, redo and
// reset.
#include <gtest/gtest.h>

#include "burr/tick/servo.h"
#include "burr/volume/volume_of.h"
#include "tick/slab_bench.h"

namespace burr::tick {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kMm3 = 1e-9;

struct Bench : test::SlabBench {
  double whole;  // volume of the bone before the first cut [m^3]

  Bench() : SlabBench(0.5 * kMm), whole(volume::volume_of(session->bone())) {}
  void ticks(int count, double x_mm, double z_mm, double pedal) {
    device::HandState now;
    now.world_from_tool.p = {x_mm * kMm, 0, z_mm * kMm};
    now.pedal = pedal;
    hand->set(now);
    for (int n = 0; n < count; ++n) row = session->servo().tick(false);
  }
  void stroke(double x_mm) {
    ticks(700, x_mm, 4, 0);  // in the air: the stroke before ends
    ticks(200, x_mm, 1, 1);
    ticks(500, x_mm, 4, 0);
  }
  void command(CommandKind kind) {
    session->command({kind, 0});
    ticks(300, 0, 6, 0);
  }
  // by the account, and by the voxels [mm3]
  [[nodiscard]] double told() const { return (row.ledger.removed - row.ledger.undone) / kMm3; }
  [[nodiscard]] double missing() const {
    return (whole - volume::volume_of(session->bone())) / kMm3;
  }
};

TEST(Undone, WhatIsToldIsMissingIsMissing) {
  Bench bench;
  bench.stroke(-3);
  const double one = bench.told();
  ASSERT_GT(one, 0.05);
  bench.stroke(3);
  const double both = bench.told();
  ASSERT_GT(both, one + 0.05);
  EXPECT_NEAR(bench.missing(), both, 1e-6);
  EXPECT_EQ(bench.row.ledger.undone, 0);
  const double removed = bench.row.ledger.removed;
  struct Step {
    CommandKind kind;
    double left;
  };
  for (const auto& [kind, left] :
       {Step{CommandKind::undo, one}, Step{CommandKind::undo, 0}, Step{CommandKind::redo, one},
        Step{CommandKind::redo, both}, Step{CommandKind::undo, one}, Step{CommandKind::reset, 0}}) {
    bench.command(kind);
    EXPECT_NEAR(bench.told(), left, 1e-6) << static_cast<int>(kind);
    EXPECT_NEAR(bench.missing(), left, 1e-6) << static_cast<int>(kind);
  }
  EXPECT_EQ(bench.row.ledger.removed, removed) << "what was removed in all stays in the account";
  bench.stroke(0);
  EXPECT_NEAR(bench.told(), bench.missing(), 1e-6);
  EXPECT_GT(bench.told(), 0.05);
}

}  // namespace
}  // namespace burr::tick
