// apps/burr/window/start/hand_choice.h - choice on the start page of what moves the burr: the mouse
// or a haptic device. The device is looked for at once, so that the user knows before opening a
// bone.
//
// The check opens the device and closes it again, on a thread of its own; nothing moves and no
// force is sent. While the page is shown, a device that was not found is looked for again, because
// it may be plugged in later. Thread: main.
#pragma once

#include <chrono>
#include <future>
#include <optional>
#include <string>

#include "burr/workshop/hand_device.h"
#include "window/ui/ui.h"

namespace burr::app {

class HandChoice {
 public:
  // request: from the command line or the settings
  explicit HandChoice(workshop::HandRequest request);

  // Draws a line to choose in, and below it what was found. True: the user chose another one.
  [[nodiscard]] bool draw(Ui& ui, float x, float y, float w);

  [[nodiscard]] const workshop::HandRequest& request() const { return request_; }
  // The result as it was shown last; empty for the mouse.
  [[nodiscard]] const std::string& found() const { return words_; }
  // Waits until the check is over, so that the device is closed. Call it before a session opens the
  // device.
  void rest();

 private:
  struct Found {
    bool there = false;
    std::string words;
  };
  void look();

  workshop::HandRequest request_;
  std::future<Found> looks_;
  std::chrono::steady_clock::time_point looked_;
  std::string words_;
  std::optional<bool> there_;  // none: not known yet
};

}  // namespace burr::app
