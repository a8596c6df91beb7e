// haptics/tool_contact.h - what a tool of several parts says of its contact beside a Touch: which
// parts carry the load, and the torque.
//
// A Touch is the sum: the stretch of the spring between hand and tool. Where parts that never cut (a
// shaft, the body of a blade) touch as well, the sum does not say how hard the cutting parts press.
// Frame: world. Units: m; a length of spring times its stiffness k_t is a force. Plain structs.
#pragma once

#include <array>

#include "burr/math/pose.h"
#include "burr/math/vec3.h"

namespace burr::haptics {

// One point of bone on which the tool rests. Where many points carry a flat face, their loads are one
// of many possible sets; only their sum means something.
struct SixContact {
  int part = 0;                            // of the tool
  math::Vec3 normal = math::Vec3::Zero();  // unit, from the bone to the tool
  math::Vec3 arm = math::Vec3::Zero();     // w: from the tool's origin to the point   [m]
  math::Vec3 lever = math::Vec3::Zero();   // w x n                                    [m]
  double load = 0;                         // force / k_t                              [m]
};

struct ToolContact {
  bool rests = false;    // a part that never cuts carries some of the load
  bool by_part = false;  // the loads are known part by part: `head`, `torque`, `contacts`
  // The part of the stretch that the contacts of cutting parts carry.  [m]
  math::Vec3 head = math::Vec3::Zero();
  // L of the spring of turning: k_r = k_t L^2.  [m]
  double lever = 0;
  // About the tool's origin, over k_t.  [m^2]
  math::Vec3 torque = math::Vec3::Zero();
  // How the tool is turned away from the hand, as a rotation vector.  [rad]
  math::Vec3 turn = math::Vec3::Zero();
  int active = 0;
  std::array<SixContact, 6> contacts;
};

}  // namespace burr::haptics
