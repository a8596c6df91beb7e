// tick/law_call.h - asks a custom law in a tick, and believes only what can be.
//
// Thread: servo. Frame: world. Units: SI. Memory: none.
#pragma once

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/tick/controls.h"
#include "burr/tick/hand.h"
#include "burr/tick/own_law.h"
#include "burr/tick/rows.h"
#include "burr/tick/settings.h"
#include "burr/volume/bone.h"

namespace burr::tick {

// False: a number is not finite, beyond the bounds of law_v1.h, or a torque below 0.
[[nodiscard]] bool possible(const burr_law_out_v1& out) BURR_RT;

class LawCall {
 public:
  // Asks controls.settings.law, if there is one.
  LawCall(const volume::Bone& bone, const Controls& controls, const Hand& hand);

  // The force of touch, unbounded: of the own law where it acts in this tick, otherwise of burr's.
  // feels: the hand was asked what it feels. spin: of the spindle [rad/s].
  [[nodiscard]] math::Vec3 wanted(bool feels, double spin) BURR_RT;
  // What it answered in this tick.
  [[nodiscard]] const LawRow& row() const BURR_RT { return row_; }
  // It gave an answer that cannot be, in this tick or an earlier one.
  [[nodiscard]] bool off() const BURR_RT { return off_; }
  // In this tick, for the first time.
  [[nodiscard]] bool failed_now() const BURR_RT { return failed_now_; }

 private:
  [[nodiscard]] burr_law_in_v1 input(double spin) const BURR_RT;

  const volume::Bone& bone_;
  const ServoSettings& settings_;
  const Hand& hand_;
  LawRow row_;
  bool off_ = false, failed_now_ = false;
};

}  // namespace burr::tick
