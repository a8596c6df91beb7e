// A user at the import page: what he chooses there is what a command line would have said.
#include "window/import/import_page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "burr/record/player.h"
#include "burr/surface/enclosed.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "io/dicom_writer.h"
#include "window/import/series_page.h"
#include "window/parts/kept_sessions.h"
#include "window/shell/pages.h"
#include "window/user.h"

namespace burr::app {
namespace {

using Part = ImportLayout::Part;

ImportLayout layout() { return import_layout(1280, 720, 1); }
void click_on(const Part& part) {
  click(static_cast<int>(part.x + part.w / 2), static_cast<int>(part.y + part.h / 2));
}

constexpr float kLabelButtons = 3 * 53 + 64;  // from the first button of a label to the right end

// The bone that the command line makes of the same words.
std::uint64_t hash_of(const scenario::BoneRecipe& options) {
  NoProgress quiet;
  auto made = workshop::open_bone(options, quiet);
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
             [] { press(SDLK_s); }},  // kept, cut or not
            {"the word about it", looks(5), [] { leave_work(); }},
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
  const float side = std::floor(std::min(view.w, view.h) - 48);
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
  ASSERT_TRUE(info.recipe.iso && info.recipe.region) << "nothing was chosen";
  // -1000 to 1500 HU lie along the plot
  EXPECT_NEAR(*info.recipe.iso, -1000 + 0.75 * 2500, 12);
  EXPECT_TRUE((*info.recipe.region == scenario::Region{{0, 17}, {0, 23}, {0, 23}}));
  scenario::BoneRecipe typed;
  typed.source = file.string();
  const std::uint64_t by_itself = hash_of(typed);
  typed.iso = info.recipe.iso;
  typed.region = info.recipe.region;
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
  EXPECT_FALSE(info.recipe.iso || info.recipe.region);
  scenario::BoneRecipe typed;
  typed.source = file.string();
  EXPECT_EQ(info.content_hash, hash_of(typed));
}

TEST_F(ImportWindow, DoesNotReadTheScanTwice) {
  const fs::path file = scan();
  pages_by({{"the start page", on(Page::start), [&] { drop(file); }},
            {"the import page", on(Page::import),
             [&] {
               fs::remove(file);  // a stick that was pulled out
               press(SDLK_RETURN);
             }},
            {"milling", on(Page::milling), [] { leave_work(); }},
            {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  EXPECT_EQ(desk_->message, "");
}

TEST_F(ImportWindow, GoesBackWithoutComplaint) {
  pages_by({{"the start page", on(Page::start), [&] { drop(scan()); }},
            {"the import page", on(Page::import), [] { press(SDLK_ESCAPE); }},
            {"the start page again", on(Page::start), nullptr},
            {"a few pictures", looks(5), [] { press(SDLK_ESCAPE); }}});
  EXPECT_EQ(desk_->message, "");
}

// ---- labels, series, trouble

// 16 x 16 x 16 voxels of 1 mm: left half 1, right half 2, without names; what burr takes for solid
fs::path halves(const fs::path& folder) {
  const fs::path path = folder / "halves.nrrd";
  std::ofstream file(path, std::ios::binary);
  file << "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\n"
          "sizes: 16 16 16\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
          "space origin: (0,0,0)\nencoding: raw\n\n";
  for (int k = 0; k < 16; ++k)
    for (int j = 0; j < 16; ++j)
      for (int i = 0; i < 16; ++i) {
        const bool in = i >= 2 && i < 14 && j >= 2 && j < 14 && k >= 2 && k < 14;
        file.put(in ? (i < 8 ? '\1' : '\2') : '\0');
      }
  return path;
}

TEST_F(ImportWindow, MakesLabelsWhatTheyAreClickedToBe) {
  const fs::path file = halves(folder_);
  const ImportLayout at = layout();
  // the row of label 2, the second of its three buttons: soft
  const int x = static_cast<int>(at.plot.x + at.plot.w - kLabelButtons + 53 + 25),
            y = static_cast<int>(at.level.y + 34 + 32 + 15);
  by({{"the start page", on(Page::start), [&] { drop(file); }},
      {"the import page", on(Page::import), nullptr},
      {"a picture", looks(3), [&] { click(x, y); }},
      {"the choice", looks(5), [] { press(SDLK_RETURN); }}},
     then_mills());
  const std::vector<KeptSession> kept = kept_sessions(folder_ / "state");
  ASSERT_EQ(kept.size(), 1U) << "nothing was cut: the test shows nothing";
  const record::VolumeInfo info = begun();
  scenario::BoneRecipe typed;
  typed.source = file.string();
  const std::uint64_t by_itself = hash_of(typed);
  const fs::path table = folder_ / "typed.toml";
  std::ofstream(table) << "[[label]]\nvalue = 2\nkind = \"soft\"\n";
  typed.labels = table.string();
  EXPECT_EQ(info.content_hash, hash_of(typed));
  EXPECT_NE(info.content_hash, by_itself);
  // and it goes on from there, with the table that the window wrote
  NoProgress quiet;
  const auto ready = continue_session(kept.front(), quiet);
  EXPECT_TRUE(ready) << ready.error().text;
}

TEST_F(ImportWindow, LeavesNoTableBehindWhenOneGoesBack) {
  const fs::path file = halves(folder_);
  const ImportLayout at = layout();
  const int x = static_cast<int>(at.plot.x + at.plot.w - kLabelButtons + 53 + 25),
            y = static_cast<int>(at.level.y + 34 + 32 + 15);
  bool written = false;
  const auto tables = [&] {
    std::error_code none;
    return std::distance(fs::directory_iterator(folder_ / "state" / "labels", none), {});
  };
  pages_by({{"the start page", on(Page::start), [&] { drop(file); }},
            {"the import page", on(Page::import), nullptr},
            {"a picture", looks(3), [&] { click(x, y); }},
            {"the choice", looks(5),
             [&] {
               written = tables() == 1;
               press(SDLK_ESCAPE);
             }},
            {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  EXPECT_TRUE(written) << "nothing was chosen: the test shows nothing";
  EXPECT_EQ(tables(), 0);
}

// ---- what burr assumed, line by line

class ImportDoubts : public ImportWindow {
 protected:
  // A ball, a cube and a single voxel, 0.4 mm each way; or the ball alone.
  [[nodiscard]] fs::path parts(bool all) const {
    const fs::path path = folder_ / "parts.nrrd";
    std::ofstream file(path, std::ios::binary);
    file << "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\n"
            "sizes: 24 24 24\nspace directions: (0.4,0,0) (0,0.4,0) (0,0,0.4)\n"
            "space origin: (5,6,7)\nendian: little\nencoding: raw\n\n";
    for (int k = 0; k < 24; ++k)
      for (int j = 0; j < 24; ++j)
        for (int i = 0; i < 24; ++i) {
          const double r = std::hypot(i - 8, j - 12, k - 12);
          const bool cube = std::abs(i - 18) < 3 && std::abs(j - 12) < 3 && std::abs(k - 12) < 3,
                     speck = i == 3 && j == 3 && k == 3;
          const auto hu = static_cast<std::int16_t>(
              all && (cube || speck) ? 1000 : std::clamp(300 + 700 * (6 - r), -1000.0, 1500.0));
          const char bytes[2] = {static_cast<char>(hu & 0xFF), static_cast<char>((hu >> 8) & 0xFF)};
          file.write(bytes, 2);
        }
    return path;
  }
  // The recipe after somebody at the page did this, and pressed Enter or Esc.
  scenario::BoneRecipe after(const fs::path& file, std::vector<Script::Step> steps) {
    NoProgress quiet;
    scenario::BoneRecipe recipe;
    recipe.source = file.string();
    auto opened = open_scan(recipe, quiet);
    EXPECT_TRUE(opened) << opened.error().text;
    if (!opened) return {};
    ImportPage page(*desk_, std::move(*opened));
    Script script(std::move(steps), desk_->status_text);
    desk_->after_frame = [&script] { script.look(); };
    const auto answer = page.ask("", 0);
    desk_->after_frame = {};
    EXPECT_TRUE(answer) << answer.error().text;
    EXPECT_TRUE(script.finished());
    return page.volume();
  }
  // Presses the n-th button from the right of a line; texts: of the buttons, from the right.
  void press_button(std::size_t line, std::size_t lines, const std::vector<std::string>& texts) {
    const Part p = import_layout(1280, 720, 1, lines).doubts[line];
    float x = p.x + p.w - 4;
    for (std::size_t n = 0; n < texts.size(); ++n) {
      const float wide = desk_->ui().width_of(Ui::Letter::body, texts[n]) + 24;
      if (n + 1 == texts.size())
        click(static_cast<int>(x - wide / 2), static_cast<int>(p.y + p.h / 2));
      x -= wide + 8;
    }
  }
  // how many pixels have the ground of a line that warns
  int warned() {
    const render::Image image = desk_->renderer().shown();
    int count = 0;
    for (std::size_t n = 0; n + 2 < image.rgb.size(); n += 3)
      count += std::abs(image.rgb[n] - 50) < 3 && std::abs(image.rgb[n + 1] - 38) < 3 &&
                       std::abs(image.rgb[n + 2] - 22) < 3
                   ? 1
                   : 0;
    return count;
  }
};

TEST_F(ImportDoubts, OfAScanThatIsRightThereAreNone) {
  int seen = -1;
  const scenario::BoneRecipe recipe = after(parts(false), {{"a count", looks(30), [&] {
                                                              seen = warned();
                                                              press(SDLK_RETURN);
                                                            }}});
  EXPECT_LT(seen, 50);
  EXPECT_TRUE(recipe.keep.all());
}

TEST_F(ImportDoubts, OfSeveralPartsTheButtonsAreTheOptions) {
  const fs::path file = parts(true);
  const std::string pick = word(Word::import_pick), drop = say(Word::import_crumbs, 1.0),
                    largest = word(Word::import_keep_largest),
                    keep_all = word(Word::import_keep_all);
  int before = -1, decided = -1;
  scenario::BoneRecipe recipe = after(file, {{"a count", looks(30),
                                              [&] {
                                                before = warned();
                                                press_button(0, 1, {pick, drop, largest});
                                              }},
                                             {"the choice", looks(5), [&] {
                                                decided = warned();
                                                press(SDLK_RETURN);
                                              }}});
  EXPECT_GT(before, 10'000);
  EXPECT_LT(decided, 50) << "what is decided is no doubt";
  EXPECT_EQ(recipe.keep.largest, 1);
  scenario::BoneRecipe typed;
  typed.source = file.string();
  const std::uint64_t by_itself = hash_of(typed);
  typed.keep.largest = 1;
  EXPECT_EQ(hash_of(recipe), hash_of(typed));
  EXPECT_NE(hash_of(typed), by_itself);

  recipe = after(file, {{"a count", looks(30),
                         [&] {
                           press_button(0, 1, {pick, drop});
                         }},
                        {"the choice", looks(5), [] { press(SDLK_RETURN); }}});
  EXPECT_TRUE(recipe.keep.all());
  // 1 % of the ball: more than the speck has, less than the cube
  EXPECT_GT(recipe.drop_islands_mm3, 0.064);
  EXPECT_LT(recipe.drop_islands_mm3, 8);

  recipe = after(file, {{"a count", looks(30),
                         [&] {
                           press_button(0, 1, {pick, drop});
                         }},
                        {"the choice", looks(5), [&] { press_button(0, 1, {keep_all}); }},
                        {"taken back", looks(5), [] { press(SDLK_RETURN); }}});
  EXPECT_TRUE(recipe.keep.all());
  EXPECT_EQ(recipe.drop_islands_mm3, 0);
}

// A click into the axial view keeps the part there; beside bone it says so and changes nothing.
TEST_F(ImportDoubts, AClickKeepsThePartThatItHits) {
  const Part view = import_layout(1280, 720, 1, 1).views[0];
  const float side = std::floor(std::min(view.w, view.h) - 48);
  const auto click_voxel = [&](double i, double j) {
    click(static_cast<int>(view.x + (view.w - side) / 2 + side * (i + 0.5) / 24),
          static_cast<int>(view.y + (view.h - side) / 2 + side * (j + 0.5) / 24));
  };
  std::string told;
  const std::string pick = word(Word::import_pick);
  const scenario::BoneRecipe recipe =
      after(parts(true), {{"a count", looks(30), [&] { press_button(0, 1, {pick}); }},
                          {"picking", looks(5), [&] { click_voxel(12, 1.2); }},
                          {"no bone there", looks(5),
                           [&] {
                             told = desk_->message;
                             click_voxel(18, 12);  // the cube
                           }},
                          {"the choice", looks(5), [] { press(SDLK_RETURN); }}});
  EXPECT_EQ(told, word(Word::import_no_bone_here));
  ASSERT_EQ(recipe.keep.at_mm.size(), 1U);
  NoProgress quiet;
  const auto made = workshop::open_bone(recipe, quiet);
  ASSERT_TRUE(made) << made.error().text;
  ASSERT_TRUE(made->summary.parts);
  EXPECT_EQ(made->summary.parts->count, 3U);
  EXPECT_EQ(made->summary.parts->removed, 2U);
  const double left = 1e9 * surface::enclosed_volume(*made->bone);
  EXPECT_NEAR(made->summary.parts->removed_mm3 + left, made->summary.parts->mm3, 0.005 * left);
}

TEST_F(ImportDoubts, OfLabelsWithoutNamesAreAskedUntilTheyAreAnswered) {
  const fs::path file = halves(folder_);
  int before = -1, decided = -1;
  const ImportLayout at = layout();
  const auto step = [&](int& seen, std::function<void()> then) {
    return [&seen, this, then = std::move(then)] {
      seen = warned();
      then();
    };
  };
  scenario::BoneRecipe recipe =
      after(file, {{"a count", looks(30),
                    step(before, [&] { press_button(0, 1, {word(Word::import_labels_right)}); })},
                   {"the choice", looks(5), step(decided, [] { press(SDLK_RETURN); })}});
  EXPECT_GT(before, 10'000);
  EXPECT_LT(decided, 50);
  EXPECT_EQ(recipe.labels, "");
  // the last button of the first label: it must not be cut
  const int x = static_cast<int>(at.plot.x + at.plot.w - 32), y = static_cast<int>(at.level.y + 50);
  recipe = after(file, {{"a picture", looks(30), [&] { click(x, y); }},
                        {"the choice", looks(5), [] { press(SDLK_RETURN); }}});
  NoProgress quiet;
  const auto made = workshop::open_bone(recipe, quiet);
  ASSERT_TRUE(made) << made.error().text;
  ASSERT_EQ(made->summary.tissues.size(), 2U);
  EXPECT_TRUE(made->summary.tissues[0].tissue.spare);
  EXPECT_FALSE(made->summary.tissues[1].tissue.spare);
}

TEST_F(ImportWindow, SaysWhatIsWrongWithANumberAndLosesNothing) {
  const fs::path file = scan();
  const ImportLayout at = layout();
  std::vector<std::string> told;
  const auto typed = [&](const Part& part, std::string text) {
    return std::vector<Script::Step>{
        {"a picture", looks(3), [part] { click_on(part); }},
        {"an empty field",
         [looked = 0]() mutable {
           // letter by letter, a few pictures for each
           if (++looked % 3 == 0) press(SDLK_BACKSPACE);
           return looked > 3 * 16;
         },
         [text] { type(text); }},
        {"the letters", looks(static_cast<int>(text.size()) + 10), [] { press(SDLK_RETURN); }},
        {"what it says", looks(15), [&] { told.push_back(desk_->message); }}};
  };
  std::vector<Script::Step> steps = {{"the start page", on(Page::start), [&] { drop(file); }},
                                     {"the import page", on(Page::import), nullptr}};
  const auto add = [&steps](std::vector<Script::Step> more) {
    steps.insert(steps.end(), more.begin(), more.end());
  };
  add(typed(at.roi, "0,23,0,23,4,23"));  // good
  add(typed(at.roi, "5,4,0,23,0,23"));   // empty
  add(typed(at.voxel, "fine"));          // no number
  add(typed(at.iso, "high"));            // no number
  add(typed(at.iso, "5000"));            // no voxel is that dense
  steps.push_back({"refused", looks(3), [] { press(SDLK_RETURN); }});
  steps.push_back({"still here", looks(10),
                   [&] { EXPECT_EQ(desk_->page, Page::import) << "started without bone"; }});
  add(typed(at.iso, "200"));
  steps.push_back({"good again", looks(3), [] { press(SDLK_RETURN); }});
  by(steps, then_mills());
  ASSERT_EQ(told.size(), 6U);
  EXPECT_EQ(told[0], "");
  EXPECT_NE(told[1].find("5..4"), std::string::npos) << told[1];
  EXPECT_NE(told[2].find("fine"), std::string::npos) << told[2];
  EXPECT_NE(told[3].find("high"), std::string::npos) << told[3];
  EXPECT_NE(told[4].find("5000"), std::string::npos) << told[4];
  EXPECT_EQ(told[5], "");
  const record::VolumeInfo info = begun();
  ASSERT_TRUE(info.recipe.region && info.recipe.iso);
  EXPECT_TRUE((*info.recipe.region == scenario::Region{{0, 23}, {0, 23}, {4, 23}}));
  EXPECT_EQ(*info.recipe.iso, 200);
}

// Ctrl + A within one picture, one number for cubes; the region stays that of the voxels.
TEST_F(ImportWindow, ReadsTheScanAgainWithTheVoxelSizeThatIsTyped) {
  const fs::path file = scan();
  const Part& facts = layout().facts;
  const Part field = {facts.x + 110, facts.y + 54, 40, 28};
  by({{"the start page", on(Page::start), [&] { drop(file); }},
      {"the import page", on(Page::import), nullptr},
      {"a picture", looks(5), [field] { click_on(field); }},
      {"the field", looks(5), [] { press(SDLK_a, KMOD_CTRL); }},
      {"all of it", looks(3), [] { type("0.4"); }},
      {"typed", looks(5), [] { press(SDLK_RETURN); }},
      {"read again", looks(90), [] { press(SDLK_RETURN); }}},
     then_mills());
  EXPECT_EQ(begun().recipe.spacing_mm, math::Vec3(0.4, 0.4, 0.4));
}

TEST_F(ImportWindow, ReadsAnotherSeriesThatIsChosen) {
  BURR_NEEDS_DATA("skull_phantom");
  const fs::path folder = test::data_dir() / "skull_phantom";
  NoProgress quiet;
  scenario::BoneRecipe typed;
  typed.source = folder.string();
  const auto opened = open_scan(typed, quiet);
  ASSERT_TRUE(opened) << opened.error().text;
  const std::vector<std::string>& all = opened->scan->series;
  ASSERT_EQ(all.size(), 6U);
  // the one of thick slices, by its line in the list; a list's lines are as high as its letters
  const auto thick = std::find_if(all.begin(), all.end(), [](const std::string& line) {
    return line.find("28 pictures") != std::string::npos;
  });
  ASSERT_NE(thick, all.end());
  const Part& box = layout().series;
  int loads = 0;
  bool was_loading = false;
  const auto count = [&] {
    const bool is = desk_->page == Page::loading;
    loads += is && !was_loading ? 1 : 0;
    was_loading = is;
  };
  const int row = static_cast<int>(thick - all.begin());
  by({{"the start page", on(Page::start), [&] { drop(folder); }},
      {"the import page",
       [&] {
         count();
         return desk_->page == Page::import;
       },
       nullptr},
      {"the list of all", looks(5), [] { press(SDLK_RETURN); }},
      {"a picture", looks(5), [&] { click_on(box); }},
      {"the line",  // with the keys, wherever the lines lie
       [row, looked = 0]() mutable {
         if (++looked > 5 && looked % 4 == 0 && looked / 4 - 1 <= row) press(SDLK_DOWN);
         return looked > 4 * (row + 3);
       },
       [] { press(SDLK_SPACE); }},
      {"the reading",
       [&] {
         count();
         return loads == 2;
       },
       nullptr},
      {"the page of the other", on(Page::import), nullptr},
      {"a picture", looks(3),
       [&] {
         EXPECT_EQ(desk_->message, "");
         press(SDLK_RETURN);
       }}},
     then_mills());
  const record::VolumeInfo info = begun();
  EXPECT_EQ(info.recipe.series, "#" + std::to_string(row + 1));
}

// The list of all series comes first, with a picture of each; the keys and the mouse choose.
TEST_F(ImportWindow, OfSeveralSeriesOneIsChosenByItsPicture) {
  BURR_NEEDS_DATA("skull_phantom");
  const fs::path folder = test::data_dir() / "skull_phantom";
  const auto lit = [](const render::Image& image) {
    int count = 0;
    for (int y = 110; y < 640; ++y)
      for (int x = 45; x < 120; ++x)
        count += image.rgb[3 * static_cast<std::size_t>(y * image.width + x)] > 60 ? 1 : 0;
    return count;
  };
  int first = 0;
  by({{"the start page", on(Page::start), [&] { drop(folder); }},
      {"the list", on(Page::import), nullptr},
      {"a picture", looks(3),
       [&] {
         first = lit(desk_->renderer().shown());
         for (int n = 0; n < 6; ++n) press(SDLK_UP);
       }},
      {"more pictures", [&] { return lit(desk_->renderer().shown()) > 1.3 * first; },
       [] {
         for (int n = 0; n < 4; ++n) press(SDLK_DOWN);
       }},
      {"the one of thick slices", looks(3), [] { press(SDLK_RETURN); }},
      {"read", looks(2), nullptr},
      {"the page", on(Page::import), nullptr},
      {"its own picture", looks(5), [] { press(SDLK_RETURN); }}},
     then_mills());
  EXPECT_EQ(begun().recipe.series, "#5");
}

// Of a folder of many patients: dates only after a key or a click asked for them.
TEST_F(ImportWindow, OfManySeriesTheDatesAreHiddenUntilTheyAreAskedFor) {
  const fs::path folder = folder_ / "many";
  fs::create_directories(folder);
  for (int n = 1; n <= 2; ++n)
    for (int k = 0; k < 6; ++k) {
      test::DicomSlice slice;
      slice.at(k, k + 1).set(0x0020000E, "UI", "1.2.3." + std::to_string(n));
      slice.set(0x00200011, "IS", std::to_string(n)).set(0x00080020, "DA", "20190307");
      slice.value = 1500;
      slice.write(folder / (std::to_string(n) + "_" + std::to_string(k) + ".dcm"));
    }
  render::Image hidden, by_key, again, by_mouse;
  const auto keep = [this](render::Image& image, std::function<void()> then) {
    return [this, &image, then] {
      image = desk_->renderer().shown();
      then();
    };
  };
  pages_by({{"the start page", on(Page::start), [&] { drop(folder); }},
            {"the list", on(Page::import), [] { move_to(1200, 20); }},
            // both pictures are made by then
            {"no dates", looks(20), keep(hidden, [] { press(SDLK_d); })},
            {"dates", looks(4), keep(by_key, [] { press(SDLK_d); })},
            {"no dates again", looks(4),
             keep(again,
                  [] {
                    click(static_cast<int>(SeriesPage::kLeft + SeriesPage::kDates) + 12,
                          720 - static_cast<int>(SeriesPage::kFoot) + 14);
                  })},
            {"a moment", looks(4), [] { move_to(1200, 20); }},
            {"dates", looks(4), keep(by_mouse, [] { press(SDLK_ESCAPE); })},
            {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  // a line of small letters in each row, above the foot
  EXPECT_GT(differ(hidden, by_key, 40, 110, 600, 300), 200);
  EXPECT_EQ(differ(hidden, again, 40, 110, 600, 300), 0);
  EXPECT_EQ(differ(by_key, by_mouse, 40, 110, 600, 300), 0);
}

// W: the scan's own values in the slices; the button that turns pulls their window.
TEST_F(ImportWindow, ShowsWhatWasMeasuredInTheSlices) {
  render::Image model, bone, soft, pulled, again;
  const auto keep = [this](render::Image& image, std::function<void()> then) {
    return [this, &image, then = std::move(then)] {
      image = desk_->renderer().shown();
      then();
    };
  };
  const auto pull = [](int right) {
    SDL_Event event = {};
    event.type = SDL_MOUSEMOTION;
    event.motion.x = 1150 + right;
    event.motion.y = 100;
    event.motion.xrel = right;
    event.motion.state = SDL_BUTTON_RMASK;
    SDL_PushEvent(&event);
  };
  pages_by(
      {{"the start page", on(Page::start), [&] { drop(scan()); }},
       {"the import page", on(Page::import), nullptr},
       {"a picture of it", looks(3), [] { press(SDLK_RETURN); }},
       {"milling", on(Page::milling), [] { move_to(640, 360); }},
       {"the tip on the bone", looks(30), [] { move_to(1150, 100); }},
       {"the slices", looks(60), keep(model, [] { press(SDLK_w); })},
       {"the scan", looks(60), keep(bone, [] { press(SDLK_w); })},
       {"the scan's soft tissue", looks(60), keep(soft, [] { button(SDL_BUTTON_RIGHT, true); })},
       {"the hold", looks(3), [&] { pull(60); }},
       {"the pull", looks(3),
        [] {
          button(SDL_BUTTON_RIGHT, false);
          move_to(1150, 100);  // where it was: the name of what is there stands beside the pointer
        }},
       {"the wider window", looks(60), keep(pulled, [] { press(SDLK_w); })},
       {"the model again", looks(60), keep(again, [] { leave_work(); })},
       {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  const auto changed = [](const render::Image& a, const render::Image& b) {
    return differ(a, b, 1080, 20, 1270, 640);
  };
  EXPECT_GT(changed(model, bone), 2000);
  EXPECT_GT(changed(bone, soft), 2000);
  EXPECT_GT(changed(soft, pulled), 2000);
  EXPECT_LT(changed(model, again), 400);
  // the bone itself was not turned by the pull
  EXPECT_LT(differ(soft, pulled, 200, 100, 1000, 560), 400);
}

// ... and in a session that is gone on with, as long as the scan is where it was.
TEST_F(ImportWindow, WhatWasMeasuredIsThereWhenOneGoesOn) {
  pages_by({{"the start page", on(Page::start), [&] { drop(scan()); }},
            {"the import page", on(Page::import), nullptr},
            {"a picture of it", looks(3), [] { press(SDLK_RETURN); }},
            {"milling", on(Page::milling),
             [] {
               move_to(640, 360);
               press(SDLK_SPACE);
             }},
            {"some pictures", looks(90), [] { leave_work(); }},
            {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  const std::vector<KeptSession> kept = kept_sessions(folder_ / "state");
  ASSERT_EQ(kept.size(), 1U) << "nothing was cut: the test shows nothing";
  NoProgress quiet;
  const auto fresh = open_ready(kept[0].options, quiet);
  ASSERT_TRUE(fresh) << fresh.error().text;
  ASSERT_NE(fresh->greys, nullptr);
  auto ready = continue_session(kept[0], quiet);
  ASSERT_TRUE(ready) << ready.error().text;
  ASSERT_NE(ready->greys, nullptr);
  EXPECT_EQ(ready->greys->stored, fresh->greys->stored);
  {  // another scan took its place
    std::ofstream(kept[0].options.volume.source, std::ios::app) << "other";
  }
  const auto player = record::Player::open(kept[0].file.string());
  ASSERT_TRUE(player);
  EXPECT_EQ(workshop::greys_of(**player, kept[0].options.volume, quiet), nullptr);
}

TEST_F(ImportWindow, CanBeStoppedWhileItReadsAndWhileBoneIsMade) {
  BURR_NEEDS_DATA("skull_phantom");
  const fs::path folder = test::data_dir() / "skull_phantom";
  const Part plot = layout().plot;
  const auto at = [&](float part) {
    click(static_cast<int>(plot.x + part * plot.w), static_cast<int>(plot.y + plot.h / 2));
  };
  render::Image chosen, again;
  pages_by({{"the start page", on(Page::start), [&] { drop(folder); }},
            {"reading", on(Page::loading), [] { press(SDLK_ESCAPE); }},
            {"the start page again", on(Page::start), [&] { drop(folder); }},
            {"the import page", on(Page::import), nullptr},
            {"a picture", looks(3), [&] { at(0.6F); }},
            {"the level", looks(5), [] { move_to(5, 715); }},
            {"a picture at rest", looks(60),
             [&] {
               chosen = desk_->renderer().shown();
               press(SDLK_RETURN);
             }},
            {"bone being made", on(Page::loading), [] { press(SDLK_ESCAPE); }},
            {"the import page again", on(Page::import), nullptr},
            {"a picture of it", looks(60),
             [&] {
               again = desk_->renderer().shown();
               press(SDLK_ESCAPE);
             }},
            {"the start page once more", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  EXPECT_EQ(desk_->message, "");
  ASSERT_EQ(chosen.width, again.width);
  EXPECT_LT(differ(chosen, again, 0, 60, 1280, 640), 20) << "what was chosen is kept";
}

TEST_F(ImportWindow, KeepsItsPicturesWhenTheGraphicsContextIsRenewed) {
  const Part view = layout().views[0];
  const int x0 = static_cast<int>(view.x), y0 = static_cast<int>(view.y),
            x1 = static_cast<int>(view.x + view.w), y1 = static_cast<int>(view.y + view.h);
  render::Image before, after;
  pages_by({{"the start page", on(Page::start), [&] { drop(scan()); }},
            {"the import page", on(Page::import), [] { move_to(5, 715); }},
            {"a picture", looks(10),
             [&] {
               before = desk_->renderer().shown();
               const Status renewed = desk_->renew();
               EXPECT_TRUE(renewed) << renewed.error().text;
             }},
            {"a picture of the new context", looks(10),
             [&] {
               after = desk_->renderer().shown();
               press(SDLK_ESCAPE);
             }},
            {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  EXPECT_EQ(desk_->renewed(), 1);
  render::Image nothing = before;
  std::fill(nothing.rgb.begin(), nothing.rgb.end(), std::uint8_t{0});
  EXPECT_GT(differ(before, nothing, x0, y0, x1, y1), 1000) << "no preview: the test shows nothing";
  EXPECT_LT(differ(before, after, x0, y0, x1, y1), 20);
}

}  // namespace
}  // namespace burr::app
