// surgeon/surgeon_hand.h - the hand of a scripted surgeon: goes a way, makes strokes that press with
// a force, lifts where the goal ends, and is unsteady.
//
//     hand = intended place + tremor + drift
//
// A stroke runs to and fro along a line while the hand presses across it: the pressing speed is
// (wanted force - felt force) / kYield, never faster than the goal ahead allows. Where the goal has
// ended, the hand lifts along the way out, the surgeon's stop delay later: away from the bone that it
// presses on could be into what must stay. What pushes against the way slows it down.
// Nothing here knows the bone; the goal (plan.h) is what the surgeon believes. A hand that adds material
// presses in the same way; for it the goal has ended where the place at which the burr touches has
// come up to the border of the plan (fill_work.h); then the foot leaves the pedal too.
//
// Frame: world. Units: SI. Thread: state(), write_force() servo, without allocation; all else on the
// thread that runs the ticks, between two of them, or before.
#pragma once

#include <array>
#include <cstddef>

#include "burr/device/device.h"
#include "burr/surgeon/plan.h"
#include "burr/surgeon/skill.h"
#include "burr/surgeon/unsteady.h"

namespace burr::surgeon {

struct Stroke {
  static constexpr int kMostWay = 4;
  std::array<math::Vec3, kMostWay> way = {};  // points on the way to the start
  int points = 0;
  bool idle_way = false;  // foot off the pedal on the way
  math::Vec3 start = math::Vec3::Zero();
  math::Vec3 along = math::Vec3::UnitX();  // unit, across `into`
  math::Vec3 into = -math::Vec3::UnitZ();  // unit, into the bone
  math::Vec3 out =
      math::Vec3::UnitZ();  // unit, the way out of the plan on which it gets no narrower
  double length = 5e-3;
  math::Vec3 shaft = math::Vec3::UnitZ();  // unit, from the burr's head to the hand
};

class SurgeonHand final : public device::Device {
 public:
  // How far below the border a place must lie [m], so that what a burr of this radius adds there ends
  // about level with it; negative where it may lie above. down: how much of the direction from the
  // burr to the place goes into the bone; 1 on a floor, 0 at a wall, where material rises higher.
  [[nodiscard]] static double ring(double radius, double down) BURR_RT;
  // dt: of a tick [s]. at: where it begins.
  SurgeonHand(const Skill& skill, double dt, std::uint64_t seed, const math::Vec3& at,
              const math::Vec3& shaft);

  // ---- of the surgeon, between ticks
  // goal, near: kept by reference until the next call, while the hand works.
  // adds: the goal is to be filled.
  void look_at(const FieldGrid* goal, const FieldGrid* near, bool adds = false);
  void begin(const Stroke& stroke, double burr_radius);
  // Out along `out` to a distance, and wait there with the pedal up.
  void retreat(const math::Vec3& out, double distance);
  void finish() { finished_ = true; }
  // True: it waits, or has gone to and fro for kBout.
  [[nodiscard]] bool free() const { return phase_ == Phase::waiting || stroked_ > kBout; }
  // Time since this bout met the bone [s].
  [[nodiscard]] double stroked() const { return phase_ == Phase::stroking ? stroked_ : 0; }
  [[nodiscard]] bool waiting() const { return phase_ == Phase::waiting; }
  [[nodiscard]] const math::Vec3& intended() const { return at_; }

  // ---- Device
  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const device::DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] device::HandState state(double dt) BURR_RT override;
  void write_force(const math::Vec3& force) BURR_RT override { force_ = force; }
  [[nodiscard]] bool finished() const BURR_RT override { return finished_; }

 private:
  enum class Phase { waiting, going, stroking };
  static constexpr double kBout = 1.5;          // [s]
  static constexpr std::size_t kMemory = 1024;  // ticks of the goal that are remembered

  void go(double dt) BURR_RT;
  void stroke(double dt) BURR_RT;
  void turn(bool at_end) BURR_RT;
  void reach_bone() BURR_RT;
  [[nodiscard]] double room(const math::Vec3& p) const BURR_RT;

  device::DeviceSpec spec_;
  Skill skill_;
  Tremor tremor_;
  Drift drift_;
  UnevenForce uneven_;
  const FieldGrid *goal_ = nullptr, *near_ = nullptr;
  Phase phase_ = Phase::waiting;
  Stroke stroke_;
  double radius_ = 1e-3;
  int next_ = 0;        // of the points on the way
  double done_ = 0;     // along the stroke [m]
  double sense_ = 1;    // +1 forwards, -1 back
  double stroked_ = 0;  // time of this stroke [s]
  double turned_ = 0;   // where along the stroke it last turned [m]
  double held_up_ = 0;  // for so long [s]
  int brief_ = 0;       // turns of late with hardly a way between them
  bool finished_ = false, leaving_ = false, adds_ = false;
  bool full_ = false;  // what is filled has come up to the plan, as the surgeon saw a delay ago
  math::Vec3 at_, last_, force_ = math::Vec3::Zero(), shaft_;
  std::array<float, kMemory> rooms_ =
      {};  // how much goal was left under the burr, tick by tick [m]
  std::size_t tick_ = 0, delay_ = 0;
};

}  // namespace burr::surgeon
