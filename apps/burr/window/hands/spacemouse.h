// apps/burr/window/hands/spacemouse.h - a SpaceMouse through libspnav. The library is loaded when
// burr runs, never linked. Without the library or its daemon there is no SpaceMouse, and no
// message.
//
//     spacenavd --socket--> libspnav.so.0 --now()--> the page one works on
//
// The environment variable BURR_SPNAV names another library. The library stays loaded. As in
// gamepad.h, a cap that was pushed down counts only after it has been released. Thread: main.
// Units: 1 is the cap moved all the way.
#pragma once

#include <chrono>
#include <vector>

namespace burr::app {

// Axes as libspnav reports them: right, up, away from the user; and rotations about them.
struct CapMotion {
  double right = 0, up = 0, away = 0;    // [-1..1]
  double tilt = 0, twist = 0, roll = 0;  // [-1..1]
  std::vector<int> buttons = {};         // pressed since the last call of now()
};

class SpaceMouse {
 public:
  SpaceMouse() { open(); }
  SpaceMouse(const SpaceMouse&) = delete;
  SpaceMouse& operator=(const SpaceMouse&) = delete;
  ~SpaceMouse();

  // Tries again, in case the daemon was not running before.
  void open();
  [[nodiscard]] bool there() const { return open_; }
  // Returns what was reported since the last call.
  [[nodiscard]] CapMotion now(double dead);
  void disarm() { armed_ = false; }

 private:
  // What libspnav writes; larger than the event of any of its versions so far.
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
