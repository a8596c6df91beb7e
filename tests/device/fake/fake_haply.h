// An Inverse Service without a device: a WebSocket server that answers each message with one state,
// and another that reports events, as in the maker's pages; both misbehave when a test wants it.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "burr/math/vec3.h"
#include "device/fake/answers.h"

namespace burr::test {

class FakeHaply {
 public:
  struct Arm {
    std::string id = "049D", type = "inverse3";
    math::Vec3 place = math::Vec3::Zero(), velocity = math::Vec3::Zero();
    bool calibrated = true, powered = true, left = false;
    bool in_use = false;                    // by another program; our own use counts once we
                                            // command it
    math::Vec3 force = math::Vec3::Zero();  // requested last
    double largest = 0;                     // of all forces
    Answers answers;
  };
  struct Grip {
    std::string id;
    math::Quat orientation = math::Quat::Identity();
    unsigned buttons = 0;
    bool connected = true;
  };
  struct Commands {
    std::vector<Arm> arms = {{}};
    bool grip = true;  // the first one, "GRIP", is there
    std::vector<Grip> more_grips;
    bool grip_awake = true;
    math::Quat orientation = math::Quat::Identity();
    std::string names_of_buttons = "abc";  // or "button_"
    unsigned buttons = 0;
    std::string version = "3.5.0";  // empty: /version is not known
    std::string key = "vector";     // key of a force; another key has no effect
    bool silent = false;            // takes messages and does not answer
    int stall_ms = 0;               // the next answer comes so much later, once
    int pace_ms = 0;                // delay of every answer
    bool web_socket = true;         // false: it speaks only HTTP
    std::string greets;             // the first message, whatever it is; empty: the right one
    bool fragments = false, pings = false;
    std::deque<std::string> instead;  // the next answers, whatever they are
    bool hang_up = false;
    bool leaves_out = false;  // leaves out what has not changed
    // ---- the channel of events
    // sent to every client in order; not copied while the arms wait for their states
    std::vector<std::shared_ptr<const std::string>> events;
    bool events_hang_up = false;
  };

  FakeHaply();
  ~FakeHaply();
  FakeHaply(const FakeHaply&) = delete;
  FakeHaply& operator=(const FakeHaply&) = delete;

  // Calls f with the state locked, to change it or to look at it.
  template <class F>
  auto with(F change) {
    const std::lock_guard lock(mutex_);
    return change(commands_);
  }
  // Closes every connection.
  void drop();

  // Reports an event to the clients. device: its id; empty: none in the message.
  void tell(const std::string& name, const std::string& device = {},
            const std::string& level = "warning");
  void tell_safety(const std::string& type, const std::string& device = {});
  void tell_text(std::string text);

  int port = 0, events_port = 0;
  std::atomic<int> messages = 0, sessions = 0, unreadable = 0;
  std::atomic<int> listeners = 0, listened = 0;  // clients of the events: now, ever

 private:
  struct Servers;

  std::mutex mutex_;
  Commands commands_;
  std::unique_ptr<Servers> servers_;
};

}  // namespace burr::test
