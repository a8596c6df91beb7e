// haptics/six/slip_limit.h - the stretch of the spring changes in a tick by the hand's own move and a
// little more (ProxySettings::slip), as Proxy::limit_slip has it for a ball alone.
//
// Thread: servo. Frame: world. Units: m. Memory: none.
#pragma once

#include "burr/haptics/touch_method.h"
#include "burr/math/pose.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

class SlipLimit {
 public:
  // slip: per tick [m]; 0: no limit
  explicit SlipLimit(double slip) : slip_(slip) {}

  // The stretch of the next tick is not compared with that of the last.
  void restart() BURR_RT { known_ = false; }
  // applies: false in a tick whose stretch is left as it is. True: `touch` was changed; it is
  // `slipping` where the spring no longer presses on bone.
  bool step(const math::Vec3& hand, bool applies, Touch& touch) BURR_RT;

 private:
  double slip_;
  math::Vec3 last_hand_ = math::Vec3::Zero(), last_stretch_ = math::Vec3::Zero();
  bool known_ = false;  // these two
};

// The same for the spring of turning, for a hand that feels its torque: how far the tool is turned away
// from the hand changes in a tick by the hand's own turn and a little more.
class TurnLimit {
 public:
  void restart() BURR_RT { known_ = false; }
  // turn: of the spring, as a rotation vector; slip: per tick  [rad]
  void step(const math::Quat& hand, double slip, math::Vec3& turn) BURR_RT;

 private:
  math::Quat last_hand_ = math::Quat::Identity();
  math::Vec3 last_turn_ = math::Vec3::Zero();
  bool known_ = false;  // these two
};

}  // namespace burr::haptics
