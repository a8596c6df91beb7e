// device/haply/events.h - events that Haply's service reports beside the states: an emergency
// brake, an empty battery, a device in use.
//
// They come over a connection of their own, read by a thread of its own, so that the exchange never
// waits for it. A service without this connection reports no events; a new attempt is made every
// two seconds. Events of other devices are ignored. An emergency brake counts until its release is
// reported; every other event is shown for some seconds.
// Thread: one thread makes it, ends it and calls follow_grip(); braked() and words() any,
// wait-free. Memory: on the listening thread, one message of at most 64 KiB at a time.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "burr/device/haply/message.h"
#include "burr/net/web_socket.h"
#include "burr/rt/rt.h"
#include "burr/rt/thread.h"

namespace burr::device::haply {

class Events {
 public:
  // address: numeric address of the service; arm: id of the arm whose events count; braked: state
  // of the brake from an earlier connection
  Events(std::string address, int port, std::string arm, bool braked);
  ~Events();
  Events(const Events&) = delete;
  Events& operator=(const Events&) = delete;

  // Events of this grip count too.
  void follow_grip(const std::string& id);

  [[nodiscard]] bool braked() const BURR_RT { return braked_.load(std::memory_order_relaxed); }
  // The newest event as a sentence without its subject; nullptr: none recently.
  [[nodiscard]] const char* words() const BURR_RT;

 private:
  void listen();
  [[nodiscard]] bool read_event_message();
  void take(const Event& event);
  [[nodiscard]] bool is_ours(const std::string& device);

  std::string address_;
  int port_;
  std::string arm_;
  // protects the ids: the wire sets the grip, the listening thread reads them
  std::mutex ids_mutex_;
  std::string grip_;
  std::atomic<bool> braked_;
  // the connection was lost after a brake was reported
  std::atomic<bool> may_have_missed_release_ = false;
  std::atomic<const char*> words_ = nullptr;
  std::atomic<std::int64_t> until_ns_ = 0;  // end of the time for which the words are shown
  net::WebSocket line_;
  rt::Thread thread_;
};

}  // namespace burr::device::haply
