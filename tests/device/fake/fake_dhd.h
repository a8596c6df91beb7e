// A libdrd.so or libdhd.so without a device: plays what a test says, and writes down what it was
// told.
//
// Loaded as the real ones are; the test reaches its state by the exported fake_dhd(). Frame and
// units are the library's: x to the user, y right, z up; metres. A force that is written waits for
// the next frame of its device, `rate` a second; 0: it never waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "device/fake/answers.h"

namespace burr::test {

// Not a mutex: a test that counts the driver's own must not count these.
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
  std::int64_t ns = 0;  // of CLOCK_MONOTONIC
};

struct FakeArm {
  // what it is
  int type = 34;
  std::string name = "omega.6";
  unsigned short serial = 1001;
  bool present = true, in_use = false, left = false, wrist = true, gripper = false;
  bool active_wrist = false;  // with motors
  bool initialized = true, can_home = true;
  int homes_after = -1;  // homing ends once that other arm pushes no more; -1: at once
  // what its hand does
  std::array<double, 3> place{}, velocity{};
  std::array<double, 9> frame = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // row after row
  double apart = 0.5;                                         // of the gripper, rad
  unsigned buttons = 0;
  // how it goes
  int rate = 1000;
  int stall_ms = 0;    // the next force waits so much longer, once
  int code = 0;        // of every success: 1 time guard, 2 saturated
  int read_error = 0;  // of every reading from now on; 0: none
  int write_error = 0, velocity_error = 0;
  int off_cause = 0;  // forces off, why
  int power = 1, connected = 1;
  bool tells = true;  // what GetStatus() fills in; false: all zero
  // what was told
  bool open = false, force_on = false, gravity = false, regulates = false;
  double most_force = -1, most_torque = -1;  // SetMaxForce(), SetMaxTorque()
  int watchdog = 0;                          // in eighths of a millisecond; 0: none
  bool watches = false;           // and it acts: forces are off for good after so long without one
  std::vector<FakeForce> forces;  // newest last; the newest 4096
  double largest_force = 0, largest_torque = 0;  // of all
  Answers answers;
  std::uint64_t writes = 0, reads = 0, opened = 0, closed = 0, homed = 0, asked = 0;
  std::int64_t next_ns = 0;  // when the frame after this one is due
  std::int64_t written_ns = 0;
};

struct FakeDhd {
  FakeLock lock;  // over all of it
  std::array<FakeArm, 3> arm;
  bool guards_watchdog = false;  // behind the expert mode
  bool expert = false;
  unsigned misuse = 0;  // calls that move an arm unasked, or push what is not held
  std::string misused;  // the first of them
};

using FakeDhdState = FakeDhd* (*)();

}  // namespace burr::test
