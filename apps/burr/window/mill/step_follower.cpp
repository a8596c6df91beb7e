#include "window/mill/step_follower.h"

#include <utility>

#include "burr/guidance/step_plan.h"

namespace burr::app {

StepFollower::StepFollower(const MillSite& site, MillCase& work_case, MillView& view,
                           MillTools& tools, MillHand& hand)
    : desk_(site.desk),
      scene_(site.scene),
      hands_(site.hands),
      options_(site.options),
      row_(site.row),
      case_(work_case),
      view_(view),
      tools_(tools),
      hand_(hand) {}

// Until it is known where the work lies, the hand presses as little as it can.
void StepFollower::begin() {
  if (!options_.lesson || options_.lesson->steps.empty()) return;
  hand_.propose_press(guidance::kLeastPress);
  ask();
}

void StepFollower::ask() {
  turns_ = case_.turns();
  waiting_.reset();
  const auto& steps = options_.lesson->steps;
  const scenario::Step& step = case_.step() != nullptr ? *case_.step() : steps.front();
  case_.seek_target(case_.follows() ? 0.5 * tools_.drill().burr_for(step).diameter
                                    : scene_.burr.radius);
}

void StepFollower::look() {
  if (!options_.lesson || options_.lesson->steps.empty()) return;
  if (turns_ != case_.turns()) ask();
  if (auto seen = case_.look_at_target()) waiting_ = std::move(seen);
  if (!waiting_ || hand_.pressing() || row_.hand.pedal > 0) return;
  follow(*std::exchange(waiting_, {}));
}

void StepFollower::follow(const guidance::StepWatch::Seen& seen) {
  const bool follows = case_.follows() && case_.step() != nullptr;
  const std::pair now = {seen.step, follows};
  if (std::exchange(set_, now) != now) {  // what the user changes afterwards stays
    const double press = guidance::press_for(seen.target, 1e-3 * desk_.settings.press_mm);
    hand_.propose_press(press);
    if (follows) {
      case_.tell_press(press);
      tools_.suit(*case_.step());
    }
  }
  // a hand of its own place is led by what its user sees
  if (follows && seen.target.found && hands_.real == nullptr)
    view_.face(seen.target.at, seen.target.towards, seen.target.radius);
}

}  // namespace burr::app
