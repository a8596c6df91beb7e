// Data sets: numbers of 16 bits, crossings found in two ways, depth and labels of known shapes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "burr/dataset/crossings.h"
#include "burr/dataset/dataset.h"
#include "burr/dataset/eye.h"
#include "burr/dataset/hdf5_file.h"
#include "burr/dataset/raster.h"
#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/render/bone_scene.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"
#include "burr/volume/copy_of_bone.h"
#include "burr/workshop/recording.h"
#include "support/folder.h"

namespace burr::dataset {
namespace {

using math::Vec3;

// Bits of 16 to a number, written down from the standard and not from half_of().
double value_of(std::uint16_t half) {
  const int exponent = half >> 10 & 31, fraction = half & 1023;
  const double sign = (half & 0x8000) != 0 ? -1 : 1;
  if (exponent == 31) return fraction != 0 ? NAN : sign * INFINITY;
  if (exponent == 0) return sign * std::ldexp(fraction, -24);
  return sign * std::ldexp(1024 + fraction, exponent - 25);
}

TEST(Half, EveryNumberOf16BitsComesBack) {
  for (int bits = 0; bits < 0x10000; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const double value = value_of(half);
    if (std::isnan(value)) {
      EXPECT_TRUE(std::isnan(value_of(half_of(static_cast<float>(value)))));
    } else {
      ASSERT_EQ(half_of(static_cast<float>(value)), half) << value;
    }
  }
}

TEST(Half, TakesTheNearestAndOfTwoTheEven) {
  for (int bits = 0; bits < 0x7BFF; ++bits) {  // between two neighbours
    const auto half = static_cast<std::uint16_t>(bits), next = static_cast<std::uint16_t>(bits + 1);
    const double low = value_of(half), high = value_of(next);
    const auto middle = static_cast<float>((low + high) / 2);
    ASSERT_EQ(half_of(middle), (bits & 1) == 0 ? half : next) << middle;
    ASSERT_EQ(half_of(std::nextafter(middle, 0.0F)), half);
    ASSERT_EQ(half_of(std::nextafter(middle, 1e9F)), next);
  }
  EXPECT_EQ(value_of(half_of(65519.0F)), 65504);
  EXPECT_TRUE(std::isinf(value_of(half_of(65520.0F))));
  EXPECT_EQ(half_of(1e-10F), 0);
}

std::unique_ptr<volume::Bone> slab() {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-8e-3), Vec3::Constant(8e-3), 0.25e-3), {}, phantom::slab(),
      256);
}

// A pocket of four seconds, in a file that holds the bone; with an undo of what was cut at first.
std::string recorded(const test::Folder& folder, bool undo) {
  NoProgress quiet;
  sim::SessionSettings settings;
  settings.servo.burr.radius = 2e-3;
  settings.servo.undo_bricks = 2048;
  settings.surface.reserve_blocks = 1 << 13;
  auto path = surgeon::motion("pocket", {}, 2e-3, 4);
  auto session = sim::Session::make(
      slab(), std::make_unique<device::SimulatedHand>(*path, device::ArmSettings{}), settings,
      quiet);
  EXPECT_TRUE(session.ok()) << session.error().text;
  workshop::About about;
  about.format = "formula";
  about.motion = "pocket";
  about.embed = true;
  std::string file = folder / "s.mcap";
  auto recorder = workshop::record(**session, file, about);
  EXPECT_TRUE(recorder.ok()) << recorder.error().text;
  EXPECT_EQ((*session)->step(1500, quiet), 1500U);
  if (undo) (*session)->command({tick::CommandKind::undo, 0, {}});
  (*session)->step(2500, quiet);
  (*session)->settle();
  (*session)->set_recorder(nullptr);
  const auto account = (*recorder)->finish();
  EXPECT_TRUE(account.ok() && account->whole());
  return file;
}

using Counts = std::map<std::tuple<int, int, int>, int>;  // out minus in

Counts counts_of(const Crossings& found) {
  Counts counts;
  for (const sim::CrossedVoxel& voxel : found.voxels)
    counts[{voxel.i, voxel.j, voxel.k}] += voxel.out ? 1 : -1;
  std::erase_if(counts, [](const auto& one) { return one.second == 0; });
  return counts;
}

