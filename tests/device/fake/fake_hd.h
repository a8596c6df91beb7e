// A libHD.so without a device: plays what a test wants and records the calls.
//
// It is loaded like the real one. The test reaches its state by the exported fake_hd(). Frames come
// from a thread of its own, `rate` a second, or one by one from fake_hd_frame().
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "device/fake/answers.h"

namespace burr::test {

struct FakeTouch {
  std::string name = "Default Device", model = "Touch", serial = "T-0001";
  bool present = true, in_use = false;
  double nominal_force = 3.3, nominal_continuous = 0.88;
  std::array<double, 16> transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  // mm
  std::array<double, 3> velocity{};                                                     // mm/s
  int buttons = 0;
  int output_dof = 3;        // -1: it does not know
  bool tells_driver = true;  // the version of the driver
  bool takes_torque = true;  // with six degrees of freedom
  unsigned calibration = 0x5000, style = 2;
  unsigned frame_error = 0;  // error of every frame from now on
  bool force_on = false, open = false;
  bool left_on = false;  // state of the force when it was disabled last
  // calls received
  std::vector<std::array<double, 3>> forces;  // one per frame, newest last; the newest 4096
  double largest_force = 0;                   // of all frames
  Answers answers;                            // mm, N
  std::array<double, 3> torque{};             // the last one [mN m]
  int torques = 0;                            // number of calls
  std::uint64_t frames = 0, opened = 0, closed = 0;
  std::uint64_t first_frame = 0;  // since it was opened
};

struct FakeHd {
  std::mutex mutex;  // protects everything here
  std::array<FakeTouch, 2> touch;
  int rate = 1000;          // frames a second of its own; 0: only fake_hd_frame()
  int stall_ms = 0;         // the next frame comes so much later, once
  bool needs_name = false;  // an old driver: nullptr finds nothing
  bool no_room = false;     // the scheduler is full
  unsigned misuse = 0;      // calls that the real library would refuse
  std::string misused;      // the first of those calls
  int starts = 0, stops = 0, loops = 0;
};

using FakeHdState = FakeHd* (*)();
using FakeHdFrame = void (*)();  // one frame of every device, on the calling thread

}  // namespace burr::test
