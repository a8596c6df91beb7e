// A slab whose top is z = 0, and a session in real time with a ball of 2 mm above it.
#pragma once

#include <memory>
#include <utility>

#include "burr/device/device.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/sim/session.h"

namespace burr::test {

inline sim::SessionSettings slab_settings() {
  sim::SessionSettings requested;
  requested.realtime = true;
  requested.servo.burr.radius = 2e-3;
  requested.servo.undo_bricks = 512;
  requested.surface.reserve_blocks = 1 << 12;
  return requested;
}

inline Result<std::unique_ptr<sim::Session>> slab_session(
    std::unique_ptr<device::Device> hand, const sim::SessionSettings& requested = slab_settings()) {
  NoProgress quiet;
  return sim::Session::make(
      phantom::bone_from_distance(
          phantom::box_grid(math::Vec3::Constant(-8e-3), math::Vec3::Constant(8e-3), 0.25e-3), {},
          phantom::slab(), 64),
      std::move(hand), requested, quiet);
}

}  // namespace burr::test
