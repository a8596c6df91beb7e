// A user who watches a recording: what is shown is what was, at any moment asked for.
#include "window/replay/replay_page.h"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "burr/render/bone_scene.h"
#include "burr/render/held_tool.h"
#include "burr/surgeon/motion.h"
#include "burr/tool/shape.h"
#include "burr/workshop/work_view.h"
#include "shared/recorded_session.h"
#include "shared/work.h"
#include "support/test_places.h"
#include "window/replay/difference.h"
#include "window/shell/pages.h"
#include "window/user.h"

namespace burr::app {
namespace {

constexpr double kSeconds = 12;

// A block cut for twelve seconds of its time, with an undo and another burr on the way: a recording
// and the bone as it was left.
class Replay : public Window {
 protected:
  void SetUp() override {
    Window::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    WorkOptions options;
    options.volume.source = "block";
    options.volume.voxel_mm = 0.5;
    options.tool.tool = tool_;
    NoProgress quiet;
    ASSERT_TRUE(take_case(options));
    auto work = open_work(options, quiet);
    ASSERT_TRUE(work) << work.error().text;
    before_ = work->bone->content_hash();
    const auto chosen = settings_of(options, false);
    ASSERT_TRUE(chosen) << chosen.error().text;
    const sim::SessionSettings& settings = *chosen;
    auto path = surgeon::motion("pocket", work->place, settings.servo.burr.radius, kSeconds);
    ASSERT_TRUE(path) << path.error().text;
    auto session = sim::Session::make(
        std::move(work->bone),
        std::make_unique<device::SimulatedHand>(std::move(*path), device::ArmSettings{}, hand_),
        settings, quiet);
    ASSERT_TRUE(session) << session.error().text;
    Recording recording;
    ASSERT_TRUE(
        recording.start(**session, file_.string(), work->recipe, work->summary, "pocket", false));
    (*session)->run(5, quiet);
    half_ = (*session)->bone().content_hash();
    (*session)->command({tick::CommandKind::undo, 0});
    (*session)->command({tick::CommandKind::spindle_speed, 3000});
    (*session)->run(kSeconds - 5, quiet);
    ASSERT_TRUE(recording.finish(**session));
    after_ = (*session)->bone().content_hash();
    const edit::Ledger account = (*session)->outcome().ledger;
    removed_ = account.removed - account.undone;
    ASSERT_NE(before_, half_) << "nothing was cut: the test shows nothing";
    ASSERT_NE(half_, after_);
  }

  Recorded open() const {
    NoProgress quiet;
    auto recorded = open_recorded(file_.string(), {}, {}, quiet);
    EXPECT_TRUE(recorded) << (recorded ? "" : recorded.error().text);
    return recorded ? std::move(*recorded) : Recorded{};
  }
  void watch_by(Recorded& recorded, double from, std::vector<Script::Step> steps) {
    Script script(std::move(steps), seen_.note);
    desk_->after_frame = [&script] { script.look(); };
    const auto left = watch(*desk_, recorded, {.from = from, .seen = &seen_});
    desk_->after_frame = {};
    ASSERT_TRUE(left) << left.error().text;
    EXPECT_TRUE(script.finished());
  }
  // the picture is of this moment, whole
  [[nodiscard]] std::function<bool()> shows(double t) const {
    return [this, t, quiet = 0]() mutable {
      quiet = std::abs(seen_.shown - t) < 1e-9 && std::abs(seen_.t - t) < 1e-9 && !seen_.behind
                  ? quiet + 1
                  : 0;
      return quiet > 30;
    };
  }

