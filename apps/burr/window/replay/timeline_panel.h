// apps/burr/window/replay/timeline_panel.h - the strip below a watched session: numbers of the moment, and
// the whole session as a line to scrub on, with force, strokes and commands.
//
// Plain data in, what the user did comes back. Thread: main, between Ui::begin() and draw().
#pragma once

#include <optional>
#include <string>

#include "burr/record/timeline.h"
#include "burr/tick/servo.h"
#include "window/shell/ui.h"

namespace burr::app {

// Of one recording, now.
struct TimelineMoment {
  const record::Timeline* line = nullptr;  // none: no recording
  double from = 0;                         // its start on the shared clock  [s]
  double force = 0;                        // [N]
  double removed = 0;                      // [m^3]
  double speed = 0;                        // of the spindle  [rad/s]
  double burr_diameter = 0;                // [m]
  tick::ToolMode mode = tick::ToolMode::cut;
};

struct TimelineState {
  TimelineMoment first, second;  // the second below the first, by the same clock
  double seconds = 0;            // of that clock
  double t = 0;
  bool playing = false, behind = false;
  double pace = 1;
  std::string note;     // the last thing done
  std::string warning;  // what must be known; "" for nothing
};

struct TimelineDone {
  std::optional<double> scrubbed;  // to this moment, the button is still down
  bool play = false;               // play or pause was pressed
  int pace = 0;                    // slower -1, faster 1
};

[[nodiscard]] TimelineDone draw_timeline(Ui& ui, const TimelineState& state);

// What a command says to people: "burr of 4 mm", or that there was no room for it.
[[nodiscard]] std::string command_text(const record::TimelineEvent& event);

}  // namespace burr::app
