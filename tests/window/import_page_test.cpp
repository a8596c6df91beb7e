// A user at the import page: what he chooses there is what a command line would have said.
#include "window/import_page.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "burr/record/player.h"
#include "recording.h"
#include "window/sessions.h"
#include "window/user.h"

namespace burr::app {
namespace {

using Part = ImportLayout::Part;

ImportLayout layout() { return import_layout(1280, 720, 1); }
void click_on(const Part& part) {
  click(static_cast<int>(part.x + part.w / 2), static_cast<int>(part.y + part.h / 2));
}

// The bone that the command line makes of the same words.
std::uint64_t hash_of(const VolumeOptions& options) {
  NoProgress quiet;
  auto made = open_volume(options, quiet);
  EXPECT_TRUE(made) << made.error().text;
  return made ? made->bone->content_hash() : 0;
}

class ImportWindow : public Window {
 protected:
  // What a session began with, as its recording tells.
  record::VolumeInfo begun() const {
    const std::vector<KeptSession> kept = kept_sessions(folder_ / "state");
    if (kept.empty()) return {};
    auto player = record::Player::open(kept.front().file.string());
    return player ? (*player)->info().volume : record::VolumeInfo{};
  }
  // mills a little, so that the session is kept, and leaves
  std::vector<Script::Step> then_mills() {
    return {{"milling", on(Page::milling),
             [this] {
               began_ = Clock::now();
               move_to(640, 360);
               press(SDLK_SPACE);
             }},
            {"a while", [this] { return Clock::now() - began_ > std::chrono::seconds(3); },
             [] { press(SDLK_q); }},
            {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}};
  }
  void by(std::vector<Script::Step> steps, std::vector<Script::Step> more) {
    steps.insert(steps.end(), more.begin(), more.end());
    pages_by(std::move(steps));
  }
  Clock::time_point began_;
};

TEST_F(ImportWindow, MakesTheBoneWithTheLevelAndRegionSetByMouse) {
  const fs::path file = scan();
  const ImportLayout at = layout();
  const int y = static_cast<int>(at.plot.y + at.plot.h / 2);
  const int x0 = static_cast<int>(at.plot.x + at.plot.w * 0.5F),
            x1 = static_cast<int>(at.plot.x + at.plot.w * 0.75F);
  const auto planes = planes_of(math::Mat3::Identity());
  ASSERT_EQ(planes[0].across, 0);
  // the axial view: 24 x 24 mm, 264 pixels in the middle of its part; its right side is pulled to
  // three quarters
  const Part& view = at.views[0];
  const float side = std::floor(std::min(view.w, view.h) - 40);
  const int left = static_cast<int>(view.x + (view.w - side) / 2),
            middle = static_cast<int>(view.y + view.h / 2) + 20;
  const int right = left + static_cast<int>(side);
  by({{"the start page", on(Page::start), [&] { drop(file); }},
      {"the import page", on(Page::import), nullptr},
      {"a picture", looks(3),
       [&] {
         move_to(x0, y);
         button(SDL_BUTTON_LEFT, true);
       }},
      {"the hold", looks(3), [&] { move_to(x1, y); }},
      {"the pull", looks(3), [] { button(SDL_BUTTON_LEFT, false); }},
      {"the level", looks(3),
       [&] {
         move_to(right, middle);
         button(SDL_BUTTON_LEFT, true);
       }},
      {"the hold", looks(3), [&] { move_to(left + static_cast<int>(side * 0.75F), middle); }},
      {"the pull", looks(3), [] { button(SDL_BUTTON_LEFT, false); }},
      {"the region", looks(3), [] { press(SDLK_RETURN); }}},
     then_mills());
  const record::VolumeInfo info = begun();
  ASSERT_TRUE(info.words.contains("iso") && info.words.contains("roi")) << "nothing was chosen";
  // -1000 to 1500 HU lie along the plot
  EXPECT_NEAR(std::stod(info.words.at("iso")), -1000 + 0.75 * 2500, 12);
  EXPECT_EQ(info.words.at("roi"), "0,17,0,23,0,23");
  VolumeOptions typed;
  typed.path = file.string();
  const std::uint64_t by_itself = hash_of(typed);
  typed.iso = info.words.at("iso");
  typed.roi = info.words.at("roi");
  EXPECT_EQ(info.content_hash, hash_of(typed));
  EXPECT_NE(info.content_hash, by_itself);
}

TEST_F(ImportWindow, OfADefaultScanChangesNothing) {
  const fs::path file = scan();
  by({{"the start page", on(Page::start), [&] { drop(file); }},
      {"the import page", on(Page::import), nullptr},
      {"a picture", looks(3), [] { click_on(layout().start); }}},
     then_mills());
  const record::VolumeInfo info = begun();
  EXPECT_FALSE(info.words.contains("iso") || info.words.contains("roi"));
  VolumeOptions typed;
  typed.path = file.string();
  EXPECT_EQ(info.content_hash, hash_of(typed));
}

TEST_F(ImportWindow, GoesBackWithoutComplaint) {
  pages_by({{"the start page", on(Page::start), [&] { drop(scan()); }},
            {"the import page", on(Page::import), [] { press(SDLK_ESCAPE); }},
            {"the start page again", on(Page::start), nullptr},
            {"a few pictures", looks(5), [] { press(SDLK_ESCAPE); }}});
  EXPECT_EQ(desk_->told, "");
}

}  // namespace
}  // namespace burr::app
