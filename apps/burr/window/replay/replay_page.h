// apps/burr/window/replay/replay_page.h - the page that plays a recording: bone, tool and force at
// any moment, above a time line of the whole session. A second recording that is dropped on the
// page is shown beside it, at the same moment and from the same viewpoint.
//
// Thread: main; the bone is restored on a thread of its own (playback.h).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "burr/math/vec3.h"
#include "window/parts/toolbar.h"
#include "window/replay/playback.h"
#include "window/ui/closed.h"
#include "window/ui/desk.h"

namespace burr::app {

// The present state of the page, for tests and other observers.
struct Watched {
  double t = 0;      // requested                    [s]
  double shown = 0;  // moment that the picture shows [s]
  bool playing = false;
  double pace = 1;
  bool behind = false;  // the picture of the requested moment is not ready yet
  bool known = false;   // force and so on are those of the requested moment, and are shown
  double force = 0;     // as shown              [N]
  double removed = 0;   // as shown              [m^3]
  double diameter = 0;  // of the burr, as shown [m]
  // the second recording: whether there is one; what its half shows; how much later it begins
  bool beside = false;
  double shown_beside = 0, removed_beside = 0, shift = 0;  // [s], [m^3], [s]
  double film_from = 0, film_until = 0;                    // the part that a film shows  [s]
  // measured: the table of losses is complete; coloured: the bones show the difference;
  // slices: 0 none, through the burr of the 1 left, 2 right recording
  bool measured = false, coloured = false;
  int slices = 0;
  std::string note;         // the last message
  std::string line = {};    // above the strip: that message, or how far a film is
  bool note_stays = false;  // until the user clicks it away
  bool panels = true, help = false, exporting = false;  // shown
  std::vector<BarPlace> buttons = {};                   // of the bar and of the strip
  BarPlace table = {};                                  // of two recordings; w 0: not shown
};

struct WatchOptions {
  double seconds = 0;           // closes after this time; 0: when the user closes it
  std::string folder = {};      // for pictures of the key P; empty: the start folder
  std::string screenshot = {};  // PNG of the last picture; empty: none
  double from = -1;             // first moment shown; below 0: plays from the start  [s]
  double until = -1;            // plays from `from` to this moment; below 0: does not play [s]
  std::optional<math::Vec3> place = {};  // has a ring; world
  std::string note = {};                 // shown while there is no other message
  std::string beside = {};               // a second recording for the right half; empty: none
  // opens a recording while a loading page is shown; closed: set if the user closed the window
  std::function<Result<Recorded>(const std::string& file, bool& closed)> open = {};
  Watched* seen = nullptr;  // updated in each picture
};

// Runs until the user leaves the page.
[[nodiscard]] Result<Closed> watch(Desk& desk, Recorded& recorded, const WatchOptions& options);

}  // namespace burr::app
