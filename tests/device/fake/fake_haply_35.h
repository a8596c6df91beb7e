// A second Inverse Service without a device, after the maker's published pages of 3.5 alone: what stands between a
// session and the arm. Each session has a basis, a mount, a workspace and filters, which the service applies to every
// place it tells and every force it takes; the first message and force_render_full_state tell them.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "burr/math/pose.h"

namespace burr::test {

class FakeHaply35 {
 public:
  // Of a session.
  struct Pipeline {
    std::string basis = "XYZ", preset = "defaults";
    math::Pose mount, workspace;
    math::Vec3 scale = math::Vec3::Ones();
    double force_gate = 0.3, damping = 0;
    math::Vec3 damping_along = math::Vec3::Zero();
  };
  struct Arm {
    math::Vec3 place = math::Vec3::Zero();  // of the arm itself
    math::Vec3 force = math::Vec3::Zero();  // that reaches its motors
  };
  struct Commands {
    Arm arm;
    Pipeline begins;        // how a session begins: a profile that somebody saved
    Pipeline now;           // of the session that is there
    bool stubborn = false;  // takes a configuration and keeps its own
    bool late = false;      // tells a change only from the next message on
    int refused = 0;        // messages that the pages call ambiguous
    std::string first;      // message of a client
  };

  FakeHaply35();
  ~FakeHaply35();
  FakeHaply35(const FakeHaply35&) = delete;
  FakeHaply35& operator=(const FakeHaply35&) = delete;

  template <class F>
  auto with(F change) {
    const std::lock_guard lock(mutex_);
    return change(commands_);
  }
  int port = 0;

 private:
  struct Server;
  std::mutex mutex_;
  Commands commands_;
  std::unique_ptr<Server> server_;
};

}  // namespace burr::test
