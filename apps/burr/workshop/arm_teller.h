// apps/burr/workshop/arm_teller.h - a session told to others as a CRTK arm: what the tick's newest row says,
// up to a thousand times a second.
//
//     auto told = ArmTeller::begin(session, arm, [&] { return hand.busy(); });
//
// Thread: main; begin before the session runs, end after it stands.
#pragma once

#include <functional>
#include <memory>
#include <thread>

#include "burr/device/crtk/arm.h"
#include "burr/rt/latest.h"
#include "burr/sim/session.h"

namespace burr::app {

class ArmTeller {
 public:
  // busy: whether it moves by itself just now; empty: never
  ArmTeller(sim::Session& session, device::crtk::Arm& arm, std::function<bool()> busy = {});
  ~ArmTeller();
  ArmTeller(const ArmTeller&) = delete;
  ArmTeller& operator=(const ArmTeller&) = delete;

 private:
  sim::Session& session_;
  rt::Latest<tick::TickRow> rows_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace burr::app
