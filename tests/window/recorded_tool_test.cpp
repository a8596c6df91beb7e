// A 4 mm burr in the hole that it made, and a command for 7 mm there, which the servo refuses: all
// who look at the recording see 4 mm.
#include <gtest/gtest.h>

#include <sys/wait.h>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iterator>
#include <thread>

#include "burr/record/player.h"
#include "burr/record/timeline.h"
#include "burr/workshop/sound_tracker.h"
#include "burr/workshop/traces.h"
#include "sim/commanded.h"
#include "sim/lifted.h"
#include "support/folder.h"
#include "support/test_places.h"
#include "window/replay/playback.h"
#include "window/replay/replay_page.h"
#include "window/replay/replay_view.h"
#include "window/replay/timeline_panel.h"
#include "window/user.h"

namespace burr::app {
namespace {

constexpr double kLate = 2.5;  // after the command  [s]

class RecordedTool : public testing::Test {
 protected:
  RecordedTool() {
    EXPECT_EQ(sim::test::record_commanded(file("asked"), sim::test::in_its_own_hole()), 2e-3);
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_ / (name + ".mcap")).string();
  }
  static std::unique_ptr<record::Player> opened(const std::string& path) {
    auto player = record::Player::open(path);
    EXPECT_TRUE(player.ok()) << player.error().text;
    return std::move(*player);
  }
  // `burr replay NAME WORDS`
  void replay(const std::string& name, const std::string& words) const {
    const std::string command = "'" + test::build_dir() + "/burr' replay '" + file(name) +
                                "' --picture-size 320,240 " + words + " >'" +
                                (folder_ / "said.txt").string() + "' 2>&1";
    const int status = std::system(command.c_str());
    std::ifstream said(folder_ / "said.txt");
    EXPECT_EQ(WEXITSTATUS(status), 0) << command << "\n"
                                      << std::string(std::istreambuf_iterator<char>(said), {});
  }
  [[nodiscard]] std::vector<render::Image> picture_of(const std::string& name) const {
    replay(name, "--picture '" + (folder_ / "p.png").string() + "'");
    return {read(folder_ / "p.png")};
  }
  [[nodiscard]] std::vector<render::Image> film_of(const std::string& name, int fps) const {
    const fs::path film = folder_ / ("film_" + name);
    replay(name, "--fps " + std::to_string(fps) + " --film '" + film.string() + "'");
    std::vector<fs::path> pictures;
    for (const auto& entry : fs::directory_iterator(film)) pictures.push_back(entry.path());
    EXPECT_GT(pictures.size(), 1U);
    std::sort(pictures.begin(), pictures.end());
    std::vector<render::Image> all;
    for (const fs::path& one : pictures) all.push_back(read(one));
    return all;
  }
  static render::Image read(const fs::path& path) {
    render::Image image;
    unsigned char* rgb = stbi_load(path.c_str(), &image.width, &image.height, nullptr, 3);
    EXPECT_NE(rgb, nullptr) << path;
    if (rgb != nullptr) image.rgb.assign(rgb, rgb + 3L * image.width * image.height);
    stbi_image_free(rgb);
    return image;
  }
  // pixels of the last that differ
  static int differ(const std::vector<render::Image>& a, const std::vector<render::Image>& b) {
    EXPECT_EQ(a.size(), b.size());
    EXPECT_EQ(a.back().rgb.size(), b.back().rgb.size());
    int count = 0;
    for (std::size_t at = 0; at < std::min(a.back().rgb.size(), b.back().rgb.size()); at += 3)
      count += std::abs(int{a.back().rgb[at]} - int{b.back().rgb[at]}) > 24 ? 1 : 0;
    return count;
  }

