// A user at the window, page by page: keys, mouse and drops as SDL events, without a screen.
#include "window/shell/pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "burr/record/player.h"
#include "burr/render/pick.h"
#include "burr/rt/changed_bits.h"
#include "burr/sim/replay.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "support/test_places.h"
#include "window/mill/window.h"
#include "window/parts/kept_sessions.h"
#include "window/parts/see_through.h"
#include "window/user.h"

namespace burr::app {
namespace {

// ---- milling

TEST_F(Window, ChangesTheBurrByKeyAndTheServoHasIt) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  const double first = session.burr_radius();  // 3 mm: 6 mm wide
  double smaller = 0;
  mill_by(*ready, {{"the first picture", looks(3), [] { press(SDLK_LEFTBRACKET); }},
                   {"a smaller burr", [&] { return session.burr_radius() < first; },
                    [&] {
                      smaller = session.burr_radius();
                      press(SDLK_RIGHTBRACKET);
                    }},
                   {"the larger one again", [&] { return session.burr_radius() > smaller; },
                    [] { leave_work(); }}});
  EXPECT_NEAR(smaller, 2.75e-3, 1e-9);
  EXPECT_NEAR(session.servo().settings().burr.radius, first, 1e-9);
}

TEST_F(Window, TakesADiamondBurrByKeyAndBack) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  render::Image fluted;
  mill_by(*ready,
          {{"the first picture", looks(3), [] { move_to(640, 340); }},
           {"the burr over the bone", looks(40),
            [&] {
              fluted = desk_->renderer().shown();
              press(SDLK_k);
            }},
           {"told", [&] { return desk_->status_text.find("Diamond") != std::string::npos; }, {}},
           {"another burr is seen", looks(10), [&] {
              EXPECT_TRUE(ready->scene.burr.diamond);
              EXPECT_GT(differ(fluted, desk_->renderer().shown(), 120, 40, 1040, 600), 60);
              leave_work();
            }}});
  EXPECT_EQ(ready->session->servo().settings().burr.kind, tool::BurrKind::diamond);
}

TEST_F(Window, UndoByKeyBringsTheBoneBackToTheBit) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  const std::uint64_t before = session.bone().content_hash();
  rt::ChangedBits& changed = session.bone().add_watcher();
  int bricks = 0;
  const auto count = [&] {
    changed.take_all([&bricks](std::size_t) { ++bricks; });
    return bricks;
  };
  Clock::time_point lifted;
  int cut = 0;
  mill_by(
      *ready,
      {{"the first picture", looks(3),
        [&] {
          move_to(640, 340);
          button(SDL_BUTTON_LEFT, true);
        }},
       {"bone to be cut", pressing_until([&] { return count() > 30; }),
        [&] {
          button(SDL_BUTTON_LEFT, false);
          lifted = Clock::now();
        }},
       {"the end of the stroke", [&] { return Clock::now() - lifted > std::chrono::seconds(1); },
        [&] {
          cut = count();
          press(SDLK_u);
        }},
       {"the bone to come back", [&] { return count() > cut; }, [&] { lifted = Clock::now(); }},
       {"all of it", [&] { return Clock::now() - lifted > std::chrono::seconds(1); },
        [] { leave_work(); }}});
  EXPECT_GT(cut, 30) << "nothing was cut: the test shows nothing";
  EXPECT_EQ(session.bone().content_hash(), before);
  EXPECT_GT(session.outcome().peak_force, 0);
}

