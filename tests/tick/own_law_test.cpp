// A custom law in a session: what it may do, what it may not, and that a recording replays with it.
#include "burr/tick/own_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "burr/device/simulated_hand.h"
#include "burr/edit/bone_memory.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/rt/flags.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/servo.h"
#include "support/folder.h"
#include "support/rt_guard.h"

namespace burr::tick {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kDt = 1e-3;

// As a library would be, of which the test knows what it was asked.
class TestLaw final : public OwnLaw {
 public:
  using Does = std::function<int(const burr_law_in_v1&, burr_law_out_v1&)>;
  explicit TestLaw(Does does, std::string sha256 = "abc") : does_(std::move(does)) {
    about_ = {"compiled", "test.so", std::move(sha256), ""};
  }
  int answer(const burr_law_in_v1& in, burr_law_out_v1& out) BURR_RT override {
    ++asked;
    return does_(in, out);
  }
  Status begin() override {
    ++begun;
    return fine();
  }
  Status fit_for_real_time() const override {
    return fit ? fine() : Status(error(Trouble::usage, "not tried"));
  }
  LawAbout about() const override { return about_; }
  LawAbout about_;
  int asked = 0, begun = 0;
  bool fit = false;

 private:
  Does does_;
};

int as_burr(const burr_law_in_v1&, burr_law_out_v1&) { return 0; }

std::unique_ptr<volume::Bone> slab() {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), 0.25 * kMm), {},
      phantom::slab(), 256);
}

sim::SessionSettings settings_with(std::shared_ptr<OwnLaw> law) {
  sim::SessionSettings settings;
  settings.servo.burr.radius = 2 * kMm;
  settings.servo.undo_bricks = 1024;
  settings.surface.reserve_blocks = 1 << 13;
  settings.law = std::move(law);
  return settings;
}

std::unique_ptr<sim::Session> session(const sim::SessionSettings& settings,
                                      const char* how = "pocket", double seconds = 2,
                                      const device::ArmSettings& arm = {}) {
  NoProgress quiet;
  auto path = surgeon::motion(how, {}, 2 * kMm, seconds);
  EXPECT_TRUE(path.ok());
  auto made = sim::Session::make(slab(), std::make_unique<device::SimulatedHand>(*path, arm),
                                 settings, quiet);
  EXPECT_TRUE(made.ok()) << made.error().text;
  return std::move(*made);
}

std::unique_ptr<sim::Session> session(std::shared_ptr<OwnLaw> law, const char* how = "pocket",
                                      double seconds = 2) {
  return session(settings_with(std::move(law)), how, seconds);
}

TEST(OwnLaw, ThatChangesNothingIsBurrsOwnToTheBit) {
  const auto with = session(std::make_shared<TestLaw>(as_burr)), without = session(nullptr);
  double removed = 0;
  for (int n = 0; n < 2000; ++n) {
    const TickRow &a = with->servo().tick(false), &b = without->servo().tick(false);
    removed = b.ledger.removed;
    ASSERT_EQ(a.contact.force, b.contact.force) << n;
    ASSERT_EQ(a.ledger.removed, b.ledger.removed) << n;
    EXPECT_EQ(b.law.state, LawRow::kNone);
    with->servo().publish();
    without->servo().publish();
  }
  EXPECT_GT(removed, 0.1 * kMm * kMm * kMm);
  EXPECT_EQ(with->bone().content_hash(), without->bone().content_hash());
}

TEST(OwnLaw, GetsTheContactInSiAndItsForceReachesTheHand) {
  bool saw_bone = false;
  const auto law =
      std::make_shared<TestLaw>([&saw_bone](const burr_law_in_v1& in, burr_law_out_v1& out) {
        EXPECT_EQ(in.size, sizeof in);
        EXPECT_EQ(in.version, 1U);
        EXPECT_EQ(out.version, 1U);
        EXPECT_EQ(in.dt, kDt);
        EXPECT_EQ(in.radius, 2 * kMm);
        if (in.touching != 0) {
          saw_bone = true;
          EXPECT_NEAR(in.normal[2], 1, 1e-3) << "a slab";
          EXPECT_NEAR(in.proxy[2] - in.hand[2], in.depth, 1e-5);
          EXPECT_EQ(in.tissue, 1);
          EXPECT_EQ(in.price_j_m3, 1e9);
          EXPECT_NEAR(out.force[2], in.stiffness * in.depth, 0.1) << "burr's own answer";
        }
        for (int axis = 0; axis < 3; ++axis)
          out.force[axis] = 2 * in.stiffness * in.depth * in.normal[axis];
        return 0;
      });
  sim::SessionSettings settings = settings_with(law);
  settings.servo.mode = ToolMode::touch;
  const auto run = session(settings, "touch", 2, {.stiffness = INFINITY});
  int pressed = 0;
  for (int n = 0; n < 2000; ++n) {
    const TickRow& row = run->servo().tick(false);
    run->servo().publish();
    if (!row.contact.touching || row.contact.flags != 0) continue;
    ++pressed;
    EXPECT_NEAR(row.contact.force.norm(), 2 * 1000 * row.contact.depth, 1e-9);
    EXPECT_EQ(row.law.force, row.contact.force);
    EXPECT_EQ(row.law.state, LawRow::kActs);
  }
  EXPECT_GT(pressed, 100);
  EXPECT_TRUE(saw_bone);
}

