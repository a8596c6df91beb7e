// device/wire.h - a device that is asked: a thread of its own reads the hand, waits for the tick's
// force and writes it.
//
//     class Omega : public Wire { connect - read - write - ... - disconnect };
//     Session::make(bone, std::make_unique<WireDevice>(std::make_unique<Omega>(...)), ...)
//
// A Wire knows one maker's way of speaking and nothing else; pace, loss, coming back and letting go
// are here. Pulled out and plugged in again, the device is found again, twice a second, and its
// force returns by the start ramp. Thread: open(), close(), trouble() main; the Wire's functions
// only on the wire's thread, and connect() also in open().
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
    lost,     // none will come any more: connect() again
  };

  Wire() = default;
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  virtual ~Wire() = default;

  // Finds the device and makes it ready, motors without force. loss_timeout is the link's to say.
  // May take its time. The same device again after it was lost.
  [[nodiscard]] virtual Result<DeviceSpec> connect() = 0;
  // Waits for the next reading, for some milliseconds at most; in metres, in the device's own frame
  // as the driver's header states it.
  [[nodiscard]] virtual Read read(HandState& hand) BURR_RT = 0;
  // Of the next force [N m], in that frame; zero unless its peak_torque is above 0.
  virtual void write_torque(const math::Vec3& torque) BURR_RT { static_cast<void>(torque); }
  // [N], in that frame; false: lost.
  [[nodiscard]] virtual bool write(const math::Vec3& force) BURR_RT = 0;
  // No force, motors off, all given back; also after it was lost.
  virtual void disconnect() = 0;
  // Why it was lost, or what is wrong though it goes on: one sentence, or empty. After read() or
  // write().
  [[nodiscard]] virtual std::string why() const { return {}; }
  // Another number whenever why() says something else: it is asked only then.
  [[nodiscard]] virtual unsigned told() const BURR_RT { return 0; }
};

// One exchange: a reading, and the force of its tick. False: lost.
[[nodiscard]] bool exchange(Wire& wire, Link& link) BURR_RT;

class WireDevice final : public LinkedDevice {
 public:
  explicit WireDevice(std::unique_ptr<Wire> wire, const LinkSettings& settings = {});
  ~WireDevice() override { close(); }

  Status open() override;
  void close() override;
  [[nodiscard]] std::string trouble() const override;

  // How often it was lost and found again.
  [[nodiscard]] int returns() const { return returns_.load(std::memory_order_relaxed); }

 private:
  void work();
  bool come_back();
  void say(std::string trouble);

  std::unique_ptr<Wire> wire_;
  double timeout_;  // of its link [s]
  std::unique_ptr<rt::Thread> thread_;
  std::atomic<bool> stop_ = false;
  std::atomic<int> returns_ = 0;
  mutable std::mutex words_;  // never in an exchange, only when there is something to tell
  std::string trouble_;
};

}  // namespace burr::device