TEST_F(Window, TabHidesThePanelsAndShowsThemAgain) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  render::Image with, without, again;
  const auto picture = [&](render::Image& image) {
    return [&] {
      image = desk_->renderer().shown();
      press(SDLK_TAB);
    };
  };
  mill_by(*ready, {{"the first picture", looks(10), picture(with)},
                   {"no panels", looks(5), picture(without)},
                   {"panels", looks(5), [&] {
                      again = desk_->renderer().shown();
                      leave_work();
                    }}});
  ASSERT_EQ(with.width, 1280);
  ASSERT_EQ(with.height, 720);
  // strip below, tools at the left, slices at the right; not the middle
  EXPECT_GT(differ(with, without, 100, 650, 1180, 712), 10'000);
  EXPECT_GT(differ(with, without, 10, 60, 90, 560), 5000);
  EXPECT_GT(differ(with, without, 1080, 20, 1270, 600), 10'000);
  EXPECT_LT(differ(with, without, 700, 20, 940, 200), 50);
  EXPECT_GT(differ(without, again, 100, 650, 1180, 712), 10'000);
}

TEST_F(Window, ShowsWhatIsToBeDoneUntilTheKeyHidesIt) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  ASSERT_TRUE(ready->work_case.has_value());
  render::Image with, without, again;
  const auto picture = [&](render::Image& image) {
    return [&] {
      image = desk_->renderer().shown();
      press(SDLK_o);
    };
  };
  Script script({{"the first picture", looks(10), picture(with)},
                 {"no task", looks(5), picture(without)},
                 {"the task", looks(5),
                  [&] {
                    again = desk_->renderer().shown();
                    leave_work();
                  }}},
                desk_->status_text);
  desk_->after_frame = [&script] { script.look(); };
  WindowOptions options;
  options.work_case = ready->work_case;
  const auto left =
      mill(*desk_, *ready->session, ready->hands, *ready->worker, ready->scene, options);
  desk_->after_frame = {};
  ASSERT_TRUE(left) << left.error().text;
  EXPECT_TRUE(script.finished());
  EXPECT_GT(differ(with, without, 104, 10, 464, 60), 5000);
  EXPECT_LT(differ(with, without, 700, 20, 940, 200), 50);
  EXPECT_GT(differ(without, again, 104, 10, 464, 60), 5000);
}

TEST_F(Window, ShowsSlicesThroughTheTipThatCanBeHidden) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  render::Image with, nearer, without;
  mill_by(*ready, {{"the first picture", looks(20),
                    [&] {
                      with = desk_->renderer().shown();
                      press(SDLK_b);
                    }},
                   {"nearer slices", looks(20),
                    [&] {
                      nearer = desk_->renderer().shown();
                      press(SDLK_v);
                    }},
                   {"no slices", looks(5), [&] {
                      without = desk_->renderer().shown();
                      leave_work();
                    }}});
  EXPECT_GT(differ(with, without, 1080, 20, 1270, 600), 10'000);
  EXPECT_GT(differ(with, nearer, 1080, 20, 1270, 600), 100);
  EXPECT_LT(differ(nearer, without, 100, 650, 900, 712), 3000) << "the strip stays";
}

TEST_F(Window, MakesBoneSeeThroughInStepsAndWholeAgain) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  const render::Look& look = ready->scene.look;
  render::Image whole, through;
  std::vector<double> opacities;
  const auto step = [&](Uint16 held) {
    return [&, held] {
      opacities.push_back(look.opacity);
      if (opacities.size() == 1) whole = desk_->renderer().shown();
      if (opacities.size() == 4) through = desk_->renderer().shown();
      press(SDLK_t, held);
    };
  };
  const auto is = [&](double opacity) { return [&, opacity] { return look.opacity == opacity; }; };
  mill_by(*ready, {{"the first picture", looks(15), step(KMOD_NONE)},
                   {"40 %", is(0.6), step(KMOD_NONE)},
                   {"65 %", is(0.35), step(KMOD_NONE)},
                   {"85 %", is(0.15), step(KMOD_LSHIFT)},
                   {"65 % again", is(0.35), step(KMOD_NONE)},
                   {"85 % again", is(0.15), step(KMOD_NONE)},
                   {"whole", is(1), [] { leave_work(); }}});
  EXPECT_EQ(opacities, (std::vector<double>{1, 0.6, 0.35, 0.15, 0.35, 0.15}));
  render::Scene scene;
  EXPECT_EQ(step_see_through(scene, false), "Bone transparent: 40 %");
  EXPECT_EQ(step_see_through(scene, true), "Bone not transparent");
  // the block itself, in the middle of the picture
  EXPECT_GT(differ(whole, through, 400, 200, 900, 600), 50'000);
}

TEST_F(Window, LiftsTheBurrWhenTheMouseComesOverAPanel) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  tick::TickRow row;
  const auto pedal = [&](double wanted) {
    return [&, wanted] {
      static_cast<void>(session.view(row));
      return row.tick > 0 && row.hand.pedal == wanted;
    };
  };
  // so near that there is bone behind every panel
  bool bone_there = false;
  ready->scene.camera.elevation = 1.4;
  mill_by(*ready, {{"the first picture", looks(3),
                    [] {
                      turn_wheel(16);
                      move_to(640, 340);
                      press(SDLK_SPACE);
                    }},
                   {"the press of the space bar", pedal(1),
                    [&] {
                      bone_there =
                          render::pick(ready->scene, render::ray_through(ready->scene.camera, 50.5,
                                                                         300.5, 1280, 720))
                              .has_value();
                      move_to(50, 300);
                    }},
                   {"the lift over the tools", pedal(0), [] { move_to(640, 345); }},
                   {"the press again", pedal(1), [] { press(SDLK_SPACE); }},
                   {"the lift by the space bar", pedal(0), [] { leave_work(); }}});
  EXPECT_TRUE(bone_there) << "no bone behind the panel: the test shows nothing";
}

