// Everything that a key does, the mouse can do: by a button of the bar, by an item of the menu, by a
// gesture or a button elsewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "user.h"
#include "window/mill/mill_keys.h"
#include "window/mill/side_panel.h"
#include "window/parts/toolbar.h"

namespace burr::app {
namespace {

TEST(Reach, NoKeyIsWithoutTheMouse) {
  const std::vector<Action> bar = toolbar_actions();
  ASSERT_GT(key_reaches().size(), 60U);
  for (const KeyReach& one : key_reaches()) {
    const int ways =
        (one.button ? 1 : 0) + (one.item.empty() ? 0 : 1) + (one.other.empty() ? 0 : 1);
    EXPECT_EQ(ways, 1) << one.key;
    EXPECT_TRUE(!one.button || std::count(bar.begin(), bar.end(), *one.button) == 1) << one.key;
  }
}

// A button without a key would be one that nobody can learn by heart; only views is a mere menu.
TEST(Reach, EachButtonIsThereOnceAndHasAKey) {
  const std::vector<Action> bar = toolbar_actions();
  EXPECT_EQ(std::set<Action>(bar.begin(), bar.end()).size(), bar.size());
  const std::vector<KeyReach> keys = key_reaches();
  for (const Action action : bar) {
    const bool has = std::any_of(keys.begin(), keys.end(),
                                 [&](const KeyReach& one) { return one.button == action; });
    EXPECT_EQ(has, action != Action::views) << static_cast<int>(action);
  }
}

// No two of one menu are called the same.
TEST(Reach, ItemsOfTheMenuDifferInEveryLanguage) {
  for (const Language& language : languages()) {
    speak(language.code);
    std::set<std::string> names;
    std::string last;
    for (const KeyReach& one : key_reaches()) {
      if (one.item.empty() || one.item == last) continue;  // twins follow one another
      last = one.item;
      EXPECT_TRUE(names.insert(one.item).second) << language.code << " " << one.item;
    }
  }
  speak("en");
}

class ReachWindow : public Window {};

// The buttons of suction, sound and the menu, at 1280 x 720; and an item of the menu.
TEST_F(ReachWindow, TheMouseOpensTheMenuAndTakesAnItem) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  const auto item = [](std::size_t n) {
    click(static_cast<int>(kSideLeft + 100),
          static_cast<int>(kSideTop + 57 + 27 * static_cast<float>(n)));
  };
  double before = 0;
  mill_by(*ready,
          {{"a picture", looks(5),
            [&] {
              before = ready->scene.camera.distance;
              press(SDLK_F1);
            }},
           // the help goes, and the menu is there
           {"the help", looks(3), [] { press(SDLK_F10); }},
           // the fourth: the hand in a plane
           {"the menu", looks(3), [&] { item(3); }},
           {"told", [this] { return desk_->status_text.find("plane") != std::string::npos; },
            [] { press(SDLK_ESCAPE); }},
           {"the menu is closed, not the page", looks(3), [] { press(SDLK_6); }},
           {"told",
            [this] { return desk_->status_text.find(word(Word::suction_on)) != std::string::npos; },
            [] { leave_work(); }}});
  EXPECT_EQ(ready->scene.camera.distance, before);
}

class NamesWindow : public Window {};

// Z over the bone pins its name; over the sky it says that there is nothing.
TEST_F(NamesWindow, ANameIsPinnedUnderThePointerAndTheListOpens) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  render::Image bare, pinned, list;
  mill_by(
      *ready,
      {{"a picture", looks(5), [] { move_to(640, 340); }},
       {"a name", looks(12), [&] { bare = desk_->renderer().shown(); }},
       {"pin", looks(1), [] { press(SDLK_z); }},
       {"pinned", looks(4), [&] { pinned = desk_->renderer().shown(); }},
       {"list", looks(1), [] { press(SDLK_F4); }},
       {"the list", looks(4),
        [&] {
          list = desk_->renderer().shown();
          move_to(1040, 30);
        }},
       {"nothing there", looks(12), [] { press(SDLK_z); }},
       {"told",
        [this] { return desk_->status_text.find(word(Word::names_nothing)) != std::string::npos; },
        [] { leave_work(); }}});
  // a plate at the left or at the right edge of the picture
  EXPECT_GT(differ(bare, pinned, 100, 10, 260, 600) + differ(bare, pinned, 900, 10, 1060, 600),
            300);
  EXPECT_GT(differ(pinned, list, 110, 60, 460, 200), 2000);
}

}  // namespace
}  // namespace burr::app
