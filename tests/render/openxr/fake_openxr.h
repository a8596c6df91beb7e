// tests/render/openxr/fake_openxr.h - an OpenXR loader and runtime that a test plays: what it says
// of head and wand, and what it was told. A shared object of its own, opened as a real loader is
// (BURR_OPENXR_LOADER); the test opens it as well and asks for fake_xr().
//
// It demands what the specification demands, answers with the specification's errors, and notes
// each breach. Its state is the process's: forget() before each test. Thread: any; `mutex` for the
// rest.
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
  std::condition_variable told;

  // ---- what it is
  bool no_runtime = false, no_headset = false, no_opengl = false;
  bool hangs = false;          // xrWaitFrame does not come back
  bool instance_lost = false;  // nothing is left
  std::uint32_t width = 320, height = 300;
  XrPosef head = {{0, 0, 0, 1}, {0, 0, 0}};
  float eyes_apart = 0.064F;
  std::array<XrFovf, 2> fov = {{{-0.8F, 0.6F, 0.7F, -0.75F}, {-0.6F, 0.8F, 0.7F, -0.75F}}};
  bool views_known = true, shows = true;
  XrPosef wand = {{0, 0, 0, 1}, {0.1F, -0.1F, -0.4F}};
  bool wand_tracked = true;
  float trigger = 0;

  // ---- what happens: told by xrPollEvent, one after the other
  void happens(XrSessionState next) {
    const std::lock_guard lock(mutex);
    events.push_back(next);
  }
  std::deque<XrSessionState> events;
  bool instance_loss_pending = false;

  // ---- what it saw
  struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // from the bottom
    XrPosef pose = {};
  };
  std::array<Picture, 2> pictures;  // of the last frame that had any
  int waited = 0, begun = 0, ended = 0, with_pictures = 0;
  int instances = 0, sessions = 0;  // that are there
  std::vector<std::string> breaches;
  XrSessionState state = XR_SESSION_STATE_UNKNOWN;
};

}  // namespace burr::test

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" burr::test::FakeXr* fake_xr();
extern "C" void fake_xr_forget();
