// haptics/safety/energy_guard.h - the virtual world gives the hand no more energy than it received.
//
//     hand --- work done on the world --> [ stored in the spring V ] --- losses --> [ tank S ]
//                                                    | E < V: more is stored than was received
//                                                    v
//                                          a damper takes it back      F <- F - alpha v
//
// Observer (Hannaford & Ryu, IEEE Trans. Robot. Autom. 18, 2002): E += -F.dx, F: the force that was
// really sent during dx. As a force is held between ticks, this is the exact work, not an estimate.
//
// Reference form (Ryu, Preusche, Hannaford & Hirzinger, IEEE Trans. Control Syst. Technol. 13,
// 2005): E is compared with V, the energy that the spring could give back now, not with zero. V = k
// s^2 / 2 up to the largest force that is sent, linear beyond. The plain form acts only when E < 0;
// after a minute of friction and cutting E is so high that a wall may tremble for seconds before
// the guard acts. Here all energy above V counts as lost: it leaves E for the tank (which is
// small), so E never exceeds V, and the guard sees the first sample at which the wall gives too
// much. A sampled spring owes k dx^2 / 2 each tick; a damper of k T / 2 pays for it, the same that
// the stability border k < 2 (b + B) / T requires.
//
// Controller: alpha = min((V - E) / (T |v|^2), alpha_max), zero below least_speed. v is the move of
// this tick over T, unfiltered: with the lag of a filter the damper could push where it should
// brake. The steps of an encoder are the reason why alpha_max depends on encoder_step. The observer
// counts the work of this damper, because it is part of the force sent; adding alpha T |v|^2 to E
// explicitly, as in formulations that compute E before the controller, would count it twice.
//
// Tank (Franken, Stramigioli et al., IEEE Trans. Robot. 27, 2011): S' = lost - given to active
// terms, 0 <= S <= tank_full. Active terms (bone that grows under the burr, guidance) call allow()
// first.
//
// Guarantee at every tick, whatever the hand, the forces and the limits after the guard do:
//
//     work done by the hand  >=  - deficit() - written_off() - lost in the device itself
//
// deficit() is k dx^2 / 2 of the last tick while alpha_max suffices and the hand moves faster than
// least_speed; below that speed it may grow by k T v^2 / 2 per second, 2 uW for 1 kN/m.
// written_off() is the sum of the energy stored when the account began, a deficit after free_time
// in free air, and what is above tank_full; so no hand feels heavy for long.
//
// A tool that turns: V also holds k_r |turn|^2 / 2. A device that can turn the hand does the work
// F.dx + tau.dtheta, and both are counted. One that only pushes gets F alone, and lets itself be turned
// against a contact for nothing: a shaft turned into a wall, pushed out and turned back gives the hand
// k(l) (l beta)^2 / 2, k(l) = 1 / (1/k_t + l^2/k_r), each time round, and any closed path gives
// -oint tau.dtheta. That energy is taken from a store of its own, which begins full, is filled again by
// turning back against the contact, by losses, and slowly by itself; while it runs low the force fades
// in proportion. So the hand gets no more than turn_full + turn_refill t in this way.
//
// slack: a deficit up to this value is remembered but not acted on. While bone is cut, the force
// changes direction by itself from tick to tick and owes some microjoules for a moment, which the
// cut then pays back many times over; a damper that takes each of them back at once is felt as
// blows. A wall that trembles owes more and more. The guarantee is weaker by the slack. Vibration
// (vibration.h) is not counted: pass sent() the force without it.
//
// Thread: servo. Frame: world. Units: SI. Memory: none. Cost: under 0.2 us a tick.
#pragma once

#include <array>
#include <cstddef>

#include "burr/math/pose.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

struct EnergyGuardSettings {
  // Of the device, as felt at the tip [kg]. 45 g is the maker's figure for the PHANToM Omni, the
  // lightest device in use; a heavier device allows more damping, so this default is safe for it.
  double device_mass = 0.045;
  double device_damping = 0;   // of the device's own joints; set only if measured        [N s/m]
  double encoder_step = 0;     // at the tip; 0: too fine to matter                           [m]
  double count_force = 0.1;    // the damper's most for one step in a tick; the joints' dry
                               // friction hides it, 0.26 N in an Omni                        [N]
  double delay = 0;            // from hand to force, beyond the held tick; up to 7 ticks     [s]
  double slack = 0;            // deficit that is tolerated: see above                        [J]
  double least_speed = 2e-3;   // below it the velocity is mostly noise: no damping         [m/s]
  double largest_force = 3.3;  // that is ever sent: by the device's and the user's limit    [N]
  double free_time = 50e-3;    // in free air until a deficit is written off                 [s]
  double tank_full = 2e-3;     // at most 10 mJ, a light tap                                 [J]
  double tank_low = 0.5e-3;    // active terms fade below this                               [J]
  // For a tool that turns, on a device that only pushes:
  double turn_full = 2e-3;      // what its free turns may bring in at once                  [J]
  double turn_refill = 0.5e-3;  // and all the time: two strokes a second bring 0.4 mW       [W]
  double turn_low = 0.5e-3;     // the force fades below this                                [J]
  double largest_torque = 0;    // that is ever sent; 0: none                              [N m]
};