TEST(Crossings, AreTheDifferenceOfTheBonesAndAgreeInTwoWays) {
  for (const bool undo : {false, true}) {
    const test::Folder folder;
    const auto player = record::Player::open(recorded(folder, undo));
    ASSERT_TRUE(player.ok()) << player.error().text;
    NoProgress quiet;
    const auto before = slab();
    const auto exact = crossings_of(**player, *before, quiet);
    ASSERT_TRUE(exact.ok()) << exact.error().text;
    EXPECT_EQ(exact->late, "");
    const auto states = crossings_of_states(**player, *before);
    ASSERT_TRUE(states.ok()) << states.error().text;

    // counted voxel by voxel in the first and the last bone
    const auto after = volume::copy_of(*before);
    ASSERT_TRUE((*player)->bone_at((*player)->seconds(), *after).ok());
    Counts counted;
    const math::Ijk& size = before->grid().size;
    for (int k = 0; k < size.z(); ++k)
      for (int j = 0; j < size.y(); ++j)
        for (int i = 0; i < size.x(); ++i) {
          const int change = (before->field(i, j, k) >= volume::kIso ? 1 : 0) -
                             (after->field(i, j, k) >= volume::kIso ? 1 : 0);
          if (change != 0) counted[{i, j, k}] = change;
        }
    EXPECT_GT(counted.size(), 100U);
    EXPECT_EQ(counts_of(*exact), counted);
    EXPECT_EQ(counts_of(*states), counted);
    EXPECT_EQ(exact->after->content_hash(), after->content_hash());
    const auto came_back = [](const Crossings& found) {
      return std::any_of(found.voxels.begin(), found.voxels.end(),
                         [](const sim::CrossedVoxel& voxel) { return !voxel.out; });
    };
    EXPECT_EQ(came_back(*exact), undo);

    if (undo) continue;  // each voxel once: when?
    std::map<std::tuple<int, int, int>, std::uint64_t> left;
    for (const sim::CrossedVoxel& voxel : exact->voxels)
      left[{voxel.i, voxel.j, voxel.k}] = voxel.tick;
    for (const sim::CrossedVoxel& voxel : states->voxels) {
      const std::uint64_t tick = left.at({voxel.i, voxel.j, voxel.k});
      EXPECT_GE(voxel.tick, tick);
      EXPECT_LE(voxel.tick, tick + 100);
    }
  }
}

TEST(Crossings, WithAnotherBoneTheTimesAreSaidToBeLate) {
  const test::Folder folder;
  const auto player = record::Player::open(recorded(folder, false));
  ASSERT_TRUE(player.ok());
  NoProgress quiet;
  const auto other = slab();
  volume::Field* const field = other->build_field(other->brick_at(4, 4, 3));
  for (int v = 0; v < volume::kBrickVoxels; ++v) field[v] = volume::kSolid;  // a step in the slab
  const auto found = crossings_of(**player, *other, quiet);
  ASSERT_TRUE(found.ok()) << found.error().text;
  EXPECT_NE(found->late, "");
}

// A camera above, 60 mm away, that looks down at the origin.
record::View from_above() {
  record::View view;
  view.eye = {0, 0, 60e-3};
  return view;
}

TEST(Eye, ThePoseOfAmbfIsThatOfOpenCv) {
  record::View view = from_above();
  const math::Quat turn(Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()));
  view.right = turn * view.right;
  view.up = turn * view.up;
  view.back = turn * view.back;
  const Vec3 p = {4e-3, -7e-3, 2e-3};
  const Vec3 in_ambf = ambf_camera(view).inverse() * p;
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> cv_from_ambf(
      kCvFromAmbf.data());
  const Vec3 in_cv = (cv_from_ambf * in_ambf.homogeneous()).head<3>();
  const Vec3 from_eye = p - view.eye;
  EXPECT_NEAR(in_cv.x(), view.right.dot(from_eye), 1e-15);
  EXPECT_NEAR(in_cv.y(), -view.up.dot(from_eye), 1e-15);
  EXPECT_NEAR(in_cv.z(), -view.back.dot(from_eye), 1e-15);
}

TEST(Raster, AFlatBoneHasTheDepthOfAPlane) {
  NoProgress quiet;
  const auto bone = slab();  // its surface is z = 0
  render::Scene scene;
  ASSERT_TRUE(render::skin_bone(scene, *bone, 1, quiet).ok());
  Raster raster(64, 48);
  record::View view = from_above();
  raster.draw(scene, view, 0.15);
  EXPECT_NEAR(raster.depth()[64 * 24 + 32], 60e-3, 2e-6);
  for (const float depth : raster.depth()) ASSERT_NEAR(depth, 60e-3, 20e-6);
  for (const std::uint16_t label : raster.labels()) ASSERT_EQ(label, 1);
  // aslant: each pixel's ray meets the plane
  const math::Quat lean(Eigen::AngleAxisd(0.4, Vec3::UnitX()));
  for (Vec3* axis : {&view.right, &view.up, &view.back}) *axis = lean * *axis;
  view.eye = 60e-3 * view.back;
  raster.draw(scene, view, 0.1);
  const auto k = intrinsic(0.1, 64, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      const Vec3 ahead =
          (x + 0.5 - k[2]) / k[0] * view.right - (y + 0.5 - k[5]) / k[4] * view.up - view.back;
      const double depth = -view.eye.z() / ahead.z();
      ASSERT_NEAR(raster.depth()[static_cast<std::size_t>(64 * y + x)], depth, 30e-6);
    }
}

