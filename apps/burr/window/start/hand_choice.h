// apps/burr/window/start/hand_choice.h - what leads the burr, chosen on the start page: the mouse, or a
// haptic device, which is looked for at once so that one knows before a bone is open.
//
// Looking opens the device and closes it again, on a thread of its own; nothing moves and nothing
// is pushed. One that is not there is looked for again while the page is shown: it may be plugged
// in now. Thread: main.
#pragma once

#include <chrono>
#include <future>
#include <optional>
#include <string>

#include "burr/workshop/hand_device.h"
#include "window/shell/ui.h"

namespace burr::app {

class HandChoice {
 public:
  // request: of the command line, or of the settings
  explicit HandChoice(workshop::HandRequest request);

  // A line to choose in, and what was found below it. True: something else was chosen.
  [[nodiscard]] bool draw(Ui& ui, float x, float y, float w);

  [[nodiscard]] const workshop::HandRequest& request() const { return request_; }
  // In words, as shown last; empty for the mouse.
  [[nodiscard]] const std::string& found() const { return words_; }
  // Before a session opens it: the device is closed again.
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
