// An Inverse Service without a device: a WebSocket server that answers each message with one state,
// and another that tells what happens, as the maker's pages say; both misbehave as a test commands.
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
    bool in_use = false;                    // by another program; it is by ours once we command it
    math::Vec3 force = math::Vec3::Zero();  // as asked for last
    double largest = 0;                     // of all
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
    bool grip = true;  // "GRIP", the first one, and how it is held
    std::vector<Grip> more_grips;
    bool grip_awake = true;
    math::Quat orientation = math::Quat::Identity();
    std::string names_of_buttons = "abc";  // or "button_"
    unsigned buttons = 0;
    std::string version = "3.5.0";  // empty: /version is not known
    std::string key = "vector";     // of a force; another is not obeyed
    bool silent = false;            // takes messages and does not answer
    int stall_ms = 0;               // the next answer comes so much later, once
    int pace_ms = 0;                // each answer does
    bool web_socket = true;         // false: it speaks HTTP only
    std::string greets;             // the first message, whatever it is; empty: as it should be
    bool fragments = false, pings = false;
    std::deque<std::string> instead;  // the next answers, whatever they are
    bool hang_up = false;
    bool leaves_out = false;  // what is as it was
    // ---- the channel of events
    // told to all who listen, one after another; not copied while the arms wait for their states
    std::vector<std::shared_ptr<const std::string>> events;
    bool events_hang_up = false;
  };

  FakeHaply();
  ~FakeHaply();
  FakeHaply(const FakeHaply&) = delete;
  FakeHaply& operator=(const FakeHaply&) = delete;

  // Changes what it does, or looks.
  template <class F>
  auto with(F change) {
    const std::lock_guard lock(mutex_);
    return change(commands_);
  }
  // Cuts every connection.
  void drop();

  // Something happens, as the service tells it; device: its id, empty: none is told.
  void tell(const std::string& name, const std::string& device = {},
            const std::string& level = "warning");
  void tell_safety(const std::string& type, const std::string& device = {});
  void tell_text(std::string text);

  int port = 0, events_port = 0;
  std::atomic<int> messages = 0, sessions = 0, unreadable = 0;
  std::atomic<int> listeners = 0, listened = 0;  // to events: now, ever

 private:
  struct Servers;

  std::mutex mutex_;
  Commands commands_;
  std::unique_ptr<Servers> servers_;
};

}  // namespace burr::test
