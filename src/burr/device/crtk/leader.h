// device/crtk/leader.h - a robot's arm as the hand: any that speaks CRTK (dVRK's leader arms, a lab
// device behind a CRTK node), on DDS with the names of ROS 2.
//
//     <arm>/measured_cp -> the hand            the force -> <arm>/body/servo_cf, each reading
//
// Frame: the arm's own base, metres; how it lies before the view is the user's to say (mapping.h).
// The force is turned into the frame of the arm's end, as body/servo_cf has it; an arm that takes
// only spatial/servo_cf gets the wrench of that force about its base. An arm that is not enabled or
// not homed is left so unless its owner allowed it to move. gripper/closed mills (button 0),
// /footpedals/clutch lifts (button 1), /footpedals/coag is the pedal, and where
// /console/operator_present speaks the hand is lifted while nobody is there.
// Where somebody else writes the arm's forces it is left to him, and let go should he come later:
// the arm would obey now one and now the other. CRTK knows no time limit on a force: a guardian
// takes it back should burr die (guardian.h).
//
// Source: CRTK Robot API (operating state, motion), dVRK API 2.x. Thread: as Wire. Memory: the
// wire's own, a message at a time; none in the tick.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/device/wire.h"

namespace burr::device::crtk {

struct LeaderSettings {
  std::string arm = {};       // its namespace, /MTMR; empty: the only one that is there
  int domain = -1;            // of DDS; below 0: ROS_DOMAIN_ID, else 0
  bool home_allowed = false;  // it may be enabled and home itself: it moves
};

// Every arm that is heard on the bus within a second and a half; nothing is said to any.
[[nodiscard]] Result<std::vector<std::string>> arms_heard(const LeaderSettings& settings = {});

class Leader final : public Wire {
 public:
  explicit Leader(LeaderSettings settings = {});
  ~Leader() override;

  [[nodiscard]] Result<DeviceSpec> connect() override;
  [[nodiscard]] Read read(HandState& hand) BURR_RT override;
  [[nodiscard]] bool write(const math::Vec3& force) BURR_RT override;
  void disconnect() override;
  [[nodiscard]] std::string why() const override;
  [[nodiscard]] unsigned told() const BURR_RT override { return told_; }

 private:
  struct Talk;
  void note(const char* words) BURR_RT;
  [[nodiscard]] Status prepare(Talk& talk);

  LeaderSettings settings_;
  std::unique_ptr<Talk> talk_;
  std::string name_ = "the arm";
  const char* trouble_ = nullptr;
  unsigned told_ = 0;
};

}  // namespace burr::device::crtk