TEST_F(Window, OfTheLeftHandedMillsWithTheRightButton) {
  desk_->settings.left_handed = true;
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  tick::TickRow row;
  bool left_pressed = false;
  mill_by(*ready, {{"the first picture", looks(3),
                    [] {
                      move_to(640, 340);
                      button(SDL_BUTTON_LEFT, true);
                    }},
                   {"nothing", looks(20),
                    [&] {
                      static_cast<void>(session.view(row));
                      left_pressed = row.hand.pedal > 0;
                      button(SDL_BUTTON_LEFT, false);
                      button(SDL_BUTTON_RIGHT, true);
                    }},
                   {"the press",
                    [&] {
                      static_cast<void>(session.view(row));
                      return row.hand.pedal == 1;
                    },
                    [] { leave_work(); }}});
  EXPECT_FALSE(left_pressed);
}

TEST_F(Window, WritesChangedSettingsDownAndSpeaksTheLanguageAtOnce) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  // F2, then the list of languages in the first line, and in it the third: "Svenska"
  mill_by(*ready, {{"the first picture", looks(3), [] { press(SDLK_F2); }},
                   {"the page", looks(5), [] { click(1280 / 2 - 450 + 28 + 190 + 105, 158); }},
                   {"the list", looks(5), [] { click(1280 / 2 - 450 + 28 + 190 + 50, 233); }},
                   {"the change", [] { return spoken().code == "sv"; }, [] { press(SDLK_ESCAPE); }},
                   {"the page to go", looks(5), [] { leave_work(); }}});
  const SettingsRead read = read_settings(folder_ / "config" / "settings.toml");
  EXPECT_TRUE(read.troubles.empty());
  EXPECT_EQ(read.settings.language, "sv");
}

