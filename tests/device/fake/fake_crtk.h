// A CRTK arm that the test plays on a bus of its own: it publishes its pose at its rate, holds the
// last force it was given for ever, as real ones do, and misbehaves on request.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "burr/device/crtk/bus.h"
#include "device/fake/answers.h"

namespace burr::test {

// A bus domain that is limited to this computer and that no other test uses.
inline int quiet_domain() {
  static const int domain = [] {  // its socket name is free on this computer
    for (int n = 0; n < 200; ++n) {
      const int wanted = 20 + static_cast<int>((::getpid() + n) % 200);
      sockaddr_un name{.sun_family = AF_UNIX, .sun_path = {}};
      const std::string as = "burr test on domain " + std::to_string(wanted);
      as.copy(name.sun_path + 1, sizeof name.sun_path - 1);
      const int held = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);  // held until this process
                                                                         // ends
      if (::bind(held, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0) return wanted;
      ::close(held);
    }
    return 20;
  }();
  return domain;
}

struct Offers {
  bool body = true, spatial = true, states = true;
};

class FakeCrtkArm {
 public:
  struct Commands {
    math::Pose place;
    math::Vec3 velocity = math::Vec3::Zero();
    bool stamped = true, silent = false;
    bool deaf = false;  // from now on it does not read forces
    int stall_ms = 0;   // once
    double rate_hz = 1000;
    std::string state = "ENABLED";
    bool homed = true, busy = false;
    int home_ms = 50;  // duration of homing; below 0: it reports a fault
    // changes a message before it is sent
    std::function<void(device::crtk::PoseStamped&, device::crtk::TwistStamped&)> spoil;
    std::uint64_t places = 0;  // poses sent
    // ---- received
    math::Vec3 force = math::Vec3::Zero(), torque = math::Vec3::Zero();
    double largest = 0;
    std::uint64_t forces = 0;
    Answers answers;
    std::vector<std::string> asked;
    bool weightless = false, absolute = true;
  };
  explicit FakeCrtkArm(int domain, std::string name = "/arm", Offers offers = {})
      : FakeCrtkArm(domain, Commands(), std::move(name), offers) {}
  FakeCrtkArm(int domain, Commands begins, std::string name = "/arm", Offers offers = {})
      : offers_(offers),
        bus_(std::move(*device::crtk::Bus::open(domain))),
        name_(std::move(name)),
        commands_(std::move(begins)) {
    thread_ = std::thread([this] { run(); });
  }
  ~FakeCrtkArm() {
    stop_ = true;
    thread_.join();
  }
  FakeCrtkArm(const FakeCrtkArm&) = delete;
  FakeCrtkArm& operator=(const FakeCrtkArm&) = delete;

  template <class F>
  auto with(F look) {
    const std::lock_guard lock(mutex_);
    return look(commands_);
  }
  [[nodiscard]] math::Vec3 force() {
    return with([](Commands& w) { return w.force; });
  }
  void tread(const char* pedal, bool down) {
    const std::lock_guard lock(mutex_);
    trodden_.emplace_back(pedal, down);
  }

