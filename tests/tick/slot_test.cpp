// A burr cuts a slot deeper than its diameter, layer by layer. Then it is stopped, and goes back
// down: the cut is wider than the burr by a clearance, so the burr comes to the bottom.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "burr/base/check.h"
#include "burr/device/replayed_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/sim/session.h"
#include "burr/tick/servo.h"
#include "burr/volume/sample.h"

namespace burr::tick {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kRadius = 2 * kMm, kDepth = 6 * kMm;

struct Case {
  double energy;     // of the bone [J/m^3]
  double angle_deg;  // of the slot against the surface's normal
  double voxel;      // [m]
};

// The slot lies along x. Its depth is measured along `into`, from where the tip of the burr touches
// the surface of z < 0.
class SlotCutter {
 public:
  explicit SlotCutter(const Case& one)
      : into(0, std::sin(one.angle_deg * std::numbers::pi / 180),
             -std::cos(one.angle_deg * std::numbers::pi / 180)),
        lead_(kRadius / -into.z() + 0.5 * kMm) {
    volume::TissueTable tissues;
    tissues.tissues.resize(2);
    tissues.tissues[1].name = "bone";
    tissues.tissues[1].kind = volume::TissueKind::solid;
    tissues.tissues[1].cutting_energy = one.energy;
    auto owned = std::make_unique<device::ReplayedHand>(device::DeviceSpec{});
    hand_ = owned.get();
    sim::SessionSettings settings;
    settings.servo.burr.radius = kRadius;
    settings.servo.undo_bricks = 4096;
    NoProgress quiet;
    auto made = sim::Session::make(
        phantom::bone_from_distance(
            phantom::box_grid(Vec3(-4, -4, -10) * kMm, Vec3(12, 9, 2) * kMm, one.voxel), tissues,
            phantom::slab(), 4096),
        std::move(owned), settings, quiet);
    BURR_CHECK(made.ok());
    session_ = std::move(*made);
  }

  // Where the burr's centre is when its tip is this deep, x along the slot.
  [[nodiscard]] Vec3 at(double x, double depth) const {
    return Vec3(x, 0, 0) + into * (depth - kRadius);
  }
  [[nodiscard]] double depth_of(const Vec3& centre) const { return centre.dot(into) + kRadius; }
  [[nodiscard]] double above() const { return kRadius - lead_; }  // depth clear of the bone

  // each(row) after every tick
  template <class Each>
  void move(const Vec3& from, const Vec3& to, double seconds, bool turning, const Each& each) {
    const int ticks = static_cast<int>(seconds * 1000);
    for (int n = 1; n <= ticks; ++n) {
      device::HandState now;
      now.world_from_tool.p = from + (to - from) * n / ticks;
      now.pedal = turning ? 1 : 0;
      hand_->set(now);
      each(session_->servo().tick(false));
    }
  }

  // Width of the slot across it, at x and this depth [m].
  [[nodiscard]] double width(double x, double depth) const {
    const Vec3 middle = Vec3(x, 0, 0) + into * depth, across(0, -into.z(), into.y());
    const volume::Bone& bone = session_->bone();
    double wide = 0;
    for (const double side : {-1.0, 1.0})
      for (double y = 0; y < 4 * kMm; y += 2e-6, wide += 2e-6)
        if (volume::sample(bone, bone.grid().grid_from_world(middle + side * y * across)) >=
            volume::kIsoShare)
          break;
    return wide;
  }

  const Vec3 into;  // unit

 private:
  double lead_;  // from the surface to the burr's centre where the work begins, along `into`
  device::ReplayedHand* hand_ = nullptr;
  std::unique_ptr<sim::Session> session_;
};

class Slot : public testing::TestWithParam<Case> {};

TEST_P(Slot, AStoppedBurrComesBackToItsBottom) {
  constexpr double kLong = 8 * kMm, kMiddle = 4 * kMm;
  constexpr int kLayers = 24;
  SlotCutter cutter(GetParam());
  double cut_to = -std::numeric_limits<double>::infinity();  // in the middle of the slot
  const auto cutting = [&](const TickRow& row) {
    if (std::abs(row.contact.proxy.x() - kMiddle) < 0.1 * kMm)
      cut_to = std::max(cut_to, cutter.depth_of(row.contact.proxy));
  };
  Vec3 at = cutter.at(0, cutter.above());
  for (int layer = 1; layer <= kLayers; ++layer) {
    const double depth = cutter.above() + (kDepth - cutter.above()) * layer / kLayers;
    const Vec3 down = cutter.at(at.x(), depth), along = cutter.at(kLong - at.x(), depth);
    cutter.move(at, down, 0.2, true, cutting);
    cutter.move(down, along, 4, true, cutting);
    at = along;
  }
  ASSERT_GT(cut_to, 2 * kRadius + 1 * kMm) << "the slot was not cut";

  const Vec3 out = cutter.at(at.x(), cutter.above() - 1 * kMm),
             over = cutter.at(kMiddle, cutter.above() - 1 * kMm);
  const auto nothing = [](const TickRow&) {};
  cutter.move(at, out, 2, true, nothing);
  cutter.move(out, over, 1, false, nothing);
  cutter.move(over, over, 2, false, nothing);  // until it stands
  double reached = -std::numeric_limits<double>::infinity(), felt = 0;
  cutter.move(over, cutter.at(kMiddle, cut_to - 0.1 * kMm), 6, false, [&](const TickRow& row) {
    reached = std::max(reached, cutter.depth_of(row.contact.proxy));
    felt = row.contact.force.norm();
  });
  EXPECT_GT(reached, cut_to - 0.15 * kMm) << "it was cut to " << cut_to;
  EXPECT_LT(felt, 0.2) << "the walls hold the burr";
  // below the rim, above the round bottom
  for (double depth = 2.5 * kMm; depth < cut_to - kRadius; depth += 0.5 * kMm)
    EXPECT_GT(cutter.width(kMiddle, depth), 2 * kRadius + 2 * 0.05 * GetParam().voxel) << depth;
}

INSTANTIATE_TEST_SUITE_P(Bones, Slot,
                         testing::Values(Case{0.1e9, 0, 0.3 * kMm}, Case{0.1e9, 30, 0.25 * kMm},
                                         Case{0.1e9, 45, 0.2 * kMm}, Case{0.3e9, 45, 0.25 * kMm},
                                         Case{0.3e9, 45, 0.4 * kMm}),
                         [](const testing::TestParamInfo<Case>& one) {
                           return "Bone" + std::to_string(one.index);
                         });

}  // namespace
}  // namespace burr::tick
