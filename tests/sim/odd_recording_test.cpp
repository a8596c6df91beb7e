// Impossible recordings and hand paths: refused with a sentence, never used.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "burr/device/replayed_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/sim/replay.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/servo.h"
#include "support/folder.h"

namespace burr::sim {
namespace {

using math::Vec3;

class Odd : public testing::Test {
 protected:
  const burr::test::Folder own_;
  const std::filesystem::path folder = own_.path();
};

std::unique_ptr<volume::Bone> slab() {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-4e-3), Vec3::Constant(4e-3), 0.5e-3), {}, phantom::slab(),
      8);
}

record::SessionInfo usual(const volume::Bone& bone) {
  record::SessionInfo info;
  SessionSettings settings;
  settings.servo.undo_bricks = 16;
  settings.surface.reserve_blocks = 64;
  describe(settings, {}, info);
  info.volume.content_hash = bone.content_hash();
  info.volume.grid = bone.grid();
  info.volume.tissues = bone.tissues();
  info.volume.recipe.reserve_bricks = 8;
  return info;
}

TEST_F(Odd, EverySettingThatNoSessionCanHaveHadIsNamed) {
  const record::SessionInfo info = usual(*slab());
  ASSERT_TRUE(settings_of(info, "s.mcap").ok());
  for (const auto& [name, value] : info.numbers) {
    // integers, counts and memory sizes must not be taken from these values
    for (const double odd : {1e300, -1e300, -1.0, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
      if (name == "spindle_rad_s" && odd == -1.0) continue;  // it means backwards
      if (name == "tool" && odd == -1.0) continue;           // it means a round burr
      record::SessionInfo wrong = info;
      wrong.numbers[name] = odd;
      const auto settings = settings_of(wrong, "s.mcap");
      ASSERT_FALSE(settings.ok()) << name << " " << odd;
      EXPECT_NE(settings.error().text.find("s.mcap: the session's setting " + name),
                std::string::npos)
          << settings.error().text;
    }
  }
}

// Recordings made before friction had a limit in a wedge are replayed without it.
TEST_F(Odd, ARecordingWithoutAWordOfTheWedgeHasNoLimitThere) {
  record::SessionInfo info = usual(*slab());
  EXPECT_EQ(settings_of(info, "s.mcap")->settings.servo.wedge, tick::ServoSettings{}.wedge);
  info.numbers.erase("wedge");
  const auto old = settings_of(info, "s.mcap");
  ASSERT_TRUE(old) << old.error().text;
  EXPECT_EQ(old->settings.servo.wedge, 0);
}

TEST_F(Odd, AReplayAsksForNoBrickThatIsNotThere) {
  for (const volume::BrickIndex brick : {-7, 1'000'000}) {
    const auto bone = slab();
    const std::string file = (folder / "s.mcap").string();
    record::Recorder recorder(1000);
    ASSERT_TRUE(recorder.start(file, usual(*bone), nullptr).ok());
    // one real tick, so that the replay comes as far as the brick
    NoProgress quiet;
    const auto recorded = settings_of(usual(*bone), "");
    ASSERT_TRUE(recorded.ok());
    device::ReplayedHand hand(recorded->device);
    device::HandState state;
    state.world_from_tool.p = {0, 0, 3e-3};
    hand.set(state);
    volume::IsoVertices surface(*bone, recorded->settings.surface, 1, quiet);
    tick::Servo servo(*bone, surface, hand, recorded->settings.servo);
    tick::BrickRow row;
    row.brick = brick;
    ASSERT_TRUE(recorder.bricks().push(row));
    ASSERT_TRUE(recorder.ticks().push(servo.tick(false)));
    ASSERT_TRUE(recorder.finish().ok());

    auto player = record::Player::open(file);
    ASSERT_TRUE(player.ok()) << player.error().text;
    const auto outcome = replay(**player, slab(), quiet);
    ASSERT_FALSE(outcome.ok());
    EXPECT_NE(outcome.error().text.find("which this bone does not have"), std::string::npos)
        << outcome.error().text;
  }
}

// All forces times a tenth with the hashes left: the simulated hashes are those in the file, the values are not.
TEST_F(Odd, ForcesThatWereChangedAreFoundThoughTheirHashesWereLeft) {
  for (const double factor : {1.0, 0.1}) {
    const auto bone = slab();
    const std::string file = (folder / "s.mcap").string();
    std::filesystem::remove(file);
    record::Recorder recorder(1000);
    ASSERT_TRUE(recorder.start(file, usual(*bone), nullptr).ok());
    NoProgress quiet;
    const auto recorded = settings_of(usual(*bone), "");
    ASSERT_TRUE(recorded.ok());
    device::ReplayedHand hand(recorded->device);
    volume::IsoVertices surface(*bone, recorded->settings.surface, 1, quiet);
    tick::Servo servo(*bone, surface, hand, recorded->settings.servo);
    device::HandState state;
    double felt = 0;
    for (int n = 0; n < 50; ++n) {
      state.world_from_tool.p = {0, 0, 3e-3 - 1e-4 * n};
      hand.set(state);
      tick::TickRow row = servo.tick(false);
      felt = std::max(felt, row.contact.force.norm());
      row.contact.force *= factor;
      ASSERT_TRUE(recorder.ticks().push(row));
    }
    ASSERT_TRUE(recorder.finish().ok());
    ASSERT_GT(felt, 0.1) << "the slab was not touched";
    auto player = record::Player::open(file);
    ASSERT_TRUE(player.ok()) << player.error().text;
    const auto outcome = replay(**player, slab(), quiet);
    ASSERT_TRUE(outcome.ok()) << outcome.error().text;
    EXPECT_EQ(outcome->first_different_tick.has_value(), factor != 1) << outcome->difference;
    if (factor != 1) {
      EXPECT_NE(outcome->difference.find("do not give the hash"), std::string::npos);
    }
  }
}

TEST_F(Odd, APathThatCannotBeMeantIsRefusedWithItsLine) {
  const auto refusal = [&](const std::string& text) {
    const std::string file = (folder / "p.csv").string();
    std::ofstream(file, std::ios::binary) << text;
    const auto path = surgeon::read_path(file);
    EXPECT_FALSE(path.ok()) << text;
    return path ? std::string() : path.error().text;
  };
  for (const char* line : {"-1e308,0,0,0\n1e308,0,0,0\n", "0,1e300,0,0\n", "0,0,0,-5000\n"})
    EXPECT_NE(refusal(std::string("t,x,y,z\n") + line).find("line 2: the time is beyond"),
              std::string::npos);
  // a quaternion this long has no length that fits into a double
  EXPECT_NE(refusal("t,x,y,z,qw,qx,qy,qz\n0,0,0,0,1e200,1e200,0,0\n").find("line 2"),
            std::string::npos);
  const std::string head = refusal("a\x1B[2J" + std::string(100'000, 'x') + "\n");
  EXPECT_LT(head.size(), 400U);
  EXPECT_EQ(head.find('\x1B'), std::string::npos);
  EXPECT_FALSE(surgeon::read_path("/dev/zero").ok()) << "a device never ends";
}

}  // namespace
}  // namespace burr::sim
