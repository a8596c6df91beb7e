// workshop/arm_publisher.h - a session told to others as a CRTK arm: what the tick's newest row says,
// up to a thousand times a second.
//
//     auto told = ArmPublisher::begin(session, arm, [&] { return hand.busy(); });
//
// Thread: main; begin before the session runs, end after it stands.
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
  // busy: whether it moves by itself just now; empty: never
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
