// apps/burr/window/replay/timeline_panel.h - the strip below a recording that is played: values of
// the moment, and a time line of the whole session with force, strokes and commands, on which the
// user can drag.
//
// Takes plain data, returns what the user did. Thread: main, between Ui::begin() and draw().
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/record/timeline.h"
#include "burr/tick/servo.h"
#include "window/parts/toolbar.h"
#include "window/replay/facts.h"
#include "window/ui/ui.h"

namespace burr::app {

// The values of one recording at this moment.
struct TimelineMoment {
  const record::Timeline* line = nullptr;  // nullptr: no recording
  double from = 0;                         // its start on the shared clock  [s]
  bool known = true;                       // false: the next three are not those of this moment
  double force = 0;                        // [N]
  double removed = 0;                      // [m^3]
  double speed = 0;                        // of the spindle  [rad/s]
  double burr_diameter = 0;                // [m]
  tick::ToolMode mode = tick::ToolMode::cut;
  const Facts* facts = nullptr;  // distances and violations; nullptr: not measured
};

struct TimelineState {
  TimelineMoment first, second;  // the second is drawn below the first, on the same clock
  double seconds = 0;            // length on that clock
  double t = 0;
  bool playing = false, behind = false;
  double pace = 1;
  double film_from = 0, film_until = 0;  // the part that a film shows  [s]
  std::string note;                      // the last message
  bool note_stays = false;               // until the user clicks it away
  std::string warning;                   // "" for none
  float column = 0;                      // at the right, that slices cover [pixel]
};

struct TimelineDone {
  std::optional<double> scrubbed;              // to this moment; the mouse button is still down
  bool play = false;                           // the button play or pause was pressed
  int pace = 0;                                // -1: slower, 1: faster
  bool film_from = false, film_until = false;  // the film begins, ends at this moment
  bool note_away = false;                      // the note was clicked away
  std::vector<BarPlace> places = {};           // where the buttons lie
};

[[nodiscard]] TimelineDone draw_timeline(Ui& ui, const TimelineState& state);

// A command as text for the user: "burr of 4 mm", or that there was no room for it.
[[nodiscard]] std::string command_text(const record::TimelineEvent& event);

}  // namespace burr::app