  device::DeviceSpec hand_;
  std::string tool_;  // of the rack; empty: the round burr
  fs::path file_ = folder_ / "s.mcap";
  std::uint64_t before_ = 0, half_ = 0, after_ = 0;
  double removed_ = 0;
  Watched seen_;
};

class ReplayOfAMouse : public Replay {
 protected:
  ReplayOfAMouse() { hand_.name = "mouse"; }
};

TEST_F(ReplayOfAMouse, ShowsTheToolHeldAsWhileMillingAndNotAlongTheRecordedAxis) {
  Recorded recorded = open();
  ASSERT_TRUE(recorded.bone);
  math::Vec3 drawn = math::Vec3::Zero(), sight = drawn, right = drawn;
  watch_by(recorded, 4.999, {{"half time", shows(4.999), [&] {
                                const render::Scene& scene = recorded.scene;
                                drawn = scene.burr.world_from_tool.q * math::Vec3::UnitZ();
                                sight = scene.camera.eye() - scene.burr.world_from_tool.p;
                                right = scene.camera.right();
                                press(SDLK_ESCAPE);
                              }}});
  const math::Vec3 along =
      recorded.player->tick_at(4.999)->hand.world_from_tool.q * math::Vec3::UnitZ();
  const auto angle = [](const math::Vec3& a, const math::Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
  };
  EXPECT_GT(angle(drawn, sight), 0.95 * render::HeldTool::kLeast);
  EXPECT_GT(angle(drawn, along), 0.1);
  EXPECT_GT(drawn.dot(right), 0.1) << "from the side of the right hand";
}

class ReplayOfASaw : public ReplayOfAMouse {
 protected:
  ReplayOfASaw() { tool_ = "sagittal-saw"; }
};

// Also with a mouse: the direction of a blade matters to what it cuts.
TEST_F(ReplayOfASaw, ShowsTheSawWhereItWas) {
  Recorded recorded = open();
  ASSERT_TRUE(recorded.bone);
  ASSERT_EQ(recorded.player->info().tools.size(), 1U);
  const tool::Tool& saw = recorded.player->info().tools[0].tool;
  math::Pose drawn;
  std::vector<math::Vec3> seen;
  watch_by(recorded, 4.999, {{"half time", shows(4.999), [&] {
                                drawn = recorded.scene.burr.world_from_tool;
                                if (const render::ToolLook* look = recorded.scene.burr.other.get();
                                    look != nullptr)
                                  for (const surface::Mesh* part : {&look->cuts, &look->rubs})
                                    for (const surface::Vertex& vertex : part->vertices)
                                      seen.emplace_back(vertex.p.cast<double>());
                                press(SDLK_ESCAPE);
                              }}});
  EXPECT_GT(seen.size(), 100U);
  for (const math::Vec3& p : seen) {  // on the surface of a part
    double off = 1;
    for (int n = 0; n < saw.count; ++n) {
      const tool::Part& part = saw.parts[static_cast<std::size_t>(n)];
      off = std::min(off,
                     std::abs(tool::distance(part.shape, part.tool_from_part.inverse() * p).phi));
    }
    EXPECT_LT(off, 0.1e-3) << p.transpose();
  }
  const tick::TickRow row = *recorded.player->tick_at(4.999);
  const math::Pose held = workshop::pose_of_tool(row);
  EXPECT_LT((drawn.p - held.p).norm(), 1e-9);
  EXPECT_LT((drawn.q.coeffs() - held.q.coeffs()).norm(), 1e-9);
}

// Removed and not undone at that second [m^3].
double left_at(record::Player& player, double t) {
  const edit::Ledger account = player.tick_at(t)->ledger;
  return account.removed - account.undone;
}

TEST_F(Replay, ShowsTheBoneOfTheMomentThatKeysAskFor) {
  Recorded recorded = open();
  ASSERT_TRUE(recorded.bone);
  render::Image start, half, end, again;
  std::uint64_t hash_half = 0;
  double force_half = 0, removed_end = 0;
  watch_by(recorded, 4.999,
           {{"half time", shows(4.999),
             [&] {
               hash_half = recorded.bone->content_hash();  // nobody writes it now
               half = desk_->renderer().shown();
               force_half = seen_.force;
               press(SDLK_END);
             }},
            {"the end", shows(kSeconds),
             [&] {
               removed_end = seen_.removed;
               end = desk_->renderer().shown();
               press(SDLK_HOME);
             }},
            {"the start", shows(0),
             [&] {
               start = desk_->renderer().shown();
               press(SDLK_END);
             }},
            {"the end again", shows(kSeconds), [&] {
               again = desk_->renderer().shown();
               press(SDLK_ESCAPE);
             }}});
  EXPECT_EQ(hash_half, half_);
  EXPECT_EQ(recorded.bone->content_hash(), after_);
  EXPECT_DOUBLE_EQ(removed_end, removed_);
  EXPECT_NEAR(force_half, recorded.player->tick_at(4.999)->contact.force.norm(), 1e-12);
  // above the strip
  EXPECT_GT(differ(start, end, 100, 20, 1180, 500), 1000);
  EXPECT_GT(differ(start, half, 100, 20, 1180, 500), 1000);
  EXPECT_LT(differ(end, again, 100, 20, 1180, 500), 50) << "the same moment, another picture";
}

// Pixels that are paler than in the other picture of the same moment: what lies there is dust.
int paler(const render::Image& image, const render::Image& other) {
  int count = 0;
  for (int y = 20; y < 500; ++y)
    for (int x = 100; x < 1180; ++x) {
      const auto blue = static_cast<std::size_t>(3 * (y * image.width + x) + 2);
      count += image.rgb[blue] > other.rgb[blue] + 12;
    }
  return count;
}

TEST_F(Replay, ShowsWhatMillingLeftUnlessTheSettingIsOff) {
  struct Seen {
    render::Image end, start, again;
  };
  Seen with, without;
  for (const bool effects : {true, false}) {
    desk_->settings.effects = effects;
    Seen& seen = effects ? with : without;
    Recorded recorded = open();
    ASSERT_TRUE(recorded.bone);
    watch_by(recorded, kSeconds - 1,
             {{"the end", shows(kSeconds - 1),
               [&] {
                 seen.end = desk_->renderer().shown();
                 press(SDLK_HOME);
               }},
              {"the start", shows(0),
               [&] {
                 seen.start = desk_->renderer().shown();
                 press(SDLK_END);
               }},
              {"the end again", shows(kSeconds), [&] {
                 seen.again = desk_->renderer().shown();
                 press(SDLK_ESCAPE);
               }}});
  }
  EXPECT_GT(paler(with.end, without.end), 500);
  EXPECT_GT(paler(with.again, without.again), 500) << "after going back and there again";
  EXPECT_LT(paler(with.start, without.start), 200) << "nothing had been milled yet";
}

// ---- two of them

int run_burr(const std::string& words) {
  const int left =
      std::system((test::build_dir() + "/burr --quiet " + words + " > /dev/null").c_str());
  return WIFEXITED(left) ? WEXITSTATUS(left) : -1;
}

// In how many squares of 16 pixels, where no panel lies, the right half differs from the left one
// by their mean: a half may have been drawn with fewer samples, which shows along edges.
int halves_differ(const render::Image& image) {
  constexpr int kSide = 16;
  const int half = image.width / 2;
  int count = 0;
  for (int y = 64; y + kSide <= 460; y += kSide)
    for (int x = 96; x + kSide <= half - 16; x += kSide) {  // right of the buttons
      std::array<int, 3> by = {};
      for (int n = 0; n < kSide * kSide; ++n) {
        const int at = (y + n / kSide) * image.width + x + n % kSide;
        for (int c = 0; c < 3; ++c)
          by[static_cast<std::size_t>(c)] +=
              int{image.rgb[static_cast<std::size_t>(3 * at + c)]} -
              int{image.rgb[static_cast<std::size_t>(3 * (at + half) + c)]};
      }
      int all = 0;
      for (const int each : by) all += std::abs(each);
      count += all > 24 * kSide * kSide ? 1 : 0;
    }
  return count;
}

class TwoReplays : public Replay {
 protected:
  // looks settled with the left one at t and the right one at its own moment
  [[nodiscard]] std::function<bool()> both_show(double t, double right) const {
    return [this, t, right, quiet = 0]() mutable {
      const bool so = seen_.beside && std::abs(seen_.shown - t) < 1e-9 &&
                      std::abs(seen_.shown_beside - right) < 1e-9 && !seen_.behind;
      quiet = so ? quiet + 1 : 0;
      return quiet > 30;
    };
  }
  void watch_file_by(double from, std::vector<Script::Step> steps) {
    Script script(std::move(steps), seen_.note);
    desk_->after_frame = [&script] { script.look(); };
    const auto left = watch_file(*desk_, file_.string(), {}, {.from = from, .seen = &seen_});
    desk_->after_frame = {};
    ASSERT_TRUE(left) << left.error().text;
    EXPECT_TRUE(script.finished());
  }
};

TEST_F(TwoReplays, OfOneSessionAreTheSamePictureUntilOneIsShifted) {
  desk_->settings.effects = false;  // dust lies as one came to the moment
  int same = -1, shifted = -1, again = -1;
  double removed = 0, removed_later = 0;
  render::Image whole, after;
  watch_file_by(3, {{"one", shows(3),
                     [&] {
                       whole = desk_->renderer().shown();
                       drop(file_);
                     }},
                    {"both, with a table", both_show(3, 3),
                     [] {
                       press(SDLK_c);  // colours
                       press(SDLK_c);  // nothing over the bone
                     }},
                    {"both", both_show(3, 3),
                     [&] {
                       same = halves_differ(desk_->renderer().shown());
                       removed = seen_.removed_beside;
                       for (int n = 0; n < 4; ++n) press(SDLK_RIGHTBRACKET);
                     }},
                    {"the right one two seconds later", both_show(3, 1),
                     [&] {
                       shifted = halves_differ(desk_->renderer().shown());
                       removed_later = seen_.removed_beside;
                       press(SDLK_END);
                     }},
                    {"its end comes later", both_show(kSeconds, kSeconds),
                     [&] {
                       EXPECT_DOUBLE_EQ(seen_.t, kSeconds + 2);
                       again = halves_differ(desk_->renderer().shown());
                       press(SDLK_b);
                     }},
                    {"one again", shows(kSeconds), [&] {
                       EXPECT_FALSE(seen_.beside);
                       after = desk_->renderer().shown();
                       press(SDLK_ESCAPE);
                     }}});
  EXPECT_LE(same, 1) << "the same moment from the same side";
  EXPECT_GT(shifted, 8);
  EXPECT_LE(again, 1);
  NoProgress quiet;
  auto player = record::Player::open(file_.string());
  ASSERT_TRUE(player);
  EXPECT_DOUBLE_EQ(removed, left_at(**player, 3));
  EXPECT_DOUBLE_EQ(removed_later, left_at(**player, 1));
  EXPECT_GT(differ(whole, after, 700, 60, 1200, 500), 100) << "more was milled by then";
}

TEST_F(TwoReplays, OfTwoSessionsEachShowItsOwnAndTheShorterWaitsAtItsEnd) {
  const fs::path other = folder_ / "other.mcap", broken = folder_ / "broken.mcap";
  ASSERT_EQ(run_burr("mill phantom:block --voxel-mm 0.5 --motion slot --burr-mm 5 --seconds 3 "
                     "--record " +
                     other.string()),
            0);
  std::ofstream(broken) << "no recording";
  auto player = record::Player::open(other.string());
  ASSERT_TRUE(player);
  const double end = (*player)->seconds();
  desk_->settings.effects = false;  // they go on changing the picture
  int halves = 0;
  double right = 0, left = 0;
  const auto turned = [](const render::Image& a, const render::Image& b, int from) {
    return differ(a, b, from + 4, 60, from + 636, 520);
  };
  render::Image before, after;
  watch_file_by(2, {{"one", shows(2), [&] { drop(broken); }},
                    {"told", [&] { return seen_.note.find("broken.mcap") != std::string::npos; },
                     [&] {
                       EXPECT_FALSE(seen_.beside);
                       drop(other);
                     }},
                    {"both", both_show(2, 2),
                     [&] {
                       before = desk_->renderer().shown();
                       halves = halves_differ(before);
                       left = seen_.removed;
                       right = seen_.removed_beside;
                       press(SDLK_UP);
                       press(SDLK_UP);
                     }},
                    {"turned", looks(40),
                     [&] {
                       after = desk_->renderer().shown();
                       press(SDLK_END);
                     }},
                    {"the end", both_show(kSeconds, end), [] { press(SDLK_ESCAPE); }}});
  EXPECT_GT(halves, 8);
  EXPECT_DOUBLE_EQ(right, left_at(**player, 2));
  EXPECT_NE(right, left);
  EXPECT_GT(turned(before, after, 0), 10'000);
  EXPECT_GT(turned(before, after, 640), 10'000) << "the right one is turned with the left one";
  EXPECT_EQ(run_burr("replay " + other.string() + " --beside " + file_.string() + " 2> /dev/null"),
            2);
}

// How many pixels of the left and the right half have this colour's hue: of the paint, in any light.
std::pair<int, int> painted(const render::Image& image, const render::Colour& colour) {
  std::pair<int, int> count;
  const auto hue = [](float r, float g, float b) {
    return std::atan2(std::sqrt(3.0F) * (g - b), 2 * r - g - b);
  };
  for (int y = 60; y < 520; ++y)
    for (int x = y < 300 ? 380 : 0; x < image.width; ++x) {  // not in the table
      const auto at = static_cast<std::size_t>(3 * (y * image.width + x));
      const float r = image.rgb[at], g = image.rgb[at + 1], b = image.rgb[at + 2];
      if (std::max({r, g, b}) - std::min({r, g, b}) < 60) continue;
      if (std::abs(std::remainder(hue(r, g, b) - hue(colour[0], colour[1], colour[2]), 6.2832F)) >
          0.3F)
        continue;
      ++(x < image.width / 2 ? count.first : count.second);
    }
  return count;
}

TEST_F(TwoReplays, AreComparedInColourAndInSlicesOfTheSamePlace) {
  const fs::path other = folder_ / "other.mcap";
  ASSERT_EQ(run_burr("mill phantom:block --voxel-mm 0.5 --motion slot --burr-mm 5 --seconds 3 "
                     "--record " +
                     other.string()),
            0);
  desk_->settings.effects = false;
  auto player = record::Player::open(other.string());
  ASSERT_TRUE(player);
  const double end = (*player)->seconds();
  render::Image plain, coloured, again, sliced;
  watch_file_by(
      kSeconds,
      {{"one", shows(kSeconds), [&] { drop(other); }},
       {"both, measured",
        [&, settled = both_show(kSeconds, end)]() mutable { return settled() && seen_.measured; },
        [&] {
          plain = desk_->renderer().shown();
          press(SDLK_c);
        }},
       {"colours", [&, wait = 0]() mutable { return seen_.coloured && ++wait > 90; },
        [&] {
          coloured = desk_->renderer().shown();
          press(SDLK_v);
        }},
       {"slices", [&, wait = 0]() mutable { return seen_.slices == 1 && ++wait > 90; },
        [&] {
          sliced = desk_->renderer().shown();
          press(SDLK_v);
          press(SDLK_v);
          press(SDLK_c);
        }},
       {"no colours", [&, wait = 0]() mutable { return !seen_.coloured && ++wait > 90; },
        [&] {
          again = desk_->renderer().shown();
          press(SDLK_ESCAPE);
        }}});
  const auto left = painted(coloured, kLeftOnly), right = painted(coloured, kRightOnly);
  const auto none = painted(plain, kLeftOnly);
  // what only the left one cut: the wall of its pocket, and the bone that the right one still has
  EXPECT_GT(left.first, none.first + 50) << "the wall of its pocket";
  EXPECT_GT(left.second, none.second + 200);
  EXPECT_LT(painted(again, kLeftOnly).first, none.first + 50);
  EXPECT_GT(painted(sliced, kLeftOnly).first, left.first + 200) << "the slices are filled";
  static_cast<void>(right);
}

TEST_F(TwoReplays, OfOneSessionHaveTheSameSlices) {
  desk_->settings.effects = false;
  render::Image sliced;
  watch_file_by(6, {{"one", shows(6), [&] { drop(file_); }},
                    {"both", both_show(6, 6), [] { press(SDLK_v); }},
                    {"slices", [&, wait = 0]() mutable { return seen_.slices == 1 && ++wait > 40; },
                     [&] {
                       sliced = desk_->renderer().shown();
                       press(SDLK_ESCAPE);
                     }}});
  // the column of slices is 8 pixels from the right of each half
  int differ_by = 0, bright = 0;
  for (int y = 20; y < 500; ++y)
    for (int x = 480; x < 630; ++x) {
      const auto a = static_cast<std::size_t>(3 * (y * sliced.width + x)), b = a + 3 * 640;
      differ_by += sliced.rgb[a] != sliced.rgb[b] ? 1 : 0;
      bright += sliced.rgb[a] > 180 ? 1 : 0;
    }
  EXPECT_LT(differ_by, 100);
  EXPECT_GT(bright, 2000) << "there is bone in them";
}

// ---- films

// the middle of what the export page has, at 1280 x 720
void click_write() { click(240 + 692, 144 + 310); }
void click_pictures() { click(240 + 181, 144 + 126); }
void click_stop() { click(240 + 367, 144 + 310); }

fs::path frame(const fs::path& folder, int number) {
  return folder / fmt::format("frame_{:06d}.png", number);
}
std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(Replay, AFilmHasThePicturesOfTheCommandLine) {
  const fs::path recording = folder_ / "short.mcap", film = folder_ / "film", other = folder_ / "o";
  ASSERT_EQ(
      run_burr("mill phantom:block --voxel-mm 1 --motion slot --burr-mm 5 --seconds 1 --record " +
               recording.string()),
      0);
  ASSERT_EQ(run_burr("replay " + recording.string() +
                     " --effects --fps 5 --picture-size 160,100 --film " + other.string()),
            0);
  NoProgress quiet;
  auto recorded = open_recorded(recording.string(), {}, {}, quiet);
  ASSERT_TRUE(recorded) << recorded.error().text;
  recorded->film.plan.fps = 5;
  recorded->film.plan.size = {160, 100};
  const auto says = [this](const std::string& words) {
    return [this, words] { return seen_.note.find(words) != std::string::npos; };
  };
  std::string asked;
  Script script({{"the end", shows(1), [] { press(SDLK_e); }},
                 {"the page", looks(5), click_pictures},
                 {"the choice", looks(5), click_write},
                 {"the film", says("5 pictures"), [] { press(SDLK_e); }},
                 {"the page again", looks(5), click_write},
                 {"the question", looks(5),
                  [&] {
                    asked = seen_.note;
                    fs::remove(frame(film, 1));
                    press(SDLK_ESCAPE);
                  }},
                 {"the line again", looks(5), [] { press(SDLK_ESCAPE); }}},
                seen_.note);
  desk_->after_frame = [&script] { script.look(); };
  const auto left =
      watch(*desk_, *recorded, {.folder = folder_.string(), .from = 1, .seen = &seen_});
  desk_->after_frame = {};
  ASSERT_TRUE(left) << left.error().text;
  EXPECT_TRUE(script.finished());
  for (int n = 2; n <= 5; ++n) {
    ASSERT_TRUE(fs::exists(frame(other, n)));
    EXPECT_TRUE(bytes_of(frame(film, n)) == bytes_of(frame(other, n))) << n;
  }
  EXPECT_FALSE(fs::exists(frame(film, 6)));
  EXPECT_FALSE(fs::exists(frame(film, 1))) << "a film was there: asked first, not made again";
}

TEST_F(Replay, AFilmThatIsStoppedKeepsWhatWasMade) {
  Recorded recorded = open();
  ASSERT_TRUE(recorded.bone);
  const fs::path film = folder_ / "film";
  Script script(
      {{"a moment", shows(1), [] { press(SDLK_e); }},
       {"the page", looks(5), click_pictures},
       {"the choice", looks(5), click_write},
       {"some pictures", [&] { return fs::exists(frame(film, 2)); }, [] { press(SDLK_e); }},
       {"the page again", looks(5), click_stop},
       {"the word that it stopped", [&] { return seen_.note.find("stopped") != std::string::npos; },
        [] { press(SDLK_ESCAPE); }},
       {"the line", looks(5), [] { press(SDLK_ESCAPE); }}},
      seen_.note);
  desk_->after_frame = [&script] { script.look(); };
  const auto left =
      watch(*desk_, recorded, {.folder = folder_.string(), .from = 1, .seen = &seen_});
  desk_->after_frame = {};
  ASSERT_TRUE(left) << left.error().text;
  EXPECT_TRUE(script.finished());
  EXPECT_TRUE(fs::exists(frame(film, 2)));
  EXPECT_FALSE(fs::exists(frame(film, static_cast<int>(25 * kSeconds) - 1)));
}

TEST_F(Replay, AFilmInOneFileShowsThePartBetweenTheMarks) {
  Recorded recorded = open();
  ASSERT_TRUE(recorded.bone);
  recorded.film.plan.fps = 5;
  recorded.film.plan.size = {160, 100};
  double from = -1, until = -1, whole_from = -1;
  Script script(
      {{"a moment", shows(2), [] { press(SDLK_o); }},
       {"the end of the part", [&] { return seen_.film_until == 2; }, [] { press(SDLK_HOME); }},
       {"the start", shows(0), [] { press(SDLK_RIGHT); }},
       {"a second", shows(1), [] { press(SDLK_i); }},
       {"the beginning of the part", [&] { return seen_.film_from == 1; },
        [&] {
          from = seen_.film_from;
          until = seen_.film_until;
          press(SDLK_e);
        }},
       {"the page", looks(5), click_write},
       {"the film", [&] { return seen_.note.find("film.mp4, 5 pictures") != std::string::npos; },
        [] { press(SDLK_i); }},
       {"the mark gone", [&] { return seen_.film_from == 0; },
        [&] {
          whole_from = seen_.film_from;
          press(SDLK_ESCAPE);
        }}},
      seen_.note);
  desk_->after_frame = [&script] { script.look(); };
  const auto left =
      watch(*desk_, recorded, {.folder = folder_.string(), .from = 2, .seen = &seen_});
  desk_->after_frame = {};
  ASSERT_TRUE(left) << left.error().text;
  EXPECT_TRUE(script.finished());
  EXPECT_EQ(from, 1);
  EXPECT_EQ(until, 2);
  EXPECT_EQ(whole_from, 0);
  const std::string probe =
      "test \"$(ffprobe -v error -count_frames -show_entries stream=nb_read_frames,duration -of "
      "csv=p=0 " +
      (folder_ / "film.mp4").string() + ")\" = 1.000000,5";
  EXPECT_EQ(std::system(probe.c_str()), 0);
}

TEST(Film, SaysWhyThereIsNone) {
  NoProgress quiet;
  FilmSource source;
  source.recording = "/no/such.mcap";
  const auto none = write_film(source, "/tmp/no_film", quiet);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text.find("/no/such.mcap"), std::string::npos) << none.error().text;
}

TEST_F(Replay, PlaysPausesAndChangesPace) {
  Recorded recorded = open();
  ASSERT_TRUE(recorded.bone);
  double paused = -1, still = -1, began = -1;
  Clock::time_point fast;
  double passed = 0;
  watch_by(recorded, -1,
           {{"a second of it", [&] { return seen_.playing && seen_.shown > 1; },
             [] { press(SDLK_SPACE); }},
            {"the pause", [&] { return !seen_.playing; }, [&] { paused = seen_.t; }},
            {"a while", looks(20),
             [&] {
               still = seen_.t;
               for (int n = 0; n < 9; ++n) press(SDLK_PERIOD);
               press(SDLK_SPACE);
             }},
            {"the fastest pace", [&] { return seen_.playing && seen_.pace == 8; },
             [&] {
               began = seen_.t;
               fast = Clock::now();
             }},
            {"the end", [&] { return !seen_.playing; },
             [&] {
               passed = std::chrono::duration<double>(Clock::now() - fast).count();
               for (int n = 0; n < 9; ++n) press(SDLK_COMMA);
               press(SDLK_SPACE);
             }},
            {"the start, slowly", [&] { return seen_.playing && seen_.pace == 0.25; },
             [] { press(SDLK_q); }}});
  EXPECT_EQ(paused, still);
  EXPECT_LT(passed, kSeconds - began) << "faster than it happened";
  EXPECT_LT(seen_.t, 1) << "at the end, play begins again";
}

TEST_F(Replay, ScrubsByDraggingOnTheLineAndStepsByArrows) {
  Recorded recorded = open();
  ASSERT_TRUE(recorded.bone);
  // the line goes from 26 to 1254 of 1280 pixels
  const auto x_of = [](double t) {
    return 26 + static_cast<int>(std::lround(1228 * t / kSeconds));
  };
  double dragged = -1, held = -1, stepped = -1, stroke = -1;
  render::Camera before;
  bool turned = true;
  before = recorded.scene.camera;
  watch_by(recorded, 0,
           {{"the first picture", looks(5),
             [&] {
               move_to(x_of(3), 640);
               button(SDL_BUTTON_LEFT, true);
             }},
            {"the press", [&] { return std::abs(seen_.t - 3) < 0.02; },
             [&] {
               dragged = seen_.t;
               move_to(x_of(9), 300);  // out of the line: still held
             }},
            {"the drag", [&] { return std::abs(seen_.t - 9) < 0.02; },
             [&] {
               held = seen_.t;
               turned = !render::same(recorded.scene.camera, before);
               button(SDL_BUTTON_LEFT, false);
               press(SDLK_LEFT);
             }},
            {"a step", [&] { return seen_.t < held - 0.9; },
             [&] {
               stepped = seen_.t;
               press(SDLK_LEFT, KMOD_LCTRL);
             }},
            {"the stroke before", [&] { return seen_.t < stepped; },
             [&] {
               stroke = seen_.t;
               press(SDLK_q);
             }}});
  EXPECT_NEAR(dragged, 3, 0.02);
  EXPECT_NEAR(stepped, held - 1, 1e-9);
  EXPECT_FALSE(turned) << "who scrubs does not turn the bone";
  EXPECT_EQ(stroke, recorded.timeline.stroke_before(stepped - 0.5).value_or(0));
}

TEST_F(Replay, OpensADroppedRecordingAndComesBack) {
  pages_by({{"the start page", on(Page::start), [&] { drop(file_); }},
            {"the recording", on(Page::replay), nullptr},
            {"some pictures", looks(20), [] { press(SDLK_F1); }},
            {"the help", looks(5), [] { press(SDLK_ESCAPE); }},
            {"no help", looks(5), [] { press(SDLK_ESCAPE); }},
            {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  EXPECT_EQ(desk_->message, "");
}

TEST_F(Replay, TellsInOneSentenceWhatCannotBeWatched) {
  // a scan's recording without its scan
  std::string no_volume, garbage, missing;
  const fs::path alone = folder_ / "elsewhere" / "alone.mcap";
  fs::create_directories(alone.parent_path());
  {
    WorkOptions options;
    options.volume.source = scan().string();
    NoProgress quiet;
    auto ready = open_ready(options, quiet);
    ASSERT_TRUE(ready) << ready.error().text;
    Recording recording;
    ASSERT_TRUE(recording.start(*ready->session, alone.string(), ready->volume, ready->import,
                                "mouse", false));
    ready->session->start();
    SDL_Delay(300);
    ready->session->stop();
    ASSERT_TRUE(recording.finish(*ready->session));
  }
  fs::remove(folder_ / "Svensson Karin.nrrd");
  const fs::path torn = folder_ / "torn.mcap";
  fs::copy_file(file_, torn);
  fs::resize_file(torn, 900);  // in the middle of its beginning
  const auto said = [&](std::string& into) {
    return [&] {
      into = desk_->message;
      return desk_->page == Page::start && !into.empty();
    };
  };
  pages_by({{"the start page", on(Page::start), [&] { drop(alone); }},
            {"a sentence", said(no_volume),
             [&] {
               desk_->message.clear();
               drop(torn);
             }},
            {"a sentence", said(garbage),
             [&] {
               desk_->message.clear();
               drop(folder_ / "nowhere.mcap");
             }},
            {"a sentence", said(missing), [] { press(SDLK_ESCAPE); }}});
  EXPECT_NE(no_volume.find("was not found"), std::string::npos) << no_volume;
  EXPECT_NE(no_volume.find("beside the recording"), std::string::npos) << no_volume;
  EXPECT_NE(garbage.find("torn.mcap"), std::string::npos) << garbage;
  EXPECT_NE(missing.find("nowhere.mcap"), std::string::npos) << missing;
  for (const std::string* one : {&no_volume, &garbage, &missing})
    EXPECT_EQ(one->find('\n'), std::string::npos) << *one;
}

TEST_F(Replay, ShowsATornRecordingAsFarAsItGoesAndSaysSo) {
  const fs::path torn = folder_ / "torn.mcap";
  fs::copy_file(file_, torn);
  fs::resize_file(torn, fs::file_size(torn) / 2);
  file_ = torn;
  Recorded recorded = open();
  ASSERT_TRUE(recorded.bone);
  EXPECT_LT(recorded.timeline.seconds, kSeconds);
  EXPECT_GT(recorded.timeline.seconds, 1);
  EXPECT_FALSE(recorded.notices.empty());
  const double end = recorded.timeline.seconds;
  watch_by(recorded, 0,
           {{"the first picture", looks(5), [] { press(SDLK_END); }},
            {"the end", shows(end), [] { press(SDLK_q); }}});
}

}  // namespace
}  // namespace burr::app