  const test::Folder own_;
  const fs::path folder_ = own_.path();
};

TEST_F(RecordedTool, IsHeard) {
  const auto player = opened(file("asked"));
  workshop::SoundTracker tracker({}, [](const math::Vec3&) { return 5e-3; });
  record::StepCursor steps = player->steps();
  for (record::Step step; steps.next(step);)
    ASSERT_EQ(tracker.update(step.row).to_spare, 5e-3 - 2e-3) << step.row.tick;
}

TEST_F(RecordedTool, LeavesItsDust) {
  const auto player = opened(file("asked"));
  workshop::Traces walked(*player), jumped(*player);
  const auto all = walked.until(kLate).ticks;
  const auto some = jumped.seek(kLate).ticks;
  EXPECT_GT(all.size(), 100U);
  EXPECT_GT(some.size(), 10U);
  for (const render::Wound::Tick& tick : all) EXPECT_EQ(tick.radius, 2e-3);
  for (const render::Wound::Tick& tick : some) EXPECT_EQ(tick.radius, 2e-3);

  // and coolant where there was some: a jump knows of what was commanded long before
  sim::test::record_commanded(
      file("wet"), {.stopped_after = 1, .commands = {{500, {tick::CommandKind::irrigation, 1}}}});
  const auto wet = opened(file("wet"));
  workshop::Traces wetted(*wet);
  bool any = false;
  for (const render::Wound::Tick& tick : wetted.until(0.999).ticks) {
    EXPECT_EQ(tick.irrigated, tick.t > 0.4995) << tick.t;
    any = any || tick.irrigated;
  }
  EXPECT_TRUE(any);
}

// A piece that is out of the bone is in the picture, in the film and in playback.
TEST_F(RecordedTool, TheLiftedPieceIsShown) {
  const sim::test::Lifted truth = sim::test::record_lifted(file("lifted"));
  const auto blue = [](const render::Image& image) {
    int count = 0;
    for (std::size_t at = 0; at + 2 < image.rgb.size(); at += 3)
      count += int{image.rgb[at + 2]} > image.rgb[at] + 40 ? 1 : 0;
    return count;
  };
  const auto picture = [&](double t) {
    replay("lifted", "--at " + std::to_string(t) + " --view work --picture '" +
                         (folder_ / "p.png").string() + "'");
    return read(folder_ / "p.png");
  };
  const int behind = blue(picture(truth.before));
  EXPECT_GT(blue(picture(truth.out[0])), behind + 500);
  EXPECT_LT(blue(picture(truth.lies)), behind + 20);
  EXPECT_GT(blue(picture(truth.out[1])), behind + 500);
  replay("lifted", "--fps 20 --view work --from " + std::to_string(truth.out[0] - 0.1) +
                       " --until " + std::to_string(truth.lies) + " --film '" +
                       (folder_ / "film").string() + "'");
  std::vector<fs::path> film;
  for (const auto& entry : fs::directory_iterator(folder_ / "film")) film.push_back(entry.path());
  std::sort(film.begin(), film.end());
  ASSERT_GT(film.size(), 4U);
  EXPECT_GT(blue(read(film.front())), behind + 500);
  EXPECT_LT(blue(read(film.back())), behind + 20);

  NoProgress quiet;
  auto recorded = open_recorded(file("lifted"), {}, {}, quiet);
  ASSERT_TRUE(recorded.ok()) << recorded.error().text;
  const std::size_t softs = recorded->scene.soft.size();
  ReplayView view(*recorded, true, {});
  const auto shown_at = [&](double t) {
    view.want(t);
    for (int n = 0; n < 3000 && !view.settled(); ++n) {
      view.look(false, false, false);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_TRUE(view.settled());
    EXPECT_EQ(view.trouble(), "");
  };
  shown_at(truth.before);
  EXPECT_EQ(recorded->scene.soft.size(), softs);
  for (const int n : {0, 1, 0}) {
    shown_at(truth.out[n]);
    ASSERT_EQ(recorded->scene.soft.size(), softs + 1);
    EXPECT_LT((recorded->scene.soft.back().box.centre() - truth.at[n].p).norm(), 0.5e-3) << n;
  }
  shown_at(truth.lies);
  EXPECT_EQ(recorded->scene.soft.size(), softs);
}

TEST_F(RecordedTool, IsInThePictureAndInTheFilm) {
  auto plan = sim::test::in_its_own_hole();
  plan.commands.clear();
  sim::test::record_commanded(file("quiet"), plan);
  // the touch is not the same to the bit, but no picture shows that
  EXPECT_LT(differ(picture_of("asked"), picture_of("quiet")), 20);
  EXPECT_LT(differ(film_of("asked", 4), film_of("quiet", 4)), 20);

  // in free air it is obeyed: the picture is that of a session that began with this burr
  const sim::test::Commanded air{.stopped_after = 0.15,
                                 .commands = {{20, {tick::CommandKind::burr_radius, 1.5e-3}}}};
  EXPECT_EQ(sim::test::record_commanded(file("changed"), air), 1.5e-3);
  sim::test::record_commanded(file("began"), {.burr_mm = 3, .stopped_after = 0.15});
  sim::test::record_commanded(file("other"), {.stopped_after = 0.15});
  sim::test::record_commanded(
      file("ground"),
      {.stopped_after = 0.15, .commands = {{20, {tick::CommandKind::burr_kind, 1}}}});
  ASSERT_FALSE(opened(file("changed"))->tick_at(1)->contact.touching);
  const auto changed = picture_of("changed"), other = picture_of("other");
  EXPECT_EQ(differ(changed, picture_of("began")), 0);
  EXPECT_GT(differ(changed, other), 100);
  EXPECT_GT(differ(picture_of("ground"), other), 20);
  EXPECT_GT(differ(film_of("changed", 20), film_of("other", 20)), 100);
}

TEST_F(RecordedTool, IsOnThePage) {
  ::setenv("SDL_VIDEODRIVER", "offscreen", 1);
  auto desk = Desk::open({folder_ / "config", folder_ / "state", {}});
  if (!desk) {
    ASSERT_FALSE(test::data_required()) << desk.error().text;
    GTEST_SKIP() << desk.error().text;
  }
  NoProgress quiet;
  auto recorded = open_recorded(file("asked"), {}, {}, quiet);
  ASSERT_TRUE(recorded) << recorded.error().text;
  ASSERT_EQ(recorded->timeline.events.size(), 1U);
  EXPECT_EQ(command_text(recorded->timeline.events[0]), word(Word::no_room));
  EXPECT_EQ(recorded->timeline.tool_at(kLate).radius, 2e-3);

  Watched seen;
  double diameter = 0, radius = 0;
  Script script({{"the moment", [&] { return std::abs(seen.shown - kLate) < 1e-9 && !seen.behind; },
                  [&] {
                    diameter = seen.diameter;
                    radius = recorded->scene.burr.radius;
                    press(SDLK_ESCAPE);
                  }}},
                seen.note);
  (*desk)->after_frame = [&script] { script.look(); };
  const auto left = watch(**desk, *recorded, {.from = kLate, .seen = &seen});
  (*desk)->after_frame = {};
  ASSERT_TRUE(left) << left.error().text;
  EXPECT_TRUE(script.finished());
  EXPECT_EQ(diameter, 4e-3);
  EXPECT_EQ(radius, 2e-3);
}

}  // namespace
}  // namespace burr::app