TEST_F(Window, ChangesWhatAGamepadAndAPedalDoOnTheOtherLeafOfTheSettings) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  // every slider near its right end: those of the left column, then those of the right one
  const Settings& now = desk_->settings;
  const auto none = [] {};
  mill_by(*ready, {{"the first picture", looks(3), [] { press(SDLK_F2); }},
                   {"the page", looks(5), [] { click(1280 / 2 + 200, 83); }},
                   {"its other leaf", looks(5), [] { click(520, 160); }},
                   {"the pace", [&] { return now.pad_pace > 2; }, none},
                   {"the next slider", looks(3), [] { click(520, 197); }},
                   {"the rest of a stick", [&] { return now.pad_dead > 0.5; }, none},
                   {"the next slider", looks(3), [] { click(970, 160); }},
                   {"the mill", [&] { return now.pedal_mill > 20; }, none},
                   {"the next slider", looks(3), [] { click(970, 197); }},
                   {"the burr", [&] { return now.pedal_burr > 20; }, none},
                   {"the next slider", looks(3), [] { click(970, 234); }},
                   {"the coolant", [&] { return now.pedal_coolant > 20; }, none},
                   {"the next slider", looks(3), [] { click(970, 271); }},
                   {"the tool", [&] { return now.pedal_tool > 20; }, none},
                   {"the next slider", looks(3), [] { click(970, 308); }},
                   {"the clutch", [&] { return now.pedal_clutch > 20; }, none},
                   {"the next slider", looks(3), [] { click(970, 345); }},
                   {"the axis", [&] { return now.pedal_rest > 0.9; }, [] { move_to(1200, 600); }},
                   {"the slider let go", looks(5), [] { press(SDLK_ESCAPE); }},
                   {"the page to go", looks(5), [] { leave_work(); }}});
  const SettingsRead read = read_settings(folder_ / "config" / "settings.toml");
  EXPECT_TRUE(read.troubles.empty());
  EXPECT_NEAR(read.settings.pad_pace, now.pad_pace, 1e-6);
  EXPECT_NEAR(read.settings.pad_dead, now.pad_dead, 1e-6);
  EXPECT_EQ(read.settings.pedal_mill, now.pedal_mill);
  EXPECT_EQ(read.settings.pedal_burr, now.pedal_burr);
  EXPECT_EQ(read.settings.pedal_coolant, now.pedal_coolant);
  EXPECT_EQ(read.settings.pedal_tool, now.pedal_tool);
  EXPECT_EQ(read.settings.pedal_rest, now.pedal_rest);
}

// ---- page to page

