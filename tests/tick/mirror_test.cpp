// Sculpting in a mirror in whole sessions: the servo obeys, one stroke goes back on both sides, the
// recording replays to the bit, and no tick takes memory or a lock. Planes by name.
#include "burr/tick/mirror_plane.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "burr/device/replayed_hand.h"
#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/servo.h"
#include "burr/volume/volume_of.h"
#include "support/folder.h"
#include "support/rt_guard.h"

namespace burr::tick {
namespace {

using edit::Mirror;
using math::Vec3;
using tick::CommandKind;
constexpr double kMm = 1e-3, kRadius = 1.5 * kMm, kVoxel = 0.25 * kMm;

std::unique_ptr<volume::Bone> slab() {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3(-8, -5, -5) * kMm, Vec3(8, 5, 6) * kMm, kVoxel), {}, phantom::slab(),
      512);
}

std::string odd(const volume::Bone& bone, const Mirror& mirror) {
  const math::Ijk& size = bone.grid().size;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        math::Ijk of(i, j, k);
        of[mirror.axis] = mirror.twice - of[mirror.axis];
        if (!bone.grid().contains(of)) continue;
        if (bone.field(i, j, k) != bone.field(of.x(), of.y(), of.z()) ||
            bone.tissue(i, j, k) != bone.tissue(of.x(), of.y(), of.z()))
          return std::to_string(i) + " " + std::to_string(j) + " " + std::to_string(k);
      }
  return {};
}

// A servo whose hand is held where it is told.
struct Held {
  Held()
      : bone(slab()),
        surface(*bone, {}, 1, quiet),
        hand({}),
        servo(*bone, surface, hand, {}),
        mirror(mirror_plane(bone->grid(), Plane::sagittal)) {
    command(CommandKind::burr_radius, kRadius);
    state.world_from_tool.p = {-3 * kMm, 0, 5 * kMm};
    state.pedal = 1;
    for (int n = 0; n < 300; ++n) tick();
    start = bone->content_hash();
    before = volume::volume_of(*bone);
  }
  void tick() {
    hand.set(state);
    row = servo.tick(false);
    servo.publish();
  }
  void go(const Vec3& to, double speed = 20 * kMm) {
    while ((to - state.world_from_tool.p).norm() > 1e-9) {
      const Vec3 way = to - state.world_from_tool.p;
      state.world_from_tool.p += way.normalized() * std::min(way.norm(), speed * 1e-3);
      tick();
    }
  }
  void command(CommandKind kind, double value = 0) { servo.commands().push({kind, value}); }
  void settle(CommandKind kind) {
    command(kind);
    do tick();
    while (servo.restoring());
  }
  void lift() {
    go({state.world_from_tool.p.x(), state.world_from_tool.p.y(), 5 * kMm});
    for (int n = 0; n < 400; ++n) tick();
  }

  NoProgress quiet;
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
  device::ReplayedHand hand;
  Servo servo;
  Mirror mirror;
  device::HandState state;
  TickRow row;
  std::uint64_t start = 0;
  double before = 0;
};

TEST(MirrorMode, EveryToolWorksOnBothSidesAndOneStrokeGoesBackOnBoth) {
  Held held;
  held.servo.commands().push(command_for(held.mirror));
  std::uint64_t last = held.start;
  for (const ToolMode mode : {ToolMode::cut, ToolMode::add, ToolMode::smooth, ToolMode::restore}) {
    SCOPED_TRACE(static_cast<int>(mode));
    held.command(CommandKind::tool_mode, static_cast<double>(mode));
    held.go({-3 * kMm, 0, 0.5 * kMm});
    held.go({-0.4 * kMm, 0.5 * kMm, 0.5 * kMm}, 6 * kMm);  // as far as the plane
    held.go({0.6 * kMm, 0.5 * kMm, 0.5 * kMm}, 6 * kMm);   // and across
    held.lift();
    const std::uint64_t now = held.bone->content_hash();
    ASSERT_NE(now, last);
    ASSERT_EQ(odd(*held.bone, held.mirror), "");
    const edit::Ledger is = held.row.ledger;
    EXPECT_NEAR(is.asked, is.removed + is.debt + is.not_cut, 1e-6 * is.asked);
    EXPECT_NEAR(volume::volume_of(*held.bone) - held.before, is.added - is.removed,
                1e-6 * is.removed);
    held.settle(CommandKind::undo);
    EXPECT_EQ(held.bone->content_hash(), last);
    held.settle(CommandKind::redo);
    EXPECT_EQ(held.bone->content_hash(), now);
    last = now;
  }
  held.settle(CommandKind::reset);
  EXPECT_EQ(held.bone->content_hash(), held.start);

  // and off again
  held.command(CommandKind::mirror_off);
  held.command(CommandKind::tool_mode, static_cast<double>(ToolMode::cut));
  held.lift();
  held.go({-3 * kMm, 0, 5 * kMm});
  held.go({-3 * kMm, 0, 0.5 * kMm});
  EXPECT_NE(odd(*held.bone, held.mirror), "");
}

