#include "burr/workshop/arm_publisher.h"

#include <chrono>
#include <utility>

namespace burr::workshop {
namespace {

device::crtk::ArmReport told_of(const tick::TickRow& row) {
  device::crtk::ArmReport told;
  told.setpoint = row.hand.world_from_tool;
  told.measured = {row.contact.proxy, row.hand.world_from_tool.q};
  told.velocity = row.hand.velocity;
  told.force = row.contact.force;
  return told;
}

}  // namespace

ArmPublisher::ArmPublisher(sim::Session& session, device::crtk::Arm& arm,
                           std::function<bool()> busy)
    : session_(session) {
  session_.set_watch(&rows_);
  thread_ = std::thread([this, &arm, busy = std::move(busy)] {
    tick::TickRow row;
    while (!stop_) {
      if (rows_.take(row)) {
        device::crtk::ArmReport told = told_of(row);
        told.busy = busy && busy();
        told.let_go = session_.servo().let_go();
        arm.tell(told);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
}

ArmPublisher::~ArmPublisher() {
  stop_ = true;
  thread_.join();
  session_.set_watch(nullptr);
}

}  // namespace burr::workshop
