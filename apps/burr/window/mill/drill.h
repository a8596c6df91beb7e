// apps/burr/window/mill/drill.h - what the user commands of the drill: the burr, its speed, its kind,
// what it does, the coolant.
//
// Each call sends its command to the servo and returns the sentence for the user. Thread: main.
// Units: SI.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "burr/render/scene.h"
#include "burr/sim/session.h"
#include "window/shell/words.h"

namespace burr::app {

class Drill {
 public:
  Drill(sim::Session& session, render::Burr& shown);

  [[nodiscard]] std::string set_mode(tick::ToolMode mode);
  // the next size of the list that the voxels allow; the servo has the last word
  [[nodiscard]] std::string change_burr(int by);
  // the next size, and after the largest the smallest: a foot has one button for it
  [[nodiscard]] std::string next_burr();
  [[nodiscard]] std::string slower();
  [[nodiscard]] std::string faster();
  [[nodiscard]] std::string toggle_kind();
  [[nodiscard]] std::string toggle_coolant();

  // Each picture: the burr as it is now; returns whether a requested one came, "" while that is open.
  [[nodiscard]] std::string look();

  [[nodiscard]] tick::ToolMode mode() const { return mode_; }
  [[nodiscard]] double full_speed() const { return full_speed_; }  // requested  [rad/s]

 private:
  using Clock = std::chrono::steady_clock;
  std::string change_speed(double by_rpm);

  sim::Session& session_;
  render::Burr& shown_;
  tick::ToolMode mode_;
  double full_speed_;
  bool irrigated_;
  std::optional<double> requested_;  // radius, until it is there or refused  [m]
  Clock::time_point requested_at_{};
};

}  // namespace burr::app