TEST(MirrorMode, TheHandFeelsWhatItFeelsWithoutOne) {
  Held held, plain;
  held.servo.commands().push(command_for(held.mirror));
  for (Held* one : {&held, &plain}) {
    one->go({-3 * kMm, 0, 0.5 * kMm});
    for (int n = 0; n < 300; ++n) one->tick();
  }
  EXPECT_GT(plain.row.contact.force.norm(), 0.3);
  // the rounding of the ball to a thousandth of a voxel is all that differs
  EXPECT_LT((held.row.contact.force - plain.row.contact.force).norm(), 0.01);
  EXPECT_LT((held.row.contact.proxy - plain.row.contact.proxy).norm(), 2e-6);
  EXPECT_NEAR(held.row.ledger.removed, 2 * plain.row.ledger.removed,
              5e-3 * held.row.ledger.removed);
}

TEST(MirrorMode, TheTickTakesNeitherMemoryNorLock) {
  Held held;
  held.go({-2 * kMm, 0, 1.6 * kMm});
  const burr::test::RtGuard guard;
  held.servo.commands().push(command_for(held.mirror));
  held.state.world_from_tool.p.z() = 0.5 * kMm;
  for (int n = 0; n < 2000; ++n) {
    if (n % 400 == 399)
      held.command(CommandKind::tool_mode, n / 400 == 1 ? 4 : n / 400 == 2 ? 3 : 1);
    held.state.world_from_tool.p.x() = (-2 + 1e-3 * n) * kMm;
    held.tick();
  }
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
  EXPECT_NE(held.bone->content_hash(), held.start);
}

TEST(MirrorMode, ARecordingReplaysToTheBitAndHoldsEveryMoment) {
  const burr::test::Folder folder;
  const std::string file = folder / "s.mcap";
  NoProgress quiet;
  sim::SessionSettings settings;
  settings.servo.burr.radius = kRadius;
  settings.servo.undo_bricks = 2048;
  settings.surface.reserve_blocks = 1 << 13;
  auto path = surgeon::motion("pocket", {.at = {-1.5 * kMm, 0, 0}, .into = {0, 0, -1}}, kRadius, 3);
  ASSERT_TRUE(path.ok());
  auto made = sim::Session::make(
      slab(), std::make_unique<device::SimulatedHand>(*path, device::ArmSettings{}), settings,
      quiet);
  ASSERT_TRUE(made.ok()) << made.error().text;
  sim::Session& session = **made;
  record::SessionInfo info;
  sim::describe(session.settings(), session.hand().spec(), info);
  info.volume.content_hash = session.bone().content_hash();
  info.volume.grid = session.bone().grid();
  info.volume.tissues = session.bone().tissues();
  info.volume.recipe.reserve_bricks = 512;
  record::Recorder recorder(settings.servo.rate_hz);
  ASSERT_TRUE(recorder.start(file, info, &session.bone()).ok());
  session.set_recorder(&recorder);
  const Mirror first = mirror_plane(session.bone().grid(), Plane::sagittal);
  const Mirror then = mirror_plane(session.bone().grid(), Plane::coronal, Vec3(0, 0.4 * kMm, 0));
  session.command(command_for(first));
  session.run(1, quiet);
  EXPECT_EQ(odd(session.bone(), first), "");
  session.command(command_for(then));
  session.command({CommandKind::tool_mode, static_cast<double>(ToolMode::smooth)});
  session.run(0.7, quiet);
  session.command({CommandKind::undo, 0});
  session.command({CommandKind::mirror_off, 0});
  session.command({CommandKind::tool_mode, static_cast<double>(ToolMode::add)});
  session.run(1, quiet);
  session.set_recorder(nullptr);
  ASSERT_TRUE(recorder.finish().ok());

  auto player = record::Player::open(file);
  ASSERT_TRUE(player.ok()) << player.error().text;
  auto kept = slab();
  ASSERT_TRUE((*player)->bone_at(1e9, *kept));
  EXPECT_EQ(kept->content_hash(), session.bone().content_hash()) << "what was written down";
  const auto again = sim::replay(**player, slab(), quiet);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_FALSE(again->first_different_tick.has_value())
      << *again->first_different_tick << ": " << again->difference;
  EXPECT_EQ(again->bone->content_hash(), session.bone().content_hash());
}

