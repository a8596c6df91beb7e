#include "window/hands/spacemouse.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "window/hands/gamepad.h"

namespace burr::app {
namespace {

constexpr int kMotion = 1, kButton = 2;
constexpr double kFull = 350;  // what libspnav reports for a cap moved all the way, about
constexpr int kMostEvents = 256;
// the daemon sends events while the cap is moved, and one when it is released; a daemon that died
// sends none
constexpr auto kStale = std::chrono::milliseconds(500);

}  // namespace

void SpaceMouse::open() {
  if (open_) return;
  if (!looked_) {
    looked_ = true;
    const char* other = std::getenv("BURR_SPNAV");
    void* library = dlopen(other != nullptr ? other : "libspnav.so.0", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return;
    spnav_open_ = reinterpret_cast<Plain>(dlsym(library, "spnav_open"));
    spnav_close_ = reinterpret_cast<Plain>(dlsym(library, "spnav_close"));
    spnav_poll_event_ = reinterpret_cast<Poll>(dlsym(library, "spnav_poll_event"));
  }
  if (spnav_open_ == nullptr || spnav_close_ == nullptr || spnav_poll_event_ == nullptr) return;
  open_ = spnav_open_() != -1;
}

SpaceMouse::~SpaceMouse() {
  if (open_) spnav_close_();
}

CapMotion SpaceMouse::now(double dead) {
  CapMotion cap;
  if (!open_) return cap;
  Event event = {};
  for (int n = 0; n < kMostEvents && spnav_poll_event_(&event) != 0; ++n) {
    if (event.type == kMotion) {
      std::copy(std::begin(event.motion.axes), std::end(event.motion.axes), axes_);
      moved_ = std::chrono::steady_clock::now();
    } else if (event.type == kButton && event.button.press != 0) {
      cap.buttons.push_back(event.button.number);
    }
  }
  if (std::chrono::steady_clock::now() - moved_ > kStale)
    std::fill(std::begin(axes_), std::end(axes_), 0);
  double* const to[] = {&cap.right, &cap.up, &cap.away, &cap.tilt, &cap.twist, &cap.roll};
  for (int n = 0; n < 6; ++n) *to[n] = beyond_dead(axes_[n] * (32767 / kFull), dead);
  // as in gamepad.h: a cap that was pushed down while a page was open must be released first
  if (cap.up >= 0) armed_ = true;
  if (!armed_) cap.up = std::max(cap.up, 0.0);
  return cap;
}

}  // namespace burr::app
