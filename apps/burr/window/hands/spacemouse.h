// apps/burr/window/hands/spacemouse.h - a SpaceMouse through libspnav, found when burr runs and never
// linked; without library or daemon there is none, and nothing is said.
//
//     spacenavd --socket--> libspnav.so.0 --now()--> the page one works on
//
// BURR_SPNAV names another library instead. The library stays loaded. Thread: main. Units: 1 is the
// cap all the way.
#pragma once

#include <chrono>
#include <vector>

namespace burr::app {

// Axes as libspnav gives them: right, up, away from the user; turns about them.
struct CapMotion {
  double right = 0, up = 0, away = 0;    // [-1..1]
  double tilt = 0, twist = 0, roll = 0;  // [-1..1]
  std::vector<int> buttons = {};         // went down since the last now()
};

class SpaceMouse {
 public:
  SpaceMouse() { open(); }
  SpaceMouse(const SpaceMouse&) = delete;
  SpaceMouse& operator=(const SpaceMouse&) = delete;
  ~SpaceMouse();

  // Once more, where the daemon was not there before.
  void open();
  [[nodiscard]] bool there() const { return open_; }
  // Takes what came since the last call.
  [[nodiscard]] CapMotion now(double dead);
  void disarm() { armed_ = false; }

 private:
  // What libspnav writes; larger than any of its versions did so far.
  union Event {
    int type;
    struct {
      int type, axes[6];
      unsigned period;
      int* data;
    } motion;
    struct {
      int type, press, number;
    } button;
    unsigned char room[256];
  };
  using Plain = int (*)();
  using Poll = int (*)(Event*);

  Plain spnav_open_ = nullptr, spnav_close_ = nullptr;
  Poll spnav_poll_event_ = nullptr;
  bool looked_ = false, open_ = false, armed_ = false;
  int axes_[6] = {};
  std::chrono::steady_clock::time_point moved_{};
};

}  // namespace burr::app
