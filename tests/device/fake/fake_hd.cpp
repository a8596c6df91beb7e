#include "device/fake/fake_hd.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <thread>

#include "device/fake/own_way.h"

namespace burr::test {
namespace {

FakeHd& state() {
  static FakeHd one;
  return one;
}

struct Loop {
  unsigned long id = 0;
  unsigned (*call)(void*) = nullptr;
  void* self = nullptr;
};

std::mutex loops_mutex;  // held while callbacks run, so that unscheduling waits for them
std::vector<Loop> loops;
[[maybe_unused]] unsigned long next_loop = 1;
std::atomic<bool> runs = false;
std::thread clock_thread;
bool moves = false;  // the hand moves by itself (own_way.h)

void move_by_itself(double t) {
  FakeTouch& touch = state().touch[0];
  const math::Vec3 mm = 1e3 * own_way(t);
  std::copy_n(mm.data(), 3, touch.transform.begin() + 12);
  touch.buttons = 1;
}

thread_local unsigned current = 0xFFFFFFFF;
thread_local bool in_frame = false;
thread_local std::deque<unsigned> errors;

void misuse(const char* what) {
  FakeHd& hd = state();
  if (hd.misuse++ == 0) hd.misused = what;
  errors.push_back(0x0102);
}

FakeTouch* touch_of(unsigned handle) {
  return handle < state().touch.size() ? &state().touch[handle] : nullptr;
}

FakeTouch* framed(const char* what) {
  FakeTouch* touch = touch_of(current);
  if (touch == nullptr || !touch->open) {
    misuse(what);
    return nullptr;
  }
  return touch;
}

void frame_of_all() {
  const std::lock_guard lock(loops_mutex);
  for (std::size_t n = 0; n < loops.size();)
    if (loops[n].call(loops[n].self) == 1)
      ++n;
    else
      loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(n));
}

void run_clock() {
  auto next = std::chrono::steady_clock::now();
  while (runs) {
    int rate = 0, stall = 0;
    {
      const std::lock_guard lock(state().mutex);
      rate = state().rate;
      std::swap(stall, state().stall_ms);
    }
    const auto now = std::chrono::steady_clock::now();
    if (rate == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      next = now;
      continue;
    }
    const auto period = std::chrono::nanoseconds(1'000'000'000 / rate);
    next += period + std::chrono::milliseconds(stall);
    // A late frame may be followed by some that are close together, but not by a burst; a slow device sends none too early
    if (rate < 500)
      next = std::max(next, now + period);
    else if (next < now - std::chrono::milliseconds(20))
      next = now;
    std::this_thread::sleep_until(next);
    if (moves) {
      const std::lock_guard lock(state().mutex);
      move_by_itself(1e-3 *
                     static_cast<double>(state().touch[0].frames - state().touch[0].first_frame));
    }
    if (runs) frame_of_all();
  }
}

}  // namespace
}  // namespace burr::test

extern "C" {
struct FakeHdError {
  unsigned code;
  int internal;
  unsigned device;
};
}

using namespace burr::test;
#define HD extern "C" __attribute__((visibility("default")))

HD FakeHd* fake_hd() { return &state(); }
HD void fake_hd_frame() { frame_of_all(); }

HD unsigned hdInitDevice(const char* name) {
  const std::lock_guard lock(state().mutex);
  for (unsigned n = 0; n < state().touch.size(); ++n) {
    FakeTouch& touch = state().touch[n];
    const bool wanted = name == nullptr
                            ? n == 0 && !state().needs_name
                            : touch.name == name || (n == 0 && state().needs_name &&
                                                     std::strcmp(name, "Default PHANToM") == 0);
    if (!wanted) continue;
    if (!touch.present) {
      errors.push_back(0x0302);
      return 0xFFFFFFFF;
    }
    if (touch.in_use || touch.open) {
      errors.push_back(0x0301);
      return 0xFFFFFFFF;
    }
    touch.open = true;
    ++touch.opened;
    touch.first_frame = touch.frames;
    current = n;
    return n;
  }
  errors.push_back(0x0302);
  return 0xFFFFFFFF;
}

HD void hdDisableDevice(unsigned handle) {
  const std::lock_guard lock(state().mutex);
  FakeTouch* touch = touch_of(handle);
  if (touch == nullptr || !touch->open) return misuse("disabled what was not open");
  touch->open = false;
  touch->left_on = touch->force_on;
  touch->force_on = false;
  ++touch->closed;
}

HD void hdMakeCurrentDevice(unsigned handle) { current = handle; }

HD void hdBeginFrame(unsigned handle) {
  const std::lock_guard lock(state().mutex);
  if (in_frame) misuse("a frame in a frame");
  in_frame = true;
  current = handle;
  if (FakeTouch* touch = framed("a frame of what is not open")) {
    ++touch->frames;
    touch->forces.push_back({});
    if (touch->forces.size() > 4096)
      touch->forces.erase(touch->forces.begin(), touch->forces.begin() + 2048);
  }
}

HD void hdEndFrame(unsigned handle) {
  const std::lock_guard lock(state().mutex);
  if (!in_frame || current != handle) misuse("the end of no frame");
  in_frame = false;
  if (const FakeTouch* touch = framed("the end of a frame of what is not open")) {
    if (!touch->present)
      errors.push_back(0x0302);
    else if (touch->frame_error != 0)
      errors.push_back(touch->frame_error);
  }
}