TEST(OwnLaw, MayBeAsStrongAsItLikesAndTheHandGetsWhatTheLimitsLetPass) {
  const auto run = session(std::make_shared<TestLaw>([](const auto& in, auto& out) {
    for (int axis = 0; axis < 3; ++axis) out.force[axis] = in.touching ? 500 * in.normal[axis] : 0;
    return 0;
  }));
  double last = 0, most = 0;
  for (int n = 0; n < 2000; ++n) {
    const double now = run->servo().tick(false).contact.force.norm();
    run->servo().publish();
    EXPECT_LE((now - last) / kDt, run->settings().servo.limit.slew + 1e-6);
    last = now;
    most = std::max(most, now);
  }
  EXPECT_LE(most, run->settings().servo.limit.user_force + 1e-9);
  EXPECT_GT(most, 1);
}

// Each way to fail, 0.8 s into the work: the force fades within 5 ms and stays away; nothing is cut any more.
TEST(OwnLaw, ThatGivesWhatCannotBeIsSwitchedOff) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  using Fails = std::function<int(burr_law_out_v1&)>;
  const std::pair<const char*, Fails> kAll[] = {
      {"force NaN", [](auto& out) { return out.force[1] = kNan, 0; }},
      {"force infinite", [](auto& out) { return out.force[0] = -kInf, 0; }},
      {"force too large", [](auto& out) { return out.force[2] = 1.1 * BURR_LAW_MOST_FORCE, 0; }},
      {"energy NaN", [](auto& out) { return out.energy_j = kNan, 0; }},
      {"energy too large", [](auto& out) { return out.energy_j = 2, 0; }},
      {"torque NaN", [](auto& out) { return out.torque_nm = kNan, 0; }},
      {"torque below 0", [](auto& out) { return out.torque_nm = -1e-3, 0; }},
      {"cannot answer", [](auto&) { return 1; }},
  };
  for (const auto& [name, fails] : kAll) {
    SCOPED_TRACE(name);
    int ticks = 0;
    const auto law = std::make_shared<TestLaw>(
        [&ticks, how = fails](const auto&, auto& out) { return ticks > 800 ? how(out) : 0; });
    const auto run = session(law);
    double removed = 0;
    for (; ticks <= 2000; ++ticks) {
      const TickRow& row = run->servo().tick(false);
      run->servo().publish();
      ASSERT_TRUE(row.contact.force.allFinite()) << ticks;
      if (ticks == 800) removed = row.ledger.removed;
      if (ticks <= 800) {
        EXPECT_EQ(row.contact.flags & rt::kFlagLaw, 0U);
        continue;
      }
      EXPECT_NE(row.contact.flags & rt::kFlagLaw, 0U) << ticks;
      EXPECT_NE(row.law.state, LawRow::kActs);
      if (ticks > 806) {
        EXPECT_EQ(row.contact.force.norm(), 0) << ticks;
      }
    }
    const int asked = law->asked;
    EXPECT_LE(asked, 802) << "it is not asked again";
    EXPECT_GT(removed, 0);
    // what was owed from before may still go while the force fades
    EXPECT_LT(run->servo().tick(false).ledger.removed, 1.05 * removed);
  }
}

TEST(OwnLaw, RemovesNoMoreThanItPaysFor) {
  for (const double paid : {0.0, 2e-4, 1.0}) {  // a tick [J]; the motor gives 60 mJ
    SCOPED_TRACE(paid);
    const auto run = session(std::make_shared<TestLaw>([paid](const auto&, auto& out) {
      out.energy_j = paid;
      return 0;
    }));
    double spent = 0, of_motor = 0;
    const TickRow* row = nullptr;
    for (int n = 0; n < 2000; ++n) {
      row = &run->servo().tick(false);
      run->servo().publish();
      spent += row->law.energy;
      of_motor += 60 * kDt;
      EXPECT_LE(row->cutting_w, 60 + 1e-9);
    }
    const double price = 1e9;  // of the slab [J/m^3]
    EXPECT_LE(row->ledger.removed, std::min(spent, of_motor) / price + 1e-15);
    EXPECT_LE(row->ledger.energy, std::min(spent, of_motor) + 1e-12);
    if (paid == 0) {
      EXPECT_EQ(row->ledger.removed, 0);
    } else {
      EXPECT_GT(row->ledger.removed, 0.01 * kMm * kMm * kMm);
    }
  }
}

