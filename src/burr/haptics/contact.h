// haptics/contact.h - the result of one tick of touch. Plain struct; world frame, SI.
#pragma once

#include <cstdint>

#include "burr/math/vec3.h"

namespace burr::haptics {

struct Contact {
  math::Vec3 proxy = math::Vec3::Zero();   // centre of the burr head, never inside bone [m]
  math::Vec3 normal = math::Vec3::Zero();  // unit, out of the bone; zero while nothing is touched
  math::Vec3 force = math::Vec3::Zero();   // on the hand, after all limits [N]
  math::Vec3 torque = math::Vec3::Zero();  // the same about the tip, for devices with torque [N m]
  // Of the contact about the tip, which the device did not get: it cannot turn the hand.  [N m]
  math::Vec3 unsent_torque = math::Vec3::Zero();
  // How the tool is turned away from the hand, as a rotation vector.                    [rad]
  math::Vec3 turn = math::Vec3::Zero();
  double depth = 0;    // distance from the hand to the proxy                    [m]
  int active = 0;      // constraints the proxy rests on, 0..3
  int candidates = 0;  // contacts that were examined
  bool touching = false;
  std::uint32_t flags = 0;  // rt/flags.h
};

}  // namespace burr::haptics