TEST_F(Window, TakesADroppedScanMillsItComesBackAndGoesOnWhereItWas) {
  const fs::path file = scan();
  Clock::time_point began;
  const auto a_while = [&] { return Clock::now() - began > std::chrono::seconds(3); };
  const auto mills = [&] {
    began = Clock::now();
    move_to(640, 360);
    press(SDLK_SPACE);
  };
  pages_by({{"the start page", on(Page::start), [&] { drop(file); }},
            {"its import page", on(Page::import), [] { press(SDLK_RETURN); }},
            {"milling", on(Page::milling), mills},
            {"a while", a_while, [] { leave_work(); }},
            {"the start page again", on(Page::start), nullptr},
            {"its first pictures", looks(5), [] { click(938, 354); }},  // the first session
            {"milling again", on(Page::milling), mills},
            {"a while", a_while, [] { press(SDLK_s); }},
            {"the word about it", looks(5), [] { leave_work(); }},
            {"the start page at last", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  EXPECT_EQ(desk_->message, "");
  const std::vector<KeptSession> kept = kept_sessions(folder_ / "state");
  ASSERT_EQ(kept.size(), 1U) << "one session, one row";
  EXPECT_TRUE(kept[0].clean);
  EXPECT_TRUE(kept[0].keep);
  EXPECT_GT(kept[0].removed_mm3, 0) << "nothing was cut: the test shows nothing";
  EXPECT_TRUE(fs::exists(picture_of(kept[0].file)));
  EXPECT_EQ(kept[0].title.find("Svensson"), std::string::npos) << kept[0].title;
  EXPECT_EQ(kept[0].file.string().find("Svensson"), std::string::npos);
  ASSERT_EQ(recent(folder_ / "state").size(), 1U);
  EXPECT_EQ(recent(folder_ / "state")[0].title.find("Svensson"), std::string::npos);

  // the second part began with the bone that the first ended with
  NoProgress quiet;
  auto player = record::Player::open(kept[0].file.string());
  ASSERT_TRUE(player) << player.error().text;
  ASSERT_EQ((*player)->continued().size(), 1U);
  const record::SessionInfo& second = (*player)->continued()[0];
  scenario::BoneRecipe given;
  given.source = file.string();
  auto bone = workshop::bone_of(**player, given, quiet);
  ASSERT_TRUE(bone) << bone.error().text;
  const std::uint64_t uncut = (*bone)->content_hash();
  EXPECT_EQ(uncut, (*player)->info().volume.content_hash);
  const double rate = (*player)->info().rate_hz;
  ASSERT_TRUE((*player)->bone_at(static_cast<double>(second.first_tick - 1) / rate, **bone));
  EXPECT_NE((*bone)->content_hash(), uncut);
  EXPECT_EQ((*bone)->content_hash(), second.volume.content_hash);
  auto fresh = workshop::bone_of(**player, given, quiet);
  ASSERT_TRUE(fresh);
  const auto again = sim::replay(**player, std::move(*fresh), quiet);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_FALSE(again->first_different_tick) << again->difference;
  EXPECT_EQ(again->gaps, 0U) << again->difference;
}

TEST_F(Window, TellsWhatIsWrongWithABrokenFileAndGoesOn) {
  const fs::path broken = folder_ / "broken.nrrd";
  std::ofstream(broken) << "NRRD0004\ntype: short\ndimension: 3\nsizes: 9 9\n\n";
  std::string told;
  // typed, this one: a click into the field, the path, Enter
  pages_by({{"the start page", on(Page::start), [] { click(950, 238); }},
            {"the field", looks(4), [&] { type(broken.string()); }},
            {"the letters", looks(4), [] { press(SDLK_RETURN); }},
            {"loading", on(Page::loading), nullptr},
            {"the sentence", [&] { return desk_->page == Page::start && !desk_->message.empty(); },
             [&] {
               told = desk_->message;
               drop(scan());
             }},
            {"its import page", on(Page::import), [] { press(SDLK_RETURN); }},
            {"milling all the same", on(Page::milling), [] { leave_work(); }},
            {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  EXPECT_NE(told.find("broken.nrrd"), std::string::npos) << told;
  EXPECT_EQ(desk_->message, "") << "an old sentence stayed";
}

TEST_F(Window, TellsWhatIsWrongWithAFileOfTheCorpusAndGoesOn) {
  BURR_NEEDS_DATA("corpus");
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(test::data_dir() / "corpus"))
    if (entry.is_regular_file() &&
        entry.path().filename().string().find("trunc") != std::string::npos)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty()) << "the corpus has no truncated file";
  pages_by({{"the start page", on(Page::start), [&] { drop(files.front()); }},
            {"loading", on(Page::loading), nullptr},
            {"the sentence", [&] { return desk_->page == Page::start && !desk_->message.empty(); },
             [] { press(SDLK_ESCAPE); }}});
  EXPECT_FALSE(desk_->message.empty());
}

TEST_F(Window, CancelsLoadingAndIsBackAtTheStartWithoutComplaint) {
  const fs::path work = fs::path(test::source_dir()) / "cases" / "temporal_bone.toml";
  pages_by({{"the start page", on(Page::start), [&] { drop(work); }},
            {"loading", on(Page::loading), [] { press(SDLK_ESCAPE); }},
            {"the start page again", on(Page::start), nullptr},
            {"a few pictures", looks(5), [] { press(SDLK_ESCAPE); }}});
  EXPECT_EQ(desk_->message, "");
  EXPECT_TRUE(kept_sessions(folder_ / "state").empty());
}

TEST_F(Window, OffersASessionThatEndedUnexpectedlyFirst) {
  pages_by({{"the start page", on(Page::start), [&] { drop(scan()); }},
            {"its import page", on(Page::import), [] { press(SDLK_RETURN); }},
            {"milling", on(Page::milling),
             [] {
               move_to(640, 360);
               press(SDLK_SPACE);
             }},
            {"some pictures", looks(90), [] { leave_work(); }},
            {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  std::vector<KeptSession> kept = kept_sessions(folder_ / "state");
  ASSERT_EQ(kept.size(), 1U) << "nothing was cut: the test shows nothing";
  // as a crash leaves it: the account still open, the recording torn
  fs::path account = kept[0].file;
  account.replace_extension(".json");
  std::string text;
  {
    std::ifstream in(account);
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  const std::size_t at = text.find("\"clean\": true");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 13, "\"clean\": false");
  std::ofstream(account) << text;
  fs::resize_file(kept[0].file, fs::file_size(kept[0].file) * 3 / 4);

  kept = kept_sessions(folder_ / "state");
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_FALSE(kept[0].clean);
  NoProgress quiet;
  const auto ready = continue_session(kept[0], quiet);
  ASSERT_TRUE(ready) << ready.error().text;
}

}  // namespace
}  // namespace burr::app