TEST(OwnLaw, BurrTakesNoMemoryInATickWithIt) {
  const auto run = session(std::make_shared<TestLaw>([](const auto&, auto& out) {
    out.energy_j = 2e-4;
    return 0;
  }));
  const burr::test::RtGuard guard;
  for (int n = 0; n < 1500; ++n) {
    static_cast<void>(run->servo().tick(false));
    run->servo().publish();
  }
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

TEST(OwnLaw, InRealTimeOnlyWhereItIsFitForIt) {
  NoProgress quiet;
  const auto law = std::make_shared<TestLaw>(as_burr);
  sim::SessionSettings settings = settings_with(law);
  settings.realtime = true;
  const auto make = [&] {
    return sim::Session::make(slab(),
                              std::make_unique<device::SimulatedHand>(
                                  *surgeon::motion("touch", {}, 2 * kMm, 1), device::ArmSettings{}),
                              settings, quiet);
  };
  const auto refused = make();
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().text, "not tried");
  law->fit = true;
  EXPECT_TRUE(make().ok());
}

TEST(OwnLaw, BeginsAnewWithItsSession) {
  const auto law = std::make_shared<TestLaw>(as_burr);
  const auto run = session(law);
  EXPECT_EQ(law->begun, 1);
  ASSERT_TRUE(run->reset_to({}).ok());
  EXPECT_EQ(law->begun, 2);
}

// ---- recordings

void record(sim::Session& run, const std::string& file) {
  NoProgress quiet;
  record::SessionInfo info;
  sim::describe(run.settings(), run.hand().spec(), info);
  info.volume.content_hash = run.bone().content_hash();
  info.volume.grid = run.bone().grid();
  info.volume.tissues = run.bone().tissues();
  info.volume.recipe.reserve_bricks = 256;
  record::Recorder recorder(1000);
  ASSERT_TRUE(recorder.start(file, info, &run.bone()).ok());
  run.set_recorder(&recorder);
  run.step(2000, quiet);
  run.settle();
  run.set_recorder(nullptr);
  ASSERT_TRUE(recorder.finish().ok());
}

Result<sim::ReplayOutcome> again(const std::string& file, OwnLaw* law) {
  NoProgress quiet;
  auto player = record::Player::open(file);
  EXPECT_TRUE(player.ok());
  auto bone = (*player)->embedded_bone(256);
  EXPECT_TRUE(bone.ok());
  return sim::replay(**player, std::move(*bone), quiet, nullptr, law);
}

// With a memory: what it answers depends on what it was asked before.
TestLaw::Does slow_spring() {
  return [before = 0.0](const auto& in, auto& out) mutable {
    before += 0.3 * (1.5 * in.stiffness * in.depth - before);
    for (int axis = 0; axis < 3; ++axis) out.force[axis] = before * in.normal[axis];
    out.energy_j = 2e-4;
    out.torque_nm = 1e-5;
    return 0;
  };
}

TEST(OwnLawRecorded, ReplaysToTheBitWithTheSameFileAndNoOther) {
  const burr::test::Folder folder;
  const std::string file = folder / "s.mcap";
  const auto run = session(std::make_shared<TestLaw>(slow_spring()));
  record(*run, file);

  TestLaw same(slow_spring()), liar(as_burr), other(slow_spring(), "def");
  const auto good = again(file, &same);
  ASSERT_TRUE(good.ok()) << good.error().text;
  EXPECT_FALSE(good->first_different_tick) << good->difference;
  EXPECT_EQ(good->ticks, 2000U);
  EXPECT_EQ(good->bone->content_hash(), run->bone().content_hash());

  const auto parted = again(file, &liar);
  ASSERT_TRUE(parted.ok());
  ASSERT_TRUE(parted->first_different_tick);
  EXPECT_NE(parted->difference.find("another answer of the own law"), std::string::npos);

  const auto none = again(file, nullptr);
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().text.find("give that file with `law`"), std::string::npos);
  const auto refused = again(file, &other);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().text.find("was made with another law"), std::string::npos);
  same.about_.settings_sha256 = "123";
  EXPECT_FALSE(again(file, &same).ok()) << "other settings";
}

TEST(OwnLawRecorded, OfPythonIsNotAskedAgain) {
  const burr::test::Folder folder;
  const std::string file = folder / "s.mcap";
  // off at the end, which must come out the same too
  int n = 0;
  const auto law =
      std::make_shared<TestLaw>([&n, slow = slow_spring()](const auto& in, auto& out) mutable {
        return ++n > 1500 ? 1 : slow(in, out);
      });
  law->about_ = {"python", "f", "", ""};
  const auto run = session(law);
  record(*run, file);
  const auto good = again(file, nullptr);
  ASSERT_TRUE(good.ok()) << good.error().text;
  EXPECT_FALSE(good->first_different_tick)
      << *good->first_different_tick << ": " << good->difference;
  EXPECT_EQ(good->ticks, 2000U);
  EXPECT_EQ(good->bone->content_hash(), run->bone().content_hash());
  EXPECT_NE(run->outcome().flags & rt::kFlagLaw, 0U);
  TestLaw other(as_burr);
  EXPECT_FALSE(again(file, &other).ok());
}

TEST(OwnLawRecorded, ARecordingWithoutOneTakesNone) {
  const burr::test::Folder folder;
  const std::string file = folder / "s.mcap";
  const auto run = session(nullptr);
  record(*run, file);
  TestLaw law(as_burr);
  const auto refused = again(file, &law);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().text.find("leave out `law`"), std::string::npos);
  EXPECT_TRUE(again(file, nullptr).ok());
}

}  // namespace
}  // namespace burr::tick