// Result of touch in this tick, before vibration and limits.
struct SpringState {
  math::Vec3 hand = math::Vec3::Zero();     // [m]
  math::Vec3 stretch = math::Vec3::Zero();  // from hand to proxy                          [m]
  double stiffness = 0;                     // of the spring                             [N/m]
  math::Vec3 force = math::Vec3::Zero();    // computed by touch                           [N]
  // Of a tool that turns.
  math::Quat hand_turn = math::Quat::Identity();  // world_from_hand
  math::Vec3 torque = math::Vec3::Zero();         // of the contact about the tip        [N m]
  double turn_stiffness = 0;                      // of its spring; 0: a ball        [N m/rad]
};

class EnergyGuard {
 public:
  explicit EnergyGuard(const EnergyGuardSettings& settings = {});

  // Returns a passive force, as far as can be known. dt: this tick [s]. If an input is not finite
  // the force is returned unchanged, for the safety layer to handle, and the account starts again.
  [[nodiscard]] math::Vec3 step(const SpringState& now, double dt) BURR_RT;

  // The force and torque the hand really got in this tick, after all limits, without vibration and
  // the motor's twist. Call once a tick.
  void sent(const math::Vec3& force, const math::Vec3& torque = math::Vec3::Zero()) BURR_RT;

  // How much of `wanted_energy` an active term may add now [J]; it is taken from the tank. Request
  // no more than the term raises the spring's energy by; what is not used flows back.
  [[nodiscard]] double allow(double wanted_energy) BURR_RT;

  // The hand was lost or no force was sent: starts the account again. The tank keeps its content.
  void restart() BURR_RT;

  void set_largest_force(double newton) BURR_RT;
  // 0: no torque is sent.
  void set_largest_torque(double newton_metre) BURR_RT;

  [[nodiscard]] double energy() const BURR_RT { return energy_; }             // E, at most V    [J]
  [[nodiscard]] double stored() const BURR_RT { return stored_; }             // V               [J]
  [[nodiscard]] double deficit() const BURR_RT { return stored_ - energy_; }  // V - E >= 0      [J]
  [[nodiscard]] double tank() const BURR_RT { return tank_; }                 // S               [J]
  [[nodiscard]] double damping() const BURR_RT { return alpha_; }             // alpha now [N s/m]
  // Energy that free turns have brought in so far, and what is left of their store.
  [[nodiscard]] double turned_in() const BURR_RT { return turned_in_; }  //                [J]
  [[nodiscard]] double turn_left() const BURR_RT { return turn_left_; }  //                [J]
  [[nodiscard]] bool fades() const BURR_RT { return share_ < 1; }        // the force, in this tick
  [[nodiscard]] double work_in() const BURR_RT { return work_in_; }  // by the hand, so far      [J]
  [[nodiscard]] double written_off() const BURR_RT { return written_off_; }        //            [J]
  [[nodiscard]] double lost_in_device() const BURR_RT { return lost_in_device_; }  //            [J]

 private:
  static constexpr std::size_t kSent = 8;  // forces kept, for the delay

  struct Push {
    math::Vec3 force = math::Vec3::Zero(), torque = math::Vec3::Zero();
  };
  [[nodiscard]] Push acting(double dt) const BURR_RT;
  [[nodiscard]] double spring_energy(const SpringState& now) const BURR_RT;
  void observe(const SpringState& now, double dt) BURR_RT;
  void lend(const math::Vec3& torque, const math::Vec3& turned) BURR_RT;
  [[nodiscard]] math::Vec3 faded(const math::Vec3& force) BURR_RT;
  void settle(double dt) BURR_RT;
  void forget_when_free(const SpringState& now, double dt) BURR_RT;
  [[nodiscard]] double most_damping(double dt) const BURR_RT;

  EnergyGuardSettings settings_;
  std::array<Push, kSent> sent_;
  std::size_t newest_ = 0;
  math::Vec3 last_hand_ = math::Vec3::Zero();
  math::Vec3 velocity_ = math::Vec3::Zero();  // of the last tick [m/s]
  math::Quat last_turn_ = math::Quat::Identity();
  math::Vec3 last_torque_ = math::Vec3::Zero();  // of the contact, sent or not [N m]
  double turned_in_ = 0, turn_left_ = 0, share_ = 1;
  bool begun_ = false;
  double energy_ = 0, stored_ = 0, tank_ = 0, alpha_ = 0;
  double granted_ = 0;  // allowed, not yet seen as an increase of V [J]
  double free_ = 0;     // time without contact so far [s]
  double work_in_ = 0, written_off_ = 0, lost_in_device_ = 0;
};

}  // namespace burr::haptics
