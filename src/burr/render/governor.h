// render/governor.h - decides what to leave out of the picture to keep the frame rate.
//
//     everything -> no grain, few samples of hollows -> coarser -> 0.87 of the samples -> 0.75
//
//     FrameGovernor governor(renderer.software());
//     each frame:  scene.quality = governor.begin(scene.camera, now);
//                  renderer.show(scene);
//                  governor.end(took_s, renderer.figures().redrawn, now);
//
// There are separate steps and budgets for a moving eye, which redraws the whole picture, and for
// an eye at rest in front of the work. When both eye and work rest, what was left out is drawn. The
// governor never changes the haptics. It is a pure function of its arguments and has no clock of
// its own. Thread: main. Units: s.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "burr/render/camera.h"
#include "burr/render/quality.h"

namespace burr::render {

struct GovernorSettings {
  double moving_s = 0.040;  // longest frame while the eye moves: 25 pictures a second
  double work_s = 0.028;    // longest frame while it rests: 35 pictures a second
  double calm_s = 3;        // time with room to spare before a step back
  double calm_most_s = 60;  // ... after a step back that had to be undone
  double rest_s = 0.2;      // time after a movement until the eye counts as resting
  int most = 4;             // highest step; 0: never leaves anything out
};

class FrameGovernor {
 public:
  static constexpr int kSteps = 5;
  // software: the processor draws, so begin with steps that it can manage.
  explicit FrameGovernor(bool software, const GovernorSettings& settings = {});

  [[nodiscard]] Quality begin(const Camera& camera, double now);
  // took: time of the frame; redrawn: share of the picture that was drawn, 0..1.
  void end(double took, double redrawn, double now);

  // Sets the budget while the eye moves, for the frame rate of a headset.
  void allow_moving(double seconds) { settings_.moving_s = seconds; }

  [[nodiscard]] bool moving() const { return moving_; }
  [[nodiscard]] int step() const { return steps_[index()].at; }  // of the frame begun last
  [[nodiscard]] static const char* name(int step);

  // number of frames drawn at each step so far
  [[nodiscard]] const std::array<std::uint64_t, kSteps>& frames() const { return frames_; }

 private:
  struct Step {
    int at = 0;
    double smoothed = 0;      // mean of the frame times [s]
    double roomy_since = -1;  // since when there is time to spare; -1: there is none
    double calm = 0;          // time to wait before the next step back [s]
    double back_at = -1e9;    // time of the last step back
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
