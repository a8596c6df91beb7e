// device/crtk/leader.h - a robot arm as the hand: any arm that speaks CRTK (leader arms of the
// dVRK, a lab device behind a CRTK node), over DDS with the topic names of ROS 2.
//
//     <arm>/measured_cp -> the hand            the force -> <arm>/body/servo_cf, each reading
//
// Frame: the arm's own base, metres. The user says how the base lies relative to the view
// (mapping.h). The force is rotated into the frame of the arm's end, as body/servo_cf needs it. An
// arm that takes only spatial/servo_cf gets the wrench of that force about its base. A torque goes
// along where the user says that the arm takes one: about its end in the first, about its base, p x F +
// tau, in the second. An arm that is
// not enabled or not homed stays so, unless the user allowed it to move (home_allowed).
// gripper/closed mills (button 0), /footpedals/clutch lifts the hand (button 1), /footpedals/coag
// is the pedal. Where /console/operator_present is published, the hand is lifted while no operator
// is there. If another program writes the arm's forces, this one does not; if another one starts
// later, this one stops. Otherwise the arm would obey both in turn. CRTK has no time limit on a
// force, so a guardian releases it if burr dies (guardian.h).
//
// Source: CRTK Robot API (operating state, motion), dVRK API 2.x. Thread: as Wire. Memory:
// allocated on the wire's thread, one message at a time; none in the tick.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "burr/device/wire.h"

namespace burr::device::crtk {

inline constexpr const char* kArmName = "CRTK arm";  // in DeviceSpec

struct LeaderSettings {
  std::string arm = {};  // its namespace, /MTMR; empty: the only arm on the bus
  int domain = -1;       // DDS domain; below 0: ROS_DOMAIN_ID, else 0
                         // (of this computer alone, unless the environment asks for more: reach.h)
  bool home_allowed = false;  // the arm may be enabled and may home itself: it moves
  // The largest torque that the arm of this name takes [N m]; 0: none. CRTK does not tell, so the user
  // says it. nullptr: none takes any. Called in connect().
  std::function<double(const std::string& arm)> takes_torque = {};
};

// The arms that are heard on the bus within 1.5 seconds. Nothing is sent to any of them.
[[nodiscard]] Result<std::vector<std::string>> list_arms(const LeaderSettings& settings = {});

class Leader final : public Wire {
 public:
  explicit Leader(LeaderSettings settings = {});
  ~Leader() override;

  [[nodiscard]] Result<DeviceSpec> connect() override;
  [[nodiscard]] Read read(HandState& hand) BURR_RT override;
  void write_torque(const math::Vec3& torque) BURR_RT override { torque_ = torque; }
  [[nodiscard]] bool write(const math::Vec3& force) BURR_RT override;
  void disconnect() override;
  [[nodiscard]] std::string why() const override;
  [[nodiscard]] unsigned why_revision() const BURR_RT override { return why_revision_; }

 private:
  struct Connection;
  void note(const char* words) BURR_RT;
  [[nodiscard]] Status prepare(Connection& connection);

  LeaderSettings settings_;
  std::unique_ptr<Connection> connection_;
  math::Vec3 torque_ = math::Vec3::Zero();  // of the next force [N m]
  double peak_torque_ = 0;
  std::string name_ = "the arm";
  const char* trouble_ = nullptr;
  unsigned why_revision_ = 0;
};

}  // namespace burr::device::crtk