// ---- planes by name

volume::Grid askew() {
  volume::Grid grid;
  grid.size = {100, 61, 40};
  grid.voxel = 0.5 * kMm;
  // i to the top, j to the right, k to the back; a little askew
  Eigen::Matrix3d axes;
  axes.col(0) = Vec3(0, 0, 1);
  axes.col(1) = Vec3(-1, 0, 0);
  axes.col(2) = Vec3(0, -1, 0);
  grid.frame.q = math::Quat(axes) * math::Quat(Eigen::AngleAxisd(0.2, Vec3(1, 2, 3).normalized()));
  grid.frame.p = {10 * kMm, 20 * kMm, 30 * kMm};
  return grid;
}

TEST(MirrorPlane, IsTheGridsNearestToThePatients) {
  const volume::Grid grid = askew();
  EXPECT_EQ(axis_of(grid, Plane::sagittal), 1);
  EXPECT_EQ(axis_of(grid, Plane::coronal), 2);
  EXPECT_EQ(axis_of(grid, Plane::axial), 0);
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(axis_of(grid, plane_of(grid, axis)), axis);
  EXPECT_EQ(mirror_plane(grid, Plane::sagittal), (Mirror{1, 60})) << "the middle is on a voxel";
  EXPECT_EQ(mirror_plane(grid, Plane::axial), (Mirror{0, 99})) << "the middle is between two";
  const Vec3 through = grid.world_from_grid({10, 17.3, 5});
  EXPECT_EQ(mirror_plane(grid, Plane::sagittal, through), (Mirror{1, 35}));
}

TEST(MirrorPlane, InWordsCountsToTheLeftBackAndTop) {
  const volume::Grid grid = askew();
  const auto left = mirror_in_words("sagittal,4", grid);
  ASSERT_TRUE(left) << left.error().text;
  EXPECT_EQ(*left, (Mirror{1, 60 - 16})) << "j goes to the right";
  EXPECT_NEAR(offset_of(grid, *left), 4 * kMm, 1e-12);
  const Vec3 on_it = grid.world_from_grid({50, left->place(), 20});
  const Vec3 middle = grid.world_from_grid({50, 30, 20});
  EXPECT_GT(on_it.x(), middle.x()) << "left is +x";
  EXPECT_EQ(*mirror_in_words("coronal", grid), (Mirror{2, 39}));
  EXPECT_NEAR(offset_of(grid, *mirror_in_words("axial,-3.1", grid)), -3 * kMm, 1e-12)
      << "the nearest half voxel";
  for (const char* wrong : {"", "sagital", "sagittal,", "sagittal,x", "sagittal,1,2", "axial,nan",
                            "coronal,1e9", "SAGITTAL"}) {
    const auto plane = mirror_in_words(wrong, grid);
    ASSERT_FALSE(plane) << wrong;
    EXPECT_EQ(plane.error().text.find("--"), std::string::npos) << plane.error().text;
  }
}

TEST(MirrorPlane, ACommandChoosesItAndAnImageIsTheToolAcross) {
  const volume::Grid grid = askew();
  for (const Mirror& mirror : {Mirror{}, Mirror{0, 33}, Mirror{1, 20}, Mirror{2, 71}}) {
    const auto back = mirror_of(command_for(mirror), grid.size);
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, mirror);
  }
  EXPECT_FALSE(mirror_of({CommandKind::undo, 0}, grid.size));
  EXPECT_FALSE(mirror_of({CommandKind::mirror_j, NAN}, grid.size));
  const Mirror mirror = {1, 41};
  math::Pose tool;
  tool.p = grid.world_from_grid({3, 4, 5});
  tool.q = math::Quat(Eigen::AngleAxisd(0.7, Vec3(3, 1, 2).normalized()));
  const math::Pose image = image_of(tool, grid, mirror);
  EXPECT_LT((grid.grid_from_world(image.p) - Vec3(3, 37, 5)).norm(), 1e-9);
  const Vec3 tip = grid.grid_from_world(tool.p + 1e-2 * (tool.q * Vec3::UnitZ()));
  const Vec3 other = grid.grid_from_world(image.p + 1e-2 * (image.q * Vec3::UnitZ()));
  EXPECT_LT((mirror.image_of(tip) - other).norm(), 1e-9);
}

}  // namespace
}  // namespace burr::tick
