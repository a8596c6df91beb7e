// apps/burr/window/parts/hud.h - the values that the user needs while milling: a strip at the lower
// edge of the picture and a line of text above it.
//
// Takes plain data. Units: SI; the user reads mm, N and rpm. Thread: main,
// between Ui::begin() and draw().
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "burr/tick/servo.h"
#include "shared/word_names.h"
#include "window/ui/ui.h"

namespace burr::app {

// How well the haptic loop keeps its ticks.
enum class TickHealth {
  good,
  busy,  // some work is put off, or a few ticks were missed recently
  lost,  // the watchdog had to release the force
};

struct HudState {
  double force = 0;         // on the hand                              [N]
  double user_limit = 0;    // [N]
  double device_limit = 0;  // [N]
  double press = 0;         // depth of the arm's target below the surface [m]
  double press_most = 1;    // [m]
  bool pressing = false;
  double speed = 0, full_speed = 0;  // of the spindle                    [rad/s]
  double load = 0;                   // share of the motor's torque       [0..1]
  double burr_diameter = 0;          // of another tool: how wide it cuts  [m]
  bool diamond = false;
  std::string tool;                 // title; "": the round burr
  bool turns = true, motor = true;  // otherwise: strokes; the hand alone moves it
  tick::ToolMode mode = tick::ToolMode::cut;
  double removed = 0;  // [m^3]
  double seconds = 0;
  struct Nearest {
    std::string name;
    double distance = 0;  // from the burr's surface; below 0: inside     [m]
  };
  std::optional<Nearest> nearest;  // of the structures to spare; none: too far away
  bool spares = false;             // there is a structure to spare
  bool device = false;             // a haptic device is in use: show how the ticks are kept
  TickHealth ticks = TickHealth::good;
  double p99_us = 0, max_us = 0;
  std::uint64_t missed = 0;
  int picture_step = 0;     // render::FrameGovernor's
  float column = 0;         // width at the right that slices cover [pixel]
  double pixel = 0;         // size of one at the camera's target  [m]
  std::string mirror;       // the plane of the mirror; "" for none
  std::string note;         // the last message
  bool note_stays = false;  // until the user clicks it away
  std::string warning;      // "" for none
};

// True: the user clicked the note away.
[[nodiscard]] bool draw_hud(Ui& ui, const HudState& state);
// Height of the strip and the line, from the bottom [pixel]; nothing else is drawn there.
[[nodiscard]] float hud_height(const Ui& ui);

// What lies between these two may be covered by a line of text [pixel].
struct LineRoom {
  float left = 0, right = 0;
};

// Writes a text above the strip, in the middle of its room, in as many lines as it needs; `y` is moved
// up by its height. warns: a warning sign before it. stays: it takes a click, and true is returned.
bool line_above(Ui& ui, float& y, const std::string& text, bool warns, LineRoom room,
                bool stays = false);

// Writes that a mirror is on, at the top, centred in the width that `column` at the right leaves.
// Nothing for an empty text.
void draw_mirror_sign(const Ui& ui, const std::string& words, float column);

[[nodiscard]] Word name_of(tick::ToolMode mode);

// "4:07"
[[nodiscard]] std::string minutes(double seconds);
// "1:04.2"
[[nodiscard]] std::string clock_of(double seconds);

}  // namespace burr::app
