// haptics/contact.h - what one tick of touch found out. Plain struct; world frame, SI.
#pragma once

#include <cstdint>

#include "burr/math/vec3.h"

namespace burr::haptics {

struct Contact {
  math::Vec3 proxy = math::Vec3::Zero();   // centre of the burr head, never inside bone [m]
  math::Vec3 normal = math::Vec3::Zero();  // unit, out of the bone; zero while nothing is touched
  math::Vec3 force = math::Vec3::Zero();   // what the hand gets, after all limits [N]
  math::Vec3 torque = math::Vec3::Zero();  // likewise about the tip, where it can be felt [N m]
  double depth = 0;    // how far the hand is from the proxy                     [m]
  int active = 0;      // constraints the proxy rests on, 0..3
  int candidates = 0;  // contacts looked at
  bool touching = false;
  std::uint32_t flags = 0;  // rt/flags.h
};

}  // namespace burr::haptics
