#include "burr/device/wire.h"

#include <chrono>
#include <thread>
#include <utility>

namespace burr::device {
namespace {

constexpr auto kComeBack = std::chrono::milliseconds(500);  // between two attempts to find it again
constexpr auto kLook =
    std::chrono::milliseconds(5);              // ... and between two checks of whether to stop
constexpr std::int64_t kFastestNs = 200'000;   // shortest period for a device that never waits
constexpr std::int64_t kTellNs = 100'000'000;  // shortest time between two texts of trouble

}  // namespace

bool exchange(Wire& wire, Link& link) BURR_RT {
  HandState hand;
  const Wire::Read read = wire.read(hand);
  if (read == Wire::Read::lost) return false;
  const math::Vec3 force = read == Wire::Read::hand ? link.exchange(hand) : link.push();
  wire.write_torque(link.torque());
  return wire.write(force);
}

WireDevice::WireDevice(std::unique_ptr<Wire> wire, const LinkSettings& settings)
    : LinkedDevice(settings), wire_(std::move(wire)), timeout_(settings.loss_timeout) {}

Status WireDevice::open() {
  close();
  auto found = wire_->connect();
  if (!found) return found.error();
  spec_ = std::move(*found);
  spec_.loss_timeout = timeout_;
  stop_ = false;
  report({});
  thread_ = std::make_unique<rt::Thread>(
      rt::ThreadRequest{.name = "wire", .realtime = true, .priority = 82}, [this] { work(); });
  return fine();
}

void WireDevice::close() {
  stop_ = true;
  if (thread_) thread_->join();
  thread_.reset();
}

std::string WireDevice::trouble() const {
  const std::lock_guard lock(trouble_mutex_);
  return trouble_;
}

void WireDevice::report(std::string trouble) {
  const std::lock_guard lock(trouble_mutex_);
  trouble_ = std::move(trouble);
}

// Accepts only the same device: the session relies on the limits of the first one.
bool WireDevice::reconnect() {
  auto found = wire_->connect();
  if (!found) {
    report(found.error().text);
    return false;
  }
  if (found->serial == spec_.serial && found->peak_force == spec_.peak_force &&
      found->peak_torque == spec_.peak_torque) {
    reconnections_.fetch_add(1, std::memory_order_relaxed);
    report({});
    return true;
  }
  report("Another device is plugged in now; the session began with " + spec_.name + " " +
         spec_.serial + ": plug that one in again, or begin a new session.");
  wire_->disconnect();
  return false;
}

void WireDevice::work() {
  bool connected = true;
  std::int64_t asked = rt::monotonic_ns(), said = asked;
  unsigned revision = wire_->why_revision();
  while (!stop_.load(std::memory_order_relaxed)) {
    if (!connected) {
      const rt::NormalPriority aside;  // the search may take long and starts other threads
      const auto until = std::chrono::steady_clock::now() + kComeBack;
      while (!stop_.load(std::memory_order_relaxed) && std::chrono::steady_clock::now() < until)
        std::this_thread::sleep_for(kLook);
      if (stop_.load(std::memory_order_relaxed)) return;
      connected = reconnect();
      revision = wire_->why_revision();
      continue;
    }
    if (!exchange(*wire_, link_)) {
      link_.mark_lost();
      const std::string why = wire_->why();
      report(!why.empty() ? why : spec_.name + " was disconnected; burr is looking for it.");
      wire_->disconnect();
      connected = false;
      continue;
    }
    const std::int64_t now = rt::monotonic_ns();
    if (now - asked < kFastestNs)
      std::this_thread::sleep_for(std::chrono::nanoseconds(kFastestNs - (now - asked)));
    asked = rt::monotonic_ns();
    if (wire_->why_revision() != revision && asked - said >= kTellNs) {
      revision = wire_->why_revision();
      said = asked;
      report(wire_->why());
    }
  }
  if (connected) {
    wire_->write_torque(math::Vec3::Zero());
    static_cast<void>(wire_->write(math::Vec3::Zero()));
    wire_->disconnect();
  }
  link_.mark_lost();  // when it is opened again, it starts without the last force
}

}  // namespace burr::device
