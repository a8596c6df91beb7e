// web/work_of_page.h - what the page works on: the bone and the place where milling begins. The same
// for the worker that ticks (core_api.cpp) and the page that draws (view_api.cpp).
//
// Units: SI. Frame: world (LPS).
#pragma once

#include <cstdint>

#include "burr/math/vec3.h"
#include "burr/phantom/phantoms.h"
#include "burr/volume/bone.h"

namespace burr::web {

inline constexpr double kBurrRadius = 2.5e-3;  // [m]
inline constexpr double kRate = 1000;          // of ticks [Hz]

// cases/temporal_bone.toml: where its work begins, and into what direction
inline math::Vec3 work_at() { return {-2e-3, 11e-3, 5e-3}; }
inline math::Vec3 work_into() { return {1, 0, 0}; }

inline constexpr const char* kCase = "temporal-bone";
inline constexpr double kRpm = 80000;

// A brick that was cut, on its way from the worker that ticks to the one that looks at the steps.
struct ChangedBrick {
  std::int32_t brick;
  volume::Field field[volume::kBrickVoxels];
};

// Its bone.
inline constexpr const char* kPhantom = "phantom:temporal-bone?ridge-dura";
inline phantom::Phantom phantom_of_page(double voxel) {
  phantom::Variant variant;
  variant.add("ridge-dura", std::nullopt);
  return phantom::temporal_bone(voxel, variant);
}

}  // namespace burr::web
