// render/governor.h - what is left out of the picture, so that it keeps up: a frame-time governor.
//
//     everything -> no hollows -> coarser -> 0.87 of the samples -> 0.75
//
//     FrameGovernor governor(renderer.software());
//     each frame:  scene.quality = governor.begin(scene.camera, now);
//                  renderer.show(scene);
//                  governor.end(took_s, renderer.figures().redrawn, now);
//
// The eye that moves, which draws all of the picture, and the work before an eye at rest have steps
// and budgets of their own. When both rest, what was left out is made good. It never touches the
// haptics. A pure function of what it is told: no clock of its own. Thread: main. Units: s.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "burr/render/camera.h"
#include "burr/render/quality.h"

namespace burr::render {

struct GovernorSettings {
  double moving_s = 0.040;  // that a frame may take while the eye moves: 25 pictures a second
  double work_s = 0.028;    // ... while it rests: 35
  double calm_s = 3;        // with room to spare before a step back
  double calm_most_s = 60;  // ... after steps back that had to be taken again
  double rest_s = 0.2;      // after the eye stopped: it rests
  int most = 4;             // highest step; 0: never leaves anything out
};

class FrameGovernor {
 public:
  static constexpr int kSteps = 5;
  // software: the processor draws, so it begins with what that can do.
  explicit FrameGovernor(bool software, const GovernorSettings& settings = {});

  [[nodiscard]] Quality begin(const Camera& camera, double now);
  // took: the frame; redrawn: part of the picture that was drawn, 0..1.
  void end(double took, double redrawn, double now);

  // Another budget while the eye moves, as a headset's pace asks for.
  void allow_moving(double seconds) { settings_.moving_s = seconds; }

  [[nodiscard]] bool moving() const { return moving_; }
  [[nodiscard]] int step() const { return steps_[index()].at; }  // of the frame begun last
  [[nodiscard]] static const char* name(int step);

  // frames drawn at each step so far
  [[nodiscard]] const std::array<std::uint64_t, kSteps>& frames() const { return frames_; }

 private:
  struct Step {
    int at = 0;
    double smoothed = 0;      // of the frames' times                 [s]
    double roomy_since = -1;  // -1: there is none to spare
    double calm = 0;          // wanted before the next step back     [s]
    double back_at = -1e9;    // when the last step back was taken
  };
  [[nodiscard]] std::size_t index() const { return moving_ ? 1 : 0; }

  GovernorSettings settings_;
  std::array<Step, 2> steps_;  // at rest, moving
  std::optional<Camera> camera_;
  double moved_at_ = -1e9;
  bool moving_ = false, first_at_rest_ = false;
  std::array<std::uint64_t, kSteps> frames_ = {};
};

}  // namespace burr::render