HD FakeHdError hdGetError() {
  FakeHdError error = {};
  if (!errors.empty()) {
    error.code = errors.front();
    error.device = current;
    errors.pop_front();
  }
  return error;
}

HD const char* hdGetErrorString(unsigned) { return "as the maker says"; }

HD void hdEnable(unsigned what) {
  const std::lock_guard lock(state().mutex);
  if (FakeTouch* touch = framed("enabled without a device"); touch != nullptr && what == 0x4000)
    touch->force_on = true;
}

HD void hdDisable(unsigned what) {
  const std::lock_guard lock(state().mutex);
  if (FakeTouch* touch = framed("disabled without a device"); touch != nullptr && what == 0x4000)
    touch->force_on = false;
}

HD void hdGetDoublev(unsigned what, double* out) {
  const std::lock_guard lock(state().mutex);
  FakeTouch* touch = framed("read without a device");
  if (touch == nullptr) return;
  switch (what) {
    case 0x2050:
      std::copy_n(touch->transform.begin() + 12, 3, out);
      return;
    case 0x2051:
      std::copy(touch->velocity.begin(), touch->velocity.end(), out);
      return;
    case 0x2052:
      std::copy(touch->transform.begin(), touch->transform.end(), out);
      touch->answers.tell(out + 12);
      return;
    case 0x2603:
      *out = touch->nominal_force;
      return;
    case 0x2604:
      *out = touch->nominal_continuous;
      return;
    default:
      errors.push_back(0x0100);
  }
}

HD void hdGetIntegerv(unsigned what, int* out) {
  const std::lock_guard lock(state().mutex);
  const FakeTouch* touch = framed("read without a device");
  if (touch == nullptr) return;
  if (what == 0x2000)
    *out = touch->buttons;
  else if (what == 0x2600)
    *out = 1000;
  else if (what == 0x2554 && touch->output_dof > 0)
    *out = touch->output_dof;
  else
    errors.push_back(0x0100);
}

HD void hdSetDoublev(unsigned what, const double* value) {
  const std::lock_guard lock(state().mutex);
  FakeTouch* touch = framed("force without a device");
  if (touch == nullptr) return;
  if (!in_frame) return misuse("force outside a frame");
  if (what == 0x2701) {
    if (touch->output_dof != 6) misuse("a torque on a device that has none");
    ++touch->torques;
    if (!touch->takes_torque) return errors.push_back(0x0100);
    std::copy_n(value, 3, touch->torque.begin());
    return;
  }
  if (what != 0x2700) return errors.push_back(0x0100);
  if (touch->forces.empty()) return misuse("force before a frame");
  std::copy_n(value, 3, touch->forces.back().begin());
  touch->answers.take(value);
  const double size = std::sqrt(value[0] * value[0] + value[1] * value[1] + value[2] * value[2]);
  if (!(size <= touch->largest_force)) touch->largest_force = size;  // a NaN is kept
}

HD const char* hdGetString(unsigned what) {
  const std::lock_guard lock(state().mutex);
  const FakeTouch* touch = framed("read without a device");
  if (touch == nullptr) return nullptr;
  if (what == 0x2501) return touch->model.c_str();
  if (what == 0x2504) return touch->serial.c_str();
  if (what == 0x2500) return "3.0";
  if (what == 0x2502 && touch->tells_driver) return "2019.2.15";
  errors.push_back(0x0100);
  return nullptr;
}

#ifndef FAKE_HD_OLD
HD unsigned long hdScheduleAsynchronous(unsigned (*call)(void*), void* self, unsigned short) {
  {
    const std::lock_guard lock(state().mutex);
    if (state().no_room) {
      errors.push_back(0x0501);
      return 0;
    }
    ++state().loops;
  }
  const std::lock_guard lock(loops_mutex);
  loops.push_back({next_loop, call, self});
  return next_loop++;
}
#endif

HD void hdUnschedule(unsigned long id) {
  const std::lock_guard lock(loops_mutex);
  std::erase_if(loops, [id](const Loop& loop) { return loop.id == id; });
}

HD void hdStartScheduler() {
  {
    const std::lock_guard lock(state().mutex);
    ++state().starts;
    if (runs) misuse("started twice");
  }
  if (const char* motion = std::getenv("FAKE_HD_MOTION"); motion != nullptr && *motion == '1')
    moves = true;
  runs = true;
  clock_thread = std::thread(run_clock);
}

HD void hdStopScheduler() {
  {
    const std::lock_guard lock(state().mutex);
    ++state().stops;
    if (!runs) return misuse("stopped twice");
  }
  runs = false;
  clock_thread.join();
}

HD unsigned hdCheckCalibration() {
  const std::lock_guard lock(state().mutex);
  const FakeTouch* touch = framed("calibration without a device");
  return touch != nullptr ? touch->calibration : 0x5000;
}

HD unsigned hdCheckCalibrationStyle() {
  const std::lock_guard lock(state().mutex);
  const FakeTouch* touch = framed("calibration without a device");
  return touch != nullptr ? touch->style : 2;
}

HD void hdUpdateCalibration(unsigned style) {
  const std::lock_guard lock(state().mutex);
  FakeTouch* touch = framed("calibration without a device");
  if (touch != nullptr && style == touch->style && style != 4) touch->calibration = 0x5000;
}
