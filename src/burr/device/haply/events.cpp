#include "burr/device/haply/events.h"

#include <chrono>
#include <utility>

#include "burr/rt/clock.h"

namespace burr::device::haply {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kListen(500);             // wait of one receive()
constexpr milliseconds kAgain(2000);             // between two attempts to connect
constexpr std::size_t kLargest = 1 << 16;        // longest event [byte]
constexpr int kMostNonsense = 50;                // in a row: this is not the service's channel
constexpr std::int64_t kSaidNs = 5'000'000'000;  // how long an event is shown [ns]

// The text for an event, without its subject; nullptr: not for the user.
const char* words_of(EventKind what) {
  switch (what) {
    case EventKind::disconnected:
      return "has a part that was disconnected; check its cable, or wake its grip.";
    case EventKind::battery_low:
      return "has a grip whose battery is low; charge it soon.";
    case EventKind::battery_critical:
      return "has a grip whose battery is nearly empty; charge it.";
    case EventKind::sleeps:
      return "went to sleep; move it, or press a button of its grip.";
    case EventKind::busy:
      return "is busy; close other programs that use it.";
    case EventKind::connection_loop:
      return "connects again and again; use another cable or port.";
    case EventKind::calibration_failed:
      return "could not be calibrated; move it as its lights show.";
    case EventKind::stalled:
      return "was stopped by its own safety system because its motors stalled; lift it from the "
             "bone.";
    case EventKind::unstable:
      return "is at its own limit of stability; set a smaller max_force_n or scale.";
    case EventKind::stage:
      return "changed the stage of its own safety system; see Haply's window.";
    case EventKind::trouble:
      return "reports a fault; see Haply's window.";
    case EventKind::nothing:
    case EventKind::connected:
    case EventKind::brake:
    case EventKind::brake_released:
      break;
  }
  return nullptr;
}

}  // namespace

Events::Events(std::string address, int port, std::string arm, bool braked)
    : address_(std::move(address)),
      port_(port),
      arm_(std::move(arm)),
      braked_(braked),
      may_have_missed_release_(braked),
      line_(kLargest),
      thread_({.name = "haply events", .stack_bytes = 0}, [this] { listen(); }) {}

Events::~Events() { line_.stop(); }

void Events::follow_grip(const std::string& id) {
  const std::lock_guard lock(ids_mutex_);
  grip_ = id;
}

bool Events::is_ours(const std::string& device) {
  const std::lock_guard lock(ids_mutex_);
  return device.empty() || device == arm_ || device == grip_;
}

const char* Events::words() const BURR_RT {
  if (braked())
    return may_have_missed_release_.load(std::memory_order_relaxed)
               ? "was held by its emergency brake when it last sent anything; release the brake, "
                 "and begin again."
               : "is held by its emergency brake; release the brake.";
  return rt::monotonic_ns() < until_ns_.load(std::memory_order_relaxed)
             ? words_.load(std::memory_order_relaxed)
             : nullptr;
}

// Waits for the next message, however long it takes. False: the channel is closed, or this object
// is being destroyed.
bool Events::read_event_message() {
  net::WebSocket::Received heard = net::WebSocket::Received::nothing;
  while (heard == net::WebSocket::Received::nothing) heard = line_.receive(kListen);
  return heard == net::WebSocket::Received::message;
}

void Events::listen() {
  while (!line_.stopped()) {
    int nonsense = 0;
    if (line_.connect(address_, port_).empty())
      while (nonsense < kMostNonsense && read_event_message()) {
        Event event;
        if (read_event(line_.text(), event)) {
          nonsense = 0;
          take(event);
        } else {
          ++nonsense;
        }
      }
    line_.close();
    if (braked()) may_have_missed_release_ = true;  // its release may have been missed
    line_.rest(kAgain);
  }
}

void Events::take(const Event& event) {
  if (!is_ours(event.device)) return;
  if (event.what == EventKind::brake || event.what == EventKind::brake_released) {
    may_have_missed_release_ = false;
    braked_ = event.what == EventKind::brake;
  }
  if (event.what == EventKind::connected) until_ns_ = 0;
  if (const char* words = words_of(event.what)) {
    words_ = words;
    until_ns_ = rt::monotonic_ns() + kSaidNs;
  }
}

}  // namespace burr::device::haply
