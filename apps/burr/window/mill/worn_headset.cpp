#include "window/mill/worn_headset.h"

#include <fmt/core.h>

#include <chrono>
#include <cstdio>
#include <utility>

#include "shared/front_words.h"
#include "shared/word_names.h"

namespace burr::app {

// It is started once when it is requested; if that fails, the window goes on without it.
std::string WornHeadset::look_for_it() {
  if (desk_.headset != nullptr && !desk_.headset_wanted) {
    take_off();
    return word(Word::headset_off);
  }
  if (desk_.headset == nullptr && desk_.headset_wanted) {
    auto made = render::Headset::start(desk_.renderer(), desk_.settings.left_handed);
    if (made) {
      desk_.headset = std::move(*made);
      const std::string missing = desk_.headset->take_missing();
      if (!missing.empty()) fmt::print(stderr, "{}\n", missing);
      return say(Word::headset_on, desk_.headset->name()) + (missing.empty() ? "" : ". " + missing);
    }
    desk_.headset_wanted = false;
    fmt::print(stderr, "{}\n", in_options(made.error()).text);
    return in_options(made.error()).text;
  }
  if (desk_.headset != nullptr && desk_.headset->over()) {
    std::string why = desk_.headset->why();
    desk_.headset_wanted = false;
    take_off();
    fmt::print(stderr, "{}\n", why);
    return why;
  }
  return {};
}

void WornHeadset::take_off() {
  desk_.headset.reset();
  seen_.reset();
  wand_ = false;
  wand_at_ = {};
}

std::string WornHeadset::begin(render::FrameGovernor& governor, const render::Camera& camera) {
  std::string line = look_for_it();
  seen_.reset();
  const bool runs = desk_.headset != nullptr && desk_.headset->running();
  constexpr double kWait = 0.02;  // longest wait; then the window is drawn alone  [s]
  if (desk_.headset != nullptr) seen_ = desk_.headset->begin(kWait);
  if (std::exchange(on_, runs) != runs) {
    desk_.renderer().wait_for_screen(!runs);
    governor.allow_moving(render::GovernorSettings().moving_s);
    wand_ = wand_ && runs;  // without a headset, the mouse is the hand
  }
  if (!seen_) return line;
  if (seen_->period > 0) governor.allow_moving(seen_->period);
  for (std::size_t eye = 0; eye < 2; ++eye)
    cameras_[eye] = render::placed(camera, seen_->room_from_eye[eye]);
  wand_at_ = seen_->wand;
  wand_ = wand_ || wand_at_.tracked;
  if (line.empty()) line = desk_.headset->take_missing();
  return line;
}

void WornHeadset::end(const render::Scene& scene) {
  if (seen_ && desk_.headset != nullptr) desk_.headset->end(scene, cameras_);
}

// A burr that cuts takes some bone in most ticks, not in all: a gap of less than kQuiet is none.
void WornHeadset::feel(const tick::TickRow& row, bool rests) {
  constexpr auto kQuiet = std::chrono::milliseconds(50);
  const auto now = std::chrono::steady_clock::now();
  const double more = row.ledger.removed - std::exchange(removed_, row.ledger.removed);
  if (more > 0) cut_at_ = now;
  if (desk_.headset == nullptr) return;
  const bool cuts = cut_at_ && now - *cut_at_ < kQuiet;
  const bool felt = wand_ && wand_at_.tracked && cuts && !rests;
  desk_.headset->vibrate(felt ? render::vibration_of(row.contact.force.norm()) : 0);
}

std::optional<mouse::MouseHand::Aim> WornHeadset::aim(const render::Camera& camera,
                                                      bool rests) const {
  if (!seen_) return std::nullopt;
  mouse::MouseHand::Aim aim;
  aim.valid = wand_at_.tracked;
  aim.pace = mouse::MouseHand::kWandPace;
  aim.pedal = rests ? 0 : wand_at_.trigger;
  if (aim.valid) aim.world_from_tool = render::placed(camera, wand_at_.room_from_wand);
  return aim;
}

}  // namespace burr::app
