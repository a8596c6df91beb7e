// A session over a slab, with a burr of 2 mm radius and a hand that the test moves.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "burr/device/replayed_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/sim/session.h"

namespace burr::tick::test {

struct SlabBench {
  std::unique_ptr<sim::Session> session;
  device::ReplayedHand* hand = nullptr;
  TickRow row;  // of the last tick

  explicit SlabBench(double voxel) {  // [m]
    NoProgress quiet;
    auto owned = std::make_unique<device::ReplayedHand>(device::DeviceSpec{});
    hand = owned.get();
    sim::SessionSettings settings;
    settings.servo.burr.radius = 2e-3;
    settings.servo.undo_bricks = 512;
    settings.surface.reserve_blocks = 1 << 12;
    auto made = sim::Session::make(
        phantom::bone_from_distance(
            phantom::box_grid(math::Vec3::Constant(-8e-3), math::Vec3::Constant(8e-3), voxel), {},
            phantom::slab(), 64),
        std::move(owned), settings, quiet);
    EXPECT_TRUE(made.ok());
    session = std::move(*made);
  }
};

}  // namespace burr::tick::test
