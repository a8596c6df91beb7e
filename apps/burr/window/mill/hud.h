// apps/burr/window/mill/hud.h - what one must know while milling, slim and at the edge of the picture: a
// strip below and a line of words above it.
//
// Plain data in, nothing comes back. Units: SI; people read mm, N and rpm. Thread: main, between
// Ui::begin() and draw().
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "burr/tick/servo.h"
#include "window/shell/ui.h"
#include "window/shell/words.h"

namespace burr::app {

// How well the ticks of touch come through.
enum class TickHealth {
  good,
  busy,  // something is put off for them, or a few were missed lately
  lost,  // the watchdog had to let go of the hand
};

struct HudState {
  double force = 0;         // that the hand gets                         [N]
  double user_limit = 0;    // [N]
  double device_limit = 0;  // [N]
  double press = 0;         // how far below the surface the arm is aimed [m]
  double press_most = 1;    // [m]
  bool pressing = false;
  double speed = 0, full_speed = 0;  // of the spindle                    [rad/s]
  double load = 0;                   // share of the motor's torque       [0..1]
  double burr_diameter = 0;          // [m]
  bool diamond = false;
  tick::ToolMode mode = tick::ToolMode::cut;
  double removed = 0;  // [m^3]
  double seconds = 0;
  struct Nearest {
    std::string name;
    double distance = 0;  // from the burr's surface; below 0: inside     [m]
  };
  std::optional<Nearest> nearest;  // of what is to be spared; none: farther than is looked
  bool spares = false;             // there is something to spare
  TickHealth ticks = TickHealth::good;
  double p99_us = 0, max_us = 0;
  std::uint64_t missed = 0;
  int picture_step = 0;  // render::FrameGovernor's
  float column = 0;      // at the right that is taken by slices  [pixel]
  double pixel = 0;      // of the drawing area, at the depth of the camera's target  [m]
  std::string mirror;    // which plane one sculpts across; "" for none
  std::string note;      // the last thing done
  std::string warning;   // what must be known; "" for nothing
};

void draw_hud(Ui& ui, const HudState& state);
// The strip's and the line's own places are kept free by others: height from the bottom [pixel].
[[nodiscard]] float hud_height(const Ui& ui);

// Words in the middle above the strip, upwards from y; a sign before them where they warn.
void line_above(const Ui& ui, float& y, const std::string& text, bool warns);

// A word at the top, in the middle of what `column` at the right leaves: what is done here is done
// elsewhere too. Nothing if there are no words.
void draw_mirror_sign(const Ui& ui, const std::string& words, float column);

[[nodiscard]] Word name_of(tick::ToolMode mode);

// "4:07"
[[nodiscard]] std::string minutes(double seconds);

}  // namespace burr::app
