// Whoever wears a headset at the page: both eyes' pictures, and a wand as the hand.
#include <fmt/core.h>

#include <cstdio>
#include <utility>

#include "window/mill/mill.h"
#include "window/shell/words.h"

namespace burr::app {

// One is put on when it is requested for, once; what is wrong with it is said, and the window goes on.
void Mill::look_for_headset() {
  if (desk_.headset != nullptr && !desk_.headset_wanted) {
    take_off_headset();
    note(word(Word::headset_off));
  } else if (desk_.headset == nullptr && desk_.headset_wanted) {
    auto made = render::Headset::start(desk_.renderer(), desk_.settings.left_handed);
    if (made) {
      desk_.headset = std::move(*made);
      note(say(Word::headset_on, desk_.headset->name()));
    } else {
      desk_.headset_wanted = false;
      fmt::print(stderr, "{}\n", made.error().text);
      note(made.error().text);
    }
  } else if (desk_.headset != nullptr && desk_.headset->over()) {
    const std::string why = desk_.headset->why();
    desk_.headset_wanted = false;
    take_off_headset();
    fmt::print(stderr, "{}\n", why);
    note(why);
  }
}

void Mill::take_off_headset() {
  desk_.headset.reset();
  seen_.reset();
  wand_ = false;
  wand_at_ = {};
}

void Mill::begin_headset(render::FrameGovernor& governor) {
  look_for_headset();
  seen_.reset();
  const bool runs = desk_.headset != nullptr && desk_.headset->running();
  constexpr double kWait = 0.02;  // then the window is drawn without it  [s]
  if (desk_.headset != nullptr) seen_ = desk_.headset->begin(kWait);
  if (std::exchange(headset_on_, runs) != runs) {
    desk_.renderer().wait_for_screen(!runs);
    governor.allow_moving(render::GovernorSettings().moving_s);
    wand_ = wand_ && runs;  // the mouse's again
  }
  if (!seen_) return;
  if (seen_->period > 0) governor.allow_moving(seen_->period);
  for (std::size_t eye = 0; eye < 2; ++eye)
    headset_cameras_[eye] = render::placed(scene_.camera, seen_->room_from_eye[eye]);
  wand_at_ = seen_->wand;
  wand_ = wand_ || wand_at_.tracked;
}

void Mill::end_headset() {
  if (seen_ && desk_.headset != nullptr) desk_.headset->end(scene_, headset_cameras_);
}

// The wand is the hand: its end the burr's head, its back the handle. What is not known of it goes
// to the servo as it is.
void Mill::point_wand() {
  if (!seen_ || hands_.mouse == nullptr) return;
  MouseHand::Aim aim;
  aim.valid = wand_at_.tracked;
  aim.pace = MouseHand::kWandPace;
  aim.pedal = page_open() || measuring_.picks() ? 0 : wand_at_.trigger;
  if (aim.valid) aim.world_from_tool = render::placed(scene_.camera, wand_at_.room_from_wand);
  hands_.mouse->aim(aim);
}

}  // namespace burr::app
