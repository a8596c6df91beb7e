#include "burr/workshop/arm_publisher.h"
#include "burr/tick/servo.h"

#include <chrono>
#include <utility>

namespace burr::workshop {
namespace {

device::crtk::ArmReport report_of(const tick::TickRow& row) {
  device::crtk::ArmReport report;
  report.setpoint = row.hand.world_from_tool;
  report.measured = {row.contact.proxy, row.hand.world_from_tool.q};
  report.velocity = row.hand.velocity;
  report.force = row.contact.force;
  return report;
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
        device::crtk::ArmReport report = report_of(row);
        report.busy = busy && busy();
        report.released = session_.servo().released();
        arm.publish(report);
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
