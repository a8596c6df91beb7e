// A libdrd.so or libdhd.so without a device: plays what a test wants and records the calls.
//
// It is loaded like the real ones; the test reaches its state by the exported fake_dhd(). Frame and
// units are those of the library: x to the user, y right, z up; metres. Writing a force waits for
// the next frame of the device, `rate` a second; 0: it never waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "device/fake/answers.h"

namespace burr::test {

// Not a mutex, because a test that counts the driver's locks must not count these.
class FakeLock {
 public:
  void lock() {
    while (held_.test_and_set(std::memory_order_acquire)) std::this_thread::yield();
  }
  void unlock() { held_.clear(std::memory_order_release); }

 private:
  std::atomic_flag held_;
};

struct FakeForce {
  std::array<double, 3> newton{}, newton_metre{};
  std::int64_t ns = 0;  // CLOCK_MONOTONIC
};

struct FakeArm {
  // properties
  int type = 34;
  std::string name = "omega.6";
  unsigned short serial = 1001;
  bool present = true, in_use = false, left = false, wrist = true, gripper = false;
  bool active_wrist = false;  // with motors
  bool initialized = true, can_home = true;
  int homes_after = -1;  // homing ends when that other arm has no force; -1: at once
  // the hand
  std::array<double, 3> place{}, velocity{};
  std::array<double, 9> frame = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
  double apart = 0.5;                                         // of the gripper, rad
  unsigned buttons = 0;
  // behaviour
  int rate = 1000;
  int stall_ms = 0;    // the next force waits so much longer, once
  int code = 0;        // result of every success: 1 time guard, 2 saturated
  int read_error = 0;  // error of every reading from now on; 0: none
  int write_error = 0, velocity_error = 0;
  int off_cause = 0;  // why the forces are off
  int power = 1, connected = 1;
  bool tells = true;  // GetStatus() fills in its array; false: all zero
  // calls received
  bool open = false, force_on = false, gravity = false, regulates = false;
  double most_force = -1, most_torque = -1;  // SetMaxForce(), SetMaxTorque()
  int watchdog = 0;                          // in eighths of a millisecond; 0: none
  bool watches = false;           // the watchdog works: without a force for that time the forces go
                                  // off for good
  std::vector<FakeForce> forces;  // newest last; the newest 4096
  double largest_force = 0, largest_torque = 0;  // of all forces
  Answers answers;
  std::uint64_t writes = 0, reads = 0, opened = 0, closed = 0, homed = 0, asked = 0;
  std::int64_t next_ns = 0;  // when the next frame is due
  std::int64_t written_ns = 0;
};

struct FakeDhd {
  FakeLock lock;  // protects everything here
  std::array<FakeArm, 3> arm;
  bool guards_watchdog = false;  // SetWatchdog() needs the expert mode
  bool expert = false;
  unsigned misuse = 0;  // calls that move an arm without permission, or set a force on a device
                        // that is not open
  std::string misused;  // the first of those calls
};

using FakeDhdState = FakeDhd* (*)();

}  // namespace burr::test
