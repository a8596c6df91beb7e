#include "burr/device/haply/events.h"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>
#include <utility>

#include "burr/rt/clock.h"

namespace burr::device::haply {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
namespace net = boost::asio;
using Tcp = net::ip::tcp;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kPatience(500);           // with a service that is to answer
constexpr milliseconds kAgain(2000);             // between two looks whether it is there
constexpr std::size_t kLargest = 1 << 16;        // of an event [byte]
constexpr int kMostNonsense = 50;                // in a row: it is another's channel
constexpr std::int64_t kSaidNs = 5'000'000'000;  // how long what was told is said

// Without a subject, as the driver has it; nullptr: not for the user.
const char* words_of(Told what) {
  switch (what) {
    case Told::disconnected:
      return "has a part that was disconnected; see its cable, or wake its grip.";
    case Told::battery_low:
      return "has a grip whose battery is low; charge it soon.";
    case Told::battery_critical:
      return "has a grip whose battery is nearly empty; charge it.";
    case Told::sleeps:
      return "fell asleep; move it, or press a button of its grip.";
    case Told::busy:
      return "is busy; close other programs that use it.";
    case Told::connection_loop:
      return "connects again and again; take another cable or port.";
    case Told::calibration_failed:
      return "could not be calibrated; move it as its lights ask.";
    case Told::stalled:
      return "was stopped by its own guard, as its motors stalled; lift it from the bone.";
    case Told::unstable:
      return "is at its own limit of stability; set a smaller max_force_n or scale.";
    case Told::stage:
      return "has changed the stage of its own guard; see Haply's window.";
    case Told::trouble:
      return "tells of trouble; see Haply's window.";
    case Told::nothing:
    case Told::connected:
    case Told::brake:
    case Told::brake_released:
      break;
  }
  return nullptr;
}

}  // namespace

// The line to the channel, as far as there is one.
struct Events::Ear {
  Tcp::endpoint where;
  net::io_context io{1};
  net::executor_work_guard<net::io_context::executor_type> stays{net::make_work_guard(io)};
  std::optional<websocket::stream<beast::tcp_stream>> stream;
  beast::flat_buffer buffer;
  std::atomic<bool> stop = false;

  void end() {
    stop = true;
    net::post(io, [] {});  // wakes it
  }

  // Until it is done, so long, or the end.
  template <class Done>
  bool run(milliseconds longest, Done done) {
    const auto until = steady_clock::now() + longest;
    while (!done()) {
      const auto now = steady_clock::now();
      if (stop || now >= until) return false;
      io.run_one_for(until - now);
    }
    return true;
  }
  // One step of the talk; false: it failed, took longer than is waited for, or this is the end.
  template <class Begin, class Wait>
  bool step(Begin begin, Wait wait) {
    bool done = false;
    beast::error_code trouble;
    begin([&done, &trouble](beast::error_code error, auto&&...) {
      trouble = error;
      done = true;
    });
    do {
      if (run(kPatience, [&done] { return done; })) return !trouble;
    } while (!stop && wait());
    beast::get_lowest_layer(*stream).close();
    while (!done) io.run_one();  // what is closed ends at once
    return false;
  }

  bool connect() {
    stream.emplace(io);
    stream->read_message_max(kLargest);
    const std::string host = where.address().to_string() + ":" + std::to_string(where.port());
    const auto once = [] { return false; };
    return step(
               [this](auto then) {
                 beast::get_lowest_layer(*stream).async_connect(where, std::move(then));
               },
               once) &&
           step([&](auto then) { stream->async_handshake(host, "/", std::move(then)); }, once);
  }
  // However long it takes, but not for the other end to agree that what it says is no message.
  bool hear(std::string_view& text) {
    buffer.consume(buffer.size());
    if (!step([this](auto then) { stream->async_read(buffer, std::move(then)); },
              [this] { return stream->is_open(); }))
      return false;
    text = {static_cast<const char*>(buffer.data().data()), buffer.size()};
    return true;
  }
};

Events::Events(const std::string& address, int port, std::string arm, bool braked)
    : arm_(std::move(arm)), braked_(braked), deaf_(braked), ear_(std::make_unique<Ear>()) {
  beast::error_code odd;
  ear_->where = {net::ip::make_address(address, odd), static_cast<std::uint16_t>(port)};
  if (odd) return;  // nowhere to listen
  thread_ = std::make_unique<rt::Thread>(rt::ThreadWish{.name = "haply events", .stack_bytes = 0},
                                         [this] { listen(); });
}

Events::~Events() {
  ear_->end();
  thread_.reset();
}

void Events::follow_grip(const std::string& id) {
  const std::lock_guard lock(whose_);
  grip_ = id;
}

bool Events::is_ours(const std::string& device) {
  const std::lock_guard lock(whose_);
  return device.empty() || device == arm_ || device == grip_;
}

const char* Events::words() const BURR_RT {
  if (braked())
    return deaf_.load(std::memory_order_relaxed)
               ? "was held by its emergency brake when it was last heard of; release it, and begin "
                 "again."
               : "is held by its emergency brake; release it.";
  return rt::monotonic_ns() < until_ns_.load(std::memory_order_relaxed)
             ? words_.load(std::memory_order_relaxed)
             : nullptr;
}

void Events::listen() {
  while (!ear_->stop) {
    int nonsense = 0;
    if (ear_->connect())
      for (std::string_view text; nonsense < kMostNonsense && ear_->hear(text);) {
        Event event;
        if (read_event(text, event)) {
          nonsense = 0;
          take(event);
        } else {
          ++nonsense;
        }
      }
    if (braked()) deaf_ = true;  // its release may have been told to nobody
    static_cast<void>(ear_->run(kAgain, [] { return false; }));
  }
}

void Events::take(const Event& event) {
  if (!is_ours(event.device)) return;
  if (event.what == Told::brake || event.what == Told::brake_released) {
    deaf_ = false;
    braked_ = event.what == Told::brake;
  }
  if (event.what == Told::connected) until_ns_ = 0;
  if (const char* words = words_of(event.what)) {
    words_ = words;
    until_ns_ = rt::monotonic_ns() + kSaidNs;
  }
}

}  // namespace burr::device::haply