 private:
  void run() {
    using namespace device::crtk;
    const dds_entity_t on = bus_->participant();
    Writer<PoseStamped> place(on, name_ + "/measured_cp");
    Writer<TwistStamped> speed(on, name_ + "/measured_cv");
    std::unique_ptr<Writer<OperatingState>> states;
    if (offers_.states)
      states = std::make_unique<Writer<OperatingState>>(on, name_ + "/operating_state", Keep::last);
    Writer<Bool> gripper(on, name_ + "/gripper/closed", Keep::all);
    Writer<Joy> clutch(on, "/footpedals/clutch", Keep::all),
        coag(on, "/footpedals/coag", Keep::all),
        present(on, "/console/operator_present", Keep::all);
    std::unique_ptr<Reader<WrenchStamped>> body, spatial;
    if (offers_.body)
      body = std::make_unique<Reader<WrenchStamped>>(on, name_ + "/body/servo_cf", Keep::all);
    if (offers_.spatial)
      spatial = std::make_unique<Reader<WrenchStamped>>(on, name_ + "/spatial/servo_cf", Keep::all);
    Reader<StringStamped> commands(on, name_ + "/state_command", Keep::all);
    Reader<Bool> absolute(on, name_ + "/body/set_cf_orientation_absolute", Keep::all),
        weightless(on, name_ + "/use_gravity_compensation", Keep::all);

    std::string told;
    auto home_at = std::chrono::steady_clock::time_point::max();
    for (auto next = std::chrono::steady_clock::now(); !stop_;) {
      int stall = 0;
      double rate = 1000;
      {
        const std::lock_guard lock(mutex_);
        Commands& w = commands_;
        const auto take = [&w](const WrenchStamped& wrench) {
          w.force = vector_of(wrench.wrench_.force_);
          w.torque = vector_of(wrench.wrench_.torque_);
          w.largest = std::max(w.largest, w.force.norm());
          w.answers.take(w.force.data());
          ++w.forces;
        };
        if (w.deaf) {
          body.reset();
          spatial.reset();
        }
        if (body)
          while (const WrenchStamped* wrench = body->take()) take(*wrench);
        if (spatial)
          while (const WrenchStamped* wrench = spatial->take()) take(*wrench);
        while (const Bool* yes = absolute.take()) w.absolute = yes->data_;
        while (const Bool* yes = weightless.take()) w.weightless = yes->data_;
        while (const StringStamped* command = commands.take()) {
          w.asked.emplace_back(command->string_);
          if (w.asked.back() == "enable" || w.asked.back() == "resume") w.state = "ENABLED";
          if (w.asked.back() == "home") {
            w.busy = true;
            home_at = std::chrono::steady_clock::now() + std::chrono::milliseconds(w.home_ms);
          }
        }
        if (w.busy && std::chrono::steady_clock::now() > home_at) {
          w.busy = false;
          w.homed = w.home_ms >= 0;
          if (!w.homed) w.state = "FAULT";
          home_at = std::chrono::steady_clock::time_point::max();
        }
        const std::string tells = w.state + (w.homed ? "h" : "") + (w.busy ? "b" : "");
        if (states && tells != told) {
          OperatingState state{
              {now_stamp(), as_sample_text("")}, as_sample_text(w.state.c_str()), w.homed, w.busy};
          states->write(state);
          told = tells;
        }
        for (const auto& [pedal, down] : trodden_) {
          std::int32_t button = down ? 1 : 0;
          Joy joy{};
          joy.header_ = {now_stamp(), as_sample_text("")};
          joy.buttons_._buffer = &button;
          joy.buttons_._length = joy.buttons_._maximum = 1;
          if (pedal == "gripper") gripper.write(Bool{down});
          if (pedal == "clutch") clutch.write(joy);
          if (pedal == "coag") coag.write(joy);
          if (pedal == "present") present.write(joy);
        }
        trodden_.clear();
        if (!w.silent) {
          const Stamp stamp = w.stamped ? now_stamp() : Stamp{};
          TwistStamped twist{};
          twist.header_ = {stamp, as_sample_text("")};
          twist.twist_.linear_ = message_of(w.velocity);
          PoseStamped pose{{stamp, as_sample_text("base")}, message_of(w.place)};
          if (w.spoil) w.spoil(pose, twist);
          speed.write(twist);
          w.answers.tell(w.place.p.data());
          place.write(pose);
          ++w.places;
        }
        stall = w.stall_ms;
        w.stall_ms = 0;
        rate = w.rate_hz;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(stall));
      next += std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / rate));
      next = std::max(next, std::chrono::steady_clock::now() - std::chrono::milliseconds(2));
      std::this_thread::sleep_until(next);
    }
  }

  Offers offers_;
  std::unique_ptr<device::crtk::Bus> bus_;
  std::string name_;
  Commands commands_;
  std::mutex mutex_;
  std::vector<std::pair<std::string, bool>> trodden_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace burr::test
