// device/haply/events.h - what Haply's service tells beside the states: an emergency brake, an
// empty battery, a device that is busy.
//
// A channel of its own that is only listened to, by a thread of its own: whatever comes there, the
// exchange does not wait for it. A service without it tells nothing, and is looked at again every
// other second. What is told of other devices is left aside. An emergency brake counts until its
// release is told; everything else is said for some seconds.
// Thread: one makes and ends it and says which grip; braked() and words() any, wait-free. Memory:
// of the listening thread, a message of at most 64 KiB at a time.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "burr/device/haply/message.h"
#include "burr/device/haply/web_socket.h"
#include "burr/rt/rt.h"
#include "burr/rt/thread.h"

namespace burr::device::haply {

class Events {
 public:
  // address: of the service, in numbers; arm: whose events count; braked: what is known of before
  Events(std::string address, int port, std::string arm, bool braked);
  ~Events();
  Events(const Events&) = delete;
  Events& operator=(const Events&) = delete;

  // Of this grip as well.
  void follow_grip(const std::string& id);

  [[nodiscard]] bool braked() const BURR_RT { return braked_.load(std::memory_order_relaxed); }
  // What was told, a sentence without its subject; nullptr: nothing of late.
  [[nodiscard]] const char* words() const BURR_RT;

 private:
  void listen();
  [[nodiscard]] bool hear();
  void take(const Event& event);
  [[nodiscard]] bool is_ours(const std::string& device);

  std::string address_;
  int port_;
  std::string arm_;
  std::mutex whose_;  // between the wire, when a grip comes, and the listening thread
  std::string grip_;
  std::atomic<bool> braked_;
  std::atomic<bool> deaf_ = false;  // the channel was lost after the brake was told
  std::atomic<const char*> words_ = nullptr;
  std::atomic<std::int64_t> until_ns_ = 0;  // that they are said
  WebSocket line_;
  rt::Thread thread_;
};

}  // namespace burr::device::haply
