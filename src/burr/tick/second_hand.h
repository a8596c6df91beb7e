// tick/second_hand.h - another device in the other hand, which feels the bone and never changes it:
// a suction tube, a probe.
//
// A ball at its tip rests on the bone as the burr does, with its own proxy, law of force and safety
// layer (hand.h). It is stepped in the servo's tick after the first hand's force has gone out, and
// nothing of the bone or of the first hand depends on it: a recording replays to the bit without
// it. The two tools do not feel each other.
//
// Thread: step() on the servo; view(), faults() one reader each, any. Frame: world. Memory: taken
// at construction. Cost: docs/realtime.md.
#pragma once

#include <cstdint>

#include "burr/device/device.h"
#include "burr/haptics/force_law.h"
#include "burr/haptics/proxy.h"
#include "burr/haptics/safety/limit.h"
#include "burr/rt/latest.h"
#include "burr/rt/rt.h"
#include "burr/tick/fault_report.h"
#include "burr/tick/hand.h"
#include "burr/tick/rows.h"

namespace burr::tick {

struct SecondHandSettings {
  double radius = 1.5e-3;        // of the ball at its tip, at least two voxels            [m]
  haptics::ForceSettings force;  // capped by the device's own
  double friction = 0.1;         // of metal on wet bone: hardly any                       [-]
  double slip_m_s = 30e-3;       // as ServoSettings::slip_m_s                           [m/s]
  double velocity_filter_hz = 100;
  haptics::LimitSettings limit;
};

class SecondHand {
 public:
  // device: open
  SecondHand(const volume::IsoVertices& surface, device::Device& device,
             const SecondHandSettings& settings, double rate_hz);

  // One tick. lost: as Servo::tick(). parted: bone may come back where it is (an undo): the force
  // is released until the hand is in free air again.
  void step(bool lost, bool parted) BURR_RT;

  // Its hand and contact, as the servo's row has the burr's; the rest is as it begins.
  [[nodiscard]] const TickRow& row() const BURR_RT { return row_; }
  [[nodiscard]] rt::Latest<TickRow>& view() BURR_RT { return view_; }
  [[nodiscard]] rt::Latest<FaultReport>& faults() BURR_RT { return hand_.faults().reports(); }

 private:
  SecondHandSettings settings_;
  haptics::Proxy proxy_;
  Hand hand_;
  std::uint64_t next_tick_ = 0;
  TickRow row_;
  rt::Latest<TickRow> view_;
};

}  // namespace burr::tick