TEST(Raster, ABallHidesWhatIsBehindIt) {
  NoProgress quiet;
  const auto bone = slab();
  render::Scene scene;
  ASSERT_TRUE(render::skin_bone(scene, *bone, 1, quiet).ok());
  scene.burr.visible = true;
  scene.burr.radius = 2e-3;
  // its shaft points away from the camera, into the bone
  scene.burr.world_from_tool = {{1e-3, 1e-3, 10e-3},
                                math::Quat(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()))};
  Raster raster(200, 200);
  raster.draw(scene, from_above(), 0.25);
  const auto k = intrinsic(0.25, 200, 200);
  int tool = 0;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) {
      const auto at = static_cast<std::size_t>(200 * y + x);
      const Vec3 ray((x + 0.5 - k[2]) / k[0], -(y + 0.5 - k[5]) / k[4], -1);
      const Vec3 to = scene.burr.world_from_tool.p - from_above().eye;
      const double along = to.dot(ray) / ray.norm();
      const double off = std::sqrt(std::max(0.0, to.squaredNorm() - along * along));
      if (off < 1.97e-3) {
        ASSERT_EQ(raster.labels()[at], Raster::kTool);
        const double depth = (along - std::sqrt(4e-6 - off * off)) / ray.norm();
        ASSERT_NEAR(raster.depth()[at], depth, off < 1.5e-3 ? 15e-6 : 300e-6);
        ++tool;
      } else if (off > 2.03e-3) {
        ASSERT_EQ(raster.labels()[at], 1);
        ASSERT_NEAR(raster.depth()[at], 60e-3, 20e-6);
      }
    }
  EXPECT_GT(tool, 500);
}

TEST(Raster, NothingIsInfiniteAndBehindTheCameraIsNotSeen) {
  NoProgress quiet;
  const auto bone = slab();
  render::Scene scene;
  ASSERT_TRUE(render::skin_bone(scene, *bone, 1, quiet).ok());
  Raster raster(16, 16);
  record::View view = from_above();
  view.back = -view.back;  // looks up, away from the bone
  view.right = -view.right;
  raster.draw(scene, view, 0.2);
  for (const float depth : raster.depth()) ASSERT_TRUE(std::isinf(depth));
  for (const std::uint16_t label : raster.labels()) ASSERT_EQ(label, Raster::kNothing);
  // an eye that nearly touches the bone: triangles are cut at the near plane
  view = from_above();
  view.eye.z() = 1e-3;
  raster.draw(scene, view, 2.5);
  EXPECT_NEAR(raster.depth()[16 * 8 + 8], 1e-3, 1e-5);
}

TEST(FilesOf, CountSamplesAsTheyAreWritten) {
  const test::Folder folder;
  const auto player = record::Player::open(recorded(folder, false));
  ASSERT_TRUE(player.ok());
  Options options;
  EXPECT_EQ(files_of(**player, "a.hdf5", options), std::vector<std::string>{"a.hdf5"});
  options.samples_per_file = 200;  // 4 s, 50 a second
  EXPECT_EQ(files_of(**player, "a.hdf5", options), std::vector<std::string>{"a.hdf5"});
  options.samples_per_file = 199;
  EXPECT_EQ(files_of(**player, "d/a.b.h5", options),
            (std::vector<std::string>{"d/a.b_00001.h5", "d/a.b_00002.h5"}));
  for (const double fps : {7.0, 30.0, 50.0, 60.0}) {
    options.fps = fps;
    options.samples_per_file = 10;
    NoProgress quiet;
    const auto before = slab();
    const auto written = write(**player, *before, folder / "w.h5", options, quiet);
    ASSERT_TRUE(written.ok()) << written.error().text;
    EXPECT_EQ(written->samples, std::ceil(4 * fps));
    EXPECT_EQ(written->files, files_of(**player, folder / "w.h5", options));
    EXPECT_EQ(written->ticks, 4000U);
  }
}

TEST(Hdf5File, LeavesNothingWhereItCannotFinish) {
  const test::Folder folder;
  {
    Hdf5File file(folder / "no/such/folder.h5");
    file.numbers("/a/b", std::vector<double>{1}, {});
    const Status written = file.finish();
    ASSERT_FALSE(written.ok());
    EXPECT_EQ(written.error().trouble, Trouble::io);
  }
  {
    Hdf5File file(folder / "twice.h5");
    file.numbers("/a", std::vector<double>{1}, {});
    file.numbers("/a", std::vector<double>{1}, {});
    Column& later = file.column("/b", Kind::f64, {}, 4);
    const double one = 1;
    for (int n = 0; n < 9; ++n) later.add(&one);
    EXPECT_FALSE(file.finish().ok());
  }
  { Hdf5File file(folder / "forgotten.h5"); }
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
}

}  // namespace
}  // namespace burr::dataset
