// device/wire.h - a device that is polled: a thread of its own reads the hand, waits for the tick's
// force and writes it.
//
//     class Omega : public Wire { connect - read - write - ... - disconnect };
//     Session::make(bone, std::make_unique<WireDevice>(std::make_unique<Omega>(...)), ...)
//
// A Wire knows only the protocol of one maker. The pace, the loss of the device, its return and the
// release of the force are handled here. A device that was unplugged and plugged in again is found
// again (two attempts a second), and its force returns through the start ramp. Thread: open(),
// close(), trouble() main; the Wire's functions only on the wire's thread, and connect() also in
// open().
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "burr/base/result.h"
#include "burr/device/bounded.h"
#include "burr/device/linked.h"
#include "burr/rt/thread.h"

namespace burr::device {

class Wire {
 public:
  enum class Read {
    hand,     // a reading has come
    nothing,  // none within a few milliseconds
    lost,     // no more will come: connect() again
  };

  Wire() = default;
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  virtual ~Wire() = default;

  // Finds the device and makes it ready, with zero motor force. May take long. After a loss it must
  // find the same device again. The spec's loss_timeout is overwritten by the link's. Error: what
  // is missing and what to do.
  [[nodiscard]] virtual Result<DeviceSpec> connect() = 0;
  // Waits some milliseconds at most for the next reading; in metres, in the device's own frame as
  // the driver's header states it.
  [[nodiscard]] virtual Read read(HandState& hand) BURR_RT = 0;
  // Torque that goes with the next force [N m], in that frame; zero unless its peak_torque is above
  // 0.
  virtual void write_torque(const math::Vec3& torque) BURR_RT { static_cast<void>(torque); }
  // Force [N], in that frame. False: the device is lost.
  [[nodiscard]] virtual bool write(const math::Vec3& force) BURR_RT = 0;
  // Sends zero force, switches the motors off and releases everything; also after a loss.
  virtual void disconnect() = 0;
  // Why the device was lost, or what is wrong while it goes on: one sentence, or empty. Call it
  // after read() or write().
  [[nodiscard]] virtual std::string why() const { return {}; }
  // Incremented when why() changes, so that callers poll the counter instead of the string.
  [[nodiscard]] virtual unsigned why_revision() const BURR_RT { return 0; }
};

// One exchange: a reading, and the force of its tick. False: the device is lost.
[[nodiscard]] bool exchange(Wire& wire, Link& link) BURR_RT;

class WireDevice final : public LinkedDevice {
 public:
  explicit WireDevice(std::unique_ptr<Wire> wire, const LinkSettings& settings = {});
  ~WireDevice() override { close(); }

  Status open() override;
  void close() override;
  [[nodiscard]] std::string trouble() const override;

  // Number of times it was lost and found again.
  [[nodiscard]] int reconnections() const { return reconnections_.load(std::memory_order_relaxed); }

 private:
  void work();
  bool reconnect();
  void report(std::string trouble);

  std::unique_ptr<Wire> wire_;
  double timeout_;  // loss timeout of its link [s]
  std::unique_ptr<rt::Thread> thread_;
  std::atomic<bool> stop_ = false;
  std::atomic<int> reconnections_ = 0;
  // locked only when there is a text to report, never in an exchange
  mutable std::mutex trouble_mutex_;
  std::string trouble_;
};

}  // namespace burr::device
