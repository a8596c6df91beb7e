// apps/burr/window/replay/replay_page.h - a recorded session watched again: the bone, the tool and the
// force at any moment, over a line of the whole session. A second one, dropped on it, is watched
// beside it: at the same moment and from the same side.
//
// Thread: main; the bone is made what it was on a thread of its own (playback.h).
#pragma once

#include <functional>
#include <string>

#include "window/mill/window_options.h"
#include "window/replay/playback.h"
#include "window/shell/desk.h"

namespace burr::app {

// What is watched now, for whoever looks on.
struct Watched {
  double t = 0;      // wanted                       [s]
  double shown = 0;  // that the picture is of       [s]
  bool playing = false;
  double pace = 1;
  bool behind = false;  // the picture is not there yet
  double force = 0;     // shown as a number        [N]
  double removed = 0;   // likewise                 [m^3]
  double diameter = 0;  // of the burr, likewise    [m]
  // the recording beside it: is there one; what its half shows; how much later it begins
  bool beside = false;
  double shown_beside = 0, removed_beside = 0, shift = 0;  // [s], [m^3], [s]
  std::string note;                                        // told last
};

struct WatchOptions {
  double seconds = 0;           // closes by itself after so long; 0: when the user closes it
  std::string folder = {};      // where P leaves pictures; empty: where the program was started
  std::string screenshot = {};  // a PNG of the window as it was last; empty: none
  double from = -1;             // the moment first shown; below 0: the start, and it plays  [s]
  std::string beside = {};      // another recording, watched in the right half; empty: none
  // opens it, with a page meanwhile; closed: the window was
  std::function<Result<Recorded>(const std::string& file, bool& closed)> open = {};
  Watched* seen = nullptr;  // kept true
};

// Until it is left.
[[nodiscard]] Result<Left> watch(Desk& desk, Recorded& recorded, const WatchOptions& options);

}  // namespace burr::app
