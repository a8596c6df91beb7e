#include "burr/render/governor.h"

#include <algorithm>

namespace burr::render {
namespace {

constexpr double kFollow = 0.3;  // share of a new frame's time in the mean
constexpr double kRoom = 0.45;   // share of the budget; leaves room for what a step back may cost
constexpr int kSoftware = 2;     // first step where the processor draws

}  // namespace

FrameGovernor::FrameGovernor(bool software, const GovernorSettings& settings)
    : settings_(settings) {
  settings_.most = std::clamp(settings_.most, 0, kSteps - 1);
  for (Step& step : steps_) step.calm = settings_.calm_s;
  if (software) steps_[1].at = std::min(kSoftware, settings_.most);
}

Quality FrameGovernor::begin(const Camera& camera, double now) {
  if (camera_ && !same(*camera_, camera)) moved_at_ = now;
  camera_ = camera;
  const bool before = moving_;
  moving_ = now - moved_at_ < settings_.rest_s;
  first_at_rest_ = before && !moving_;

  const int moving = steps_[1].at, still = steps_[0].at;
  Quality quality;
  quality.ambient_occlusion = moving < 1;
  quality.coarse_px = moving < 2 ? 0 : 3;
  quality.ambient_occlusion_later = still >= 1;
  quality.coarse_still_px = still < 2 ? 0 : 1;
  quality.grain = moving < 1;
  quality.grain_still = still < 3;
  quality.refine = !moving_;
  quality.stain_s = still < 1 && moving < 1 ? 0.1 : still < 2 ? 0.5 : 2;
  const int step = steps_[index()].at;
  quality.scale = step < 3 ? 1 : step < 4 ? 0.87 : 0.75;
  return quality;
}

void FrameGovernor::end(double took, double redrawn, double now) {
  Step& step = steps_[index()];
  if (redrawn <= 0) return;  // nothing was drawn, so nothing was measured
  ++frames_[static_cast<std::size_t>(step.at)];
  if (first_at_rest_) return;  // it may have redrawn what was left out during the movement
  const double budget = moving_ ? settings_.moving_s : settings_.work_s;
  step.smoothed += kFollow * (std::min(took, 8 * budget) - step.smoothed);

  if (step.smoothed > budget && step.at < settings_.most) {
    // a step back that had to be undone: wait longer before the next
    if (now - step.back_at < 2 * settings_.calm_s)
      step.calm = std::min(2 * step.calm, settings_.calm_most_s);
    ++step.at;
    step.smoothed = std::min(step.smoothed, 0.8 * budget);  // no frame at the new step has been
                                                            // measured yet
    step.roomy_since = -1;
    return;
  }
  if (step.smoothed > kRoom * budget) {
    step.roomy_since = -1;
    return;
  }
  if (step.roomy_since < 0) step.roomy_since = now;
  if (step.at == 0 || now - step.roomy_since < step.calm) return;
  --step.at;
  step.back_at = now;
  step.roomy_since = -1;
}

const char* FrameGovernor::name(int step) {
  constexpr std::array<const char*, kSteps> kNames = {"everything", "no grain", "coarser",
                                                      "fewer samples", "fewest samples"};
  return kNames[static_cast<std::size_t>(std::clamp(step, 0, kSteps - 1))];
}

}  // namespace burr::render
