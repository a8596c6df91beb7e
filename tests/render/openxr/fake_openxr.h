// tests/render/openxr/fake_openxr.h - an OpenXR loader and runtime that the test plays: it sets the
// poses of head and wand, and records the calls. It is a shared object of its own, opened like a
// real loader (BURR_OPENXR_LOADER); the test opens it too and calls fake_xr().
//
// It checks the rules of the specification, answers with the specification's errors, and records
// each breach. Its state belongs to the process: call forget() before each test. Thread: any;
// `mutex` protects the rest.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#define XR_NO_PROTOTYPES
#include <openxr/openxr.h>

namespace burr::test {

struct FakeXr {
  mutable std::mutex mutex;
  std::condition_variable wakes;

  // ---- properties
  bool no_runtime = false, no_headset = false, no_opengl = false;
  bool hangs = false;          // xrWaitFrame does not return
  bool instance_lost = false;  // the instance is lost
  std::uint32_t width = 320, height = 300;
  XrPosef head = {{0, 0, 0, 1}, {0, 0, 0}};
  float eyes_apart = 0.064F;
  std::array<XrFovf, 2> fov = {{{-0.8F, 0.6F, 0.7F, -0.75F}, {-0.6F, 0.8F, 0.7F, -0.75F}}};
  bool views_known = true, shows = true;
  XrPosef wand = {{0, 0, 0, 1}, {0.1F, -0.1F, -0.4F}};
  bool wand_tracked = true;
  float trigger = 0;
  bool pen = false;  // it knows Logitech's MX Ink, and that is what the hand holds
  // the functions that vibrate are missing; no controller has the path; what applying them answers
  bool no_haptics = false, no_haptic_path = false;
  XrResult haptic_answer = XR_SUCCESS;

  // ---- events: reported by xrPollEvent in order
  void happens(XrSessionState next) {
    const std::lock_guard lock(mutex);
    events.push_back(next);
  }
  std::deque<XrSessionState> events;
  bool instance_loss_pending = false;

  // ---- calls received
  struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // bottom row first
    XrPosef pose = {};
  };
  std::array<Picture, 2> pictures;  // of the last frame with pictures
  // of the controller: strength now, the largest so far, and when it ends by itself [s after the call]
  float vibrates = 0, most_vibration = 0;
  double vibrates_for = 0;
  int applied = 0, stopped = 0;
  std::vector<std::string> bound;  // every path that was suggested, of the profiles it knows
  int waited = 0, begun = 0, ended = 0, with_pictures = 0;
  int instances = 0, sessions = 0;  // existing now
  std::vector<std::string> breaches;
  XrSessionState state = XR_SESSION_STATE_UNKNOWN;
};

}  // namespace burr::test

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" burr::test::FakeXr* fake_xr();
extern "C" void fake_xr_forget();
