// apps/burr/window/mill/drill.h - the user's commands for the drill: size, speed and kind of the
// burr, tool mode, coolant.
//
// Each call sends its command to the servo and returns a sentence for the user. Thread: main.
// Units: SI.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "burr/guidance/step_plan.h"
#include "burr/render/scene.h"
#include "burr/scenario/rack.h"
#include "burr/sim/session.h"
#include "shared/word_names.h"

namespace burr::app {

class Drill {
 public:
  Drill(sim::Session& session, render::Burr& shown);

  [[nodiscard]] std::string set_mode(tick::ToolMode mode);
  // the next size of the list that the voxels allow; the servo may still refuse it
  [[nodiscard]] std::string change_burr(int by);
  // the next size; after the largest comes the smallest, because a pedal has one button for it
  [[nodiscard]] std::string next_burr();
  [[nodiscard]] std::string slower();
  [[nodiscard]] std::string faster();
  [[nodiscard]] std::string toggle_kind();
  // The round burr that suits a step (guidance/step_plan.h), and whether it adds or cuts.
  [[nodiscard]] std::string suit(const scenario::Step& step);
  [[nodiscard]] guidance::BurrChoice burr_for(const scenario::Step& step) const;
  // number: in the session's list of tools, with the tool itself; -1, nullptr: the round burr
  [[nodiscard]] std::string take_tool(int number, const scenario::RackTool* tool);
  [[nodiscard]] std::string toggle_coolant();

  // Call it in each picture: returns whether a requested burr was accepted or refused; "" until
  // that is known.
  [[nodiscard]] std::string look();

  [[nodiscard]] tick::ToolMode mode() const { return mode_; }
  [[nodiscard]] bool irrigated() const { return irrigated_; }
  [[nodiscard]] double full_speed() const { return full_speed_; }  // requested  [rad/s]
  [[nodiscard]] int tool() const { return tool_; }                 // requested; -1: the round burr

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] double least_size() const;  // that the voxels allow; a diameter [m]
  std::string change_speed(double by_rpm);
  std::string change_tool_speed(int by);

  sim::Session& session_;
  render::Burr& shown_;
  tick::ToolMode mode_;
  double full_speed_;
  int tool_;                // in the session's list
  double usual_speed_ = 0;  // of that tool; 0: it has no motor, or is the round burr  [rad/s]
  double burr_speed_;       // of the round burr, while another tool is in the hand    [rad/s]
  bool irrigated_;
  std::optional<double> requested_;  // requested radius, until the servo has it or has refused [m]
  Clock::time_point requested_at_{};
};

}  // namespace burr::app
