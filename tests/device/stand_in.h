// A tick without bone: reads the hand, limits the requested force and writes it, at the device's
// own pace and on a thread of its own, as a session would.
#pragma once

#include <malloc.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "burr/device/device.h"
#include "burr/haptics/safety/limit.h"

namespace burr::test {

// For tests in real time that are not about loss: a machine that stalls for a moment, as test
// machines do, does not release the force.
inline constexpr double kStallsAllowed = 0.5;  // [s]

class StandIn {
 public:
  using Want = std::function<math::Vec3(const device::HandState&)>;  // called on the tick's thread

  StandIn(device::Device& device, Want want, haptics::LimitSettings limit = {})
      : device_(device),
        want_(std::move(want)),
        limit_(device.spec(), limit),
        thread_([this] { run(); }) {}
  ~StandIn() { stop(); }
  StandIn(const StandIn&) = delete;
  StandIn& operator=(const StandIn&) = delete;

  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  // The next tick takes so much longer, once.
  void stall(std::chrono::milliseconds by) { stall_ms_ = static_cast<int>(by.count()); }

  [[nodiscard]] device::HandState hand() const {
    const std::lock_guard lock(mutex_);
    return hand_;
  }
  [[nodiscard]] std::uint64_t ticks() const { return ticks_; }
  [[nodiscard]] std::uint64_t invalid() const { return invalid_; }  // number of invalid readings
  [[nodiscard]] std::uint32_t flags() const { return flags_; }
  [[nodiscard]] bool engaged() const { return engaged_; }

 private:
  void run() {
    rt::TickClock* clock = device_.clock(1000);
    while (!stop_) {
      static_cast<void>(clock->wait());
      const device::HandState hand = device_.state(1e-3);
      if (const int stall = stall_ms_.exchange(0); stall > 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(stall));
      std::uint32_t flags = 0;
      const bool usable = limit_.accept_reading(hand, flags);
      const math::Vec3 wanted = usable ? want_(hand) : math::Vec3::Zero();
      device_.write_force(limit_.apply(wanted, 1e-3, flags));
      flags_ |= flags;
      engaged_ = limit_.engaged();
      if (!hand.valid) ++invalid_;
      ++ticks_;
      const std::lock_guard lock(mutex_);
      hand_ = hand;
    }
  }

  device::Device& device_;
  Want want_;
  haptics::ForceLimit limit_;
  mutable std::mutex mutex_;
  device::HandState hand_;
  std::atomic<std::uint64_t> ticks_ = 0, invalid_ = 0;
  std::atomic<std::uint32_t> flags_ = 0;
  std::atomic<bool> stop_ = false, engaged_ = false;
  std::atomic<int> stall_ms_ = 0;
  std::thread thread_;
};

// `./test --full` asks for tests at their whole length.
[[nodiscard]] inline bool full() {
  const char* wanted = std::getenv("BURR_FULL");
  return wanted != nullptr && std::string(wanted) == "1";
}
// How often a device is opened and closed to see what is left: a leak shows in the first hundred.
[[nodiscard]] inline int rounds() { return full() ? 1000 : 100; }

// Number of random forces over a real wire; BURR_FORCES=1000000 sends a million. Bounded.AMillionForces... tests the
// limit itself with a million, without a wire.
[[nodiscard]] inline int forces_on_a_wire() {
  if (const char* wanted = std::getenv("BURR_FORCES")) return std::atoi(wanted);
  if (!full()) return 20'000;
#if defined(BURR_SANITIZED)
  return 50'000;  // each is slow
#else
  return 200'000;
#endif
}

// Open file descriptors of this process.
[[nodiscard]] inline int open_files() {
  int count = 0;
  for ([[maybe_unused]] const auto& one : std::filesystem::directory_iterator("/proc/self/fd"))
    ++count;
  return count;
}

// Memory that malloc has given to this process [byte]; 0 where a sanitizer has its own malloc.
[[nodiscard]] inline std::size_t memory_in_use() {
  return ::mallinfo2().uordblks + ::mallinfo2().hblkhd;
}

// Waits until so() is true; false: not within a time that every machine can keep.
[[nodiscard]] inline bool soon(const std::function<bool()>& so,
                               std::chrono::seconds longest = std::chrono::seconds(60)) {
  const auto until = std::chrono::steady_clock::now() + longest;
  while (!so()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace burr::test
