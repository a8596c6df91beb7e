// workshop/arm_publisher.h - publishes a session as a CRTK arm: the newest row of the tick, up to a
// thousand times a second.
//
//     const ArmPublisher publisher(session, arm, [&] { return hand.busy(); });
//
// Thread: main. Make it before the session runs; destroy it after the session has stopped.
#pragma once

#include <functional>
#include <memory>
#include <thread>

#include "burr/device/crtk/arm.h"
#include "burr/rt/latest.h"
#include "burr/sim/session.h"

namespace burr::workshop {

class ArmPublisher {
 public:
  // busy: returns true while the arm moves by itself; empty: it never does
  ArmPublisher(sim::Session& session, device::crtk::Arm& arm, std::function<bool()> busy = {});
  ~ArmPublisher();
  ArmPublisher(const ArmPublisher&) = delete;
  ArmPublisher& operator=(const ArmPublisher&) = delete;

 private:
  sim::Session& session_;
  rt::Latest<tick::TickRow> rows_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace burr::workshop
