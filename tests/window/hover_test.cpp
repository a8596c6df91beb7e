// The mouse's hand without its button: wherever the pointer goes, and however fast, the burr is in
// free air in front of what is seen, and nothing pushes it. Without a window: the picture's ray, the
// hand and the servo's ticks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "burr/device/replayed_hand.h"
#include "burr/mouse/mouse_aim.h"
#include "burr/render/pick.h"
#include "burr/rt/flags.h"
#include "burr/sim/session.h"
#include "burr/volume/sample.h"
#include "burr/workshop/live_surface.h"
#include "shared/window_session.h"
#include "shared/work.h"

namespace burr::app {
namespace {

using math::Vec3;
constexpr int kWidth = 1280, kHeight = 720, kTicksPerPicture = 16;

struct Bench {
  WindowSession ready;
  mouse::MouseAim aim;
  tick::TickRow row;

  static std::optional<Bench> of(const std::string& name, double voxel_mm) {
    WorkOptions options;
    options.volume.source = name;
    options.volume.voxel_mm = voxel_mm;
    NoProgress quiet;
    if (const Status taken = take_case(options); !taken) return std::nullopt;
    auto work = open_work(options, quiet);
    if (!work) return std::nullopt;
    auto ready = make_window_session(options, std::move(*work), quiet);
    if (!ready) return std::nullopt;
    const double voxel = ready->session->bone().grid().voxel;
    return Bench{std::move(*ready), mouse::MouseAim(voxel), {}};
  }

  [[nodiscard]] const Vec3& burr() const { return row.contact.proxy; }
  void tick() {
    row = ready.session->servo().tick(false);
    ready.scene.burr.world_from_tool = {row.contact.proxy, row.hand.world_from_tool.q};
  }
  void picture(double x, double y, const std::optional<mouse::MouseAim::Push>& push) {
    ready.scene.burr.radius = ready.session->servo().burr_radius();
    const render::Ray eye = render::ray_through(ready.scene.camera, x, y, kWidth, kHeight);
    ready.hands.mouse->aim(aim.at(ready.scene, eye, push, false));
  }
  // Whether bone lies between the eye and the middle of the burr, by the voxels: nothing here is
  // computed from them. Half a voxel is left to the difference between the field and its surface.
  [[nodiscard]] bool behind() const {
    constexpr double kInBone = 0.5 + 0.5 / 4;  // the field rises by a quarter a voxel
    const volume::Bone& bone = ready.session->bone();
    const Vec3 eye = ready.scene.camera.eye(), way = burr() - eye;
    const double step = bone.grid().voxel / 2;
    // the last 20 cm are longer than every bone here
    for (double far = std::max(0.0, way.norm() - 0.2); far < way.norm(); far += step)
      if (volume::sample(bone, bone.grid().grid_from_world(eye + far * way.normalized())) > kInBone)
        return true;
    return false;
  }
  // Whether the burr, with some air, fits around this point, by the voxels.
  [[nodiscard]] bool has_room_at(const Vec3& p) const {
    const volume::Bone& bone = ready.session->bone();
    const double reach = ready.session->servo().burr_radius() + 3 * bone.grid().voxel;
    for (int i = 0; i < 27; ++i) {
      const Vec3 way(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const Vec3 at = i == 13 ? p : Vec3(p + reach * way.normalized());
      if (volume::sample(bone, bone.grid().grid_from_world(at)) > 0.5) return false;
    }
    return true;
  }
};

struct Found {
  int behind = 0, ticks = 0, pictures = 0, on_bone = 0, astray = 0;
  double most_force = 0;
};

// The pointer goes from place to place in the picture, each way in one to 30 pictures; the view
// turns and zooms now and then.
Found wander(Bench& bench, int moves, std::mt19937_64& random) {
  std::uniform_real_distribution<double> at(0, 1);
  render::Camera& camera = bench.ready.scene.camera;
  const double view = camera.distance;
  Found found;
  double x = 0, y = 0;
  bool behind = false;
  Vec3 before = Vec3::Zero();
  for (int move = 0; move < moves; ++move) {
    if (move % 50 == 0) {
      camera.distance = view * (0.25 + 0.5 * at(random));
      render::orbit(camera, at(random) - 0.5, at(random) - 0.5);
      // an eye in the bone sees no place for the burr in front of it
      while (!bench.has_room_at(camera.eye())) camera.distance *= 1.05;
    }
    const double from_x = x, from_y = y, to_x = kWidth * at(random), to_y = kHeight * at(random);
    const int pictures = static_cast<int>(std::exp(at(random) * at(random) * std::log(31.0)));
    for (int n = 1; n <= pictures; ++n, ++found.pictures) {
      x = from_x + (to_x - from_x) * n / pictures;
      y = from_y + (to_y - from_y) * n / pictures;
      bench.picture(x, y, {});
      for (int t = 0; t < kTicksPerPicture; ++t, ++found.ticks) {
        bench.tick();
        found.most_force = std::max(found.most_force, bench.row.contact.force.norm());
        if (bench.burr() != before) behind = bench.behind();
        before = bench.burr();
        if (behind) ++found.behind;
      }
      const render::Ray eye = render::ray_through(camera, x, y, kWidth, kHeight);
      if (render::pick(bench.ready.scene, eye)) ++found.on_bone;
      if ((bench.burr() - eye.origin).cross(eye.direction).norm() > 1e-9) ++found.astray;
    }
  }
  return found;
}

class Hover : public testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(Hover, TheBurrFollowsInFrontOfWhatIsSeenAndNothingPushesIt) {
  const auto [name, voxel_mm] = GetParam();
  const char* given = std::getenv("BURR_SEED");
  const std::uint64_t seed =
      given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device()();
  SCOPED_TRACE(testing::Message() << name << ", seed " << seed);
  std::mt19937_64 random(seed);
  auto bench = Bench::of(name, voxel_mm);
  ASSERT_TRUE(bench);
  const Found found = wander(*bench, 2000, random);
  EXPECT_EQ(found.behind, 0) << "of " << found.ticks << " ticks";
  EXPECT_EQ(found.astray, 0) << "of " << found.pictures << " pictures it was not at the pointer";
  EXPECT_LT(found.most_force, 0.05);
  EXPECT_GT(found.on_bone, found.pictures / 5) << "too little bone in the picture to test anything";
}
INSTANTIATE_TEST_SUITE_P(Bones, Hover,
                         testing::Values(std::pair{"temporal-bone", 1.0}, std::pair{"jaw", 1.0},
                                         std::pair{"tooth", 0.4}, std::pair{"spine", 1.0},
                                         std::pair{"block", 1.0}),
                         [](const auto& one) {
                           std::string name = one.param.first;
                           std::erase(name, '-');
                           return name;
                         });

// Puts the middle of the picture on bone, a little off the work place.
void aim_at_work(Bench& bench) {
  bench.ready.scene.camera.distance *= 0.5;
  bench.picture(0.5 * kWidth, 0.5 * kHeight, {});
  for (int t = 0; t < kTicksPerPicture; ++t) bench.tick();
}

TEST(HoverHand, PressedItMillsAndLetGoInTheBoneItIsInFrontOfItAtOnce) {
  auto bench = Bench::of("temporal-bone", 1.0);
  ASSERT_TRUE(bench);
  aim_at_work(*bench);
  ASSERT_EQ(bench->row.ledger.removed, 0);
  for (int n = 0; n < 60; ++n) {
    bench->picture(0.5 * kWidth, 0.5 * kHeight, mouse::MouseAim::Push{4e-3, 1});
    for (int t = 0; t < kTicksPerPicture; ++t) bench->tick();
  }
  EXPECT_GT(bench->row.contact.force.norm(), 0.2);
  EXPECT_GT(bench->row.ledger.removed, 1e-9);
  EXPECT_TRUE(bench->row.contact.touching);
  // the pointer is elsewhere when the button goes up; the burr was still in its hole
  bench->picture(0.42 * kWidth, 0.45 * kHeight, {});
  bench->tick();
  EXPECT_EQ(bench->row.contact.force.norm(), 0);
  EXPECT_FALSE(bench->row.contact.touching);
  EXPECT_FALSE(bench->behind());
  EXPECT_TRUE(bench->ready.session->servo().released() == false) << "it can press again at once";
}

TEST(HoverHand, InAHoleAsWideAsItselfTheBurrStaysWhenItIsLifted) {
  auto bench = Bench::of("block", 0.5);
  ASSERT_TRUE(bench);
  render::Camera& camera = bench->ready.scene.camera;
  camera.elevation = 1.5;  // straight into the hole
  aim_at_work(*bench);
  for (int n = 0; n < 250; ++n) {
    bench->picture(0.5 * kWidth, 0.5 * kHeight, mouse::MouseAim::Push{6e-3, 1});
    for (int t = 0; t < kTicksPerPicture; ++t) bench->tick();
    bench->ready.worker->settle(
        [&](const surface::Skin& skin) { workshop::put_skin(bench->ready.scene, skin); });
  }
  const Vec3 bottom = bench->burr();
  const double radius = bench->ready.scene.burr.radius;
  bench->picture(0.5 * kWidth, 0.5 * kHeight, {});
  for (int t = 0; t < kTicksPerPicture; ++t) bench->tick();
  EXPECT_LT((bench->burr() - bottom).norm(), radius) << "it need not climb out to go on";
  EXPECT_EQ(bench->row.contact.force.norm(), 0);
  EXPECT_FALSE(bench->behind());
  // the pointer goes elsewhere: so does the burr
  bench->picture(0.7 * kWidth, 0.5 * kHeight, {});
  bench->tick();
  EXPECT_GT((bench->burr() - bottom).norm(), 2 * radius);
  EXPECT_FALSE(bench->behind());
}

TEST(HoverHand, ASessionOfMovesPressesAndUndoReplaysToTheBit) {
  const char* given = std::getenv("BURR_SEED");
  const std::uint64_t seed =
      given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device()();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937_64 random(seed);
  auto bench = Bench::of("jaw", 1.0);
  ASSERT_TRUE(bench);
  bench->ready.scene.camera.distance *= 0.4;
  std::uniform_real_distribution<double> at(0.3, 0.7);
  std::vector<tick::TickRow> rows;
  std::vector<std::pair<std::size_t, tick::Command>> commands;
  double hovering_force = 0;
  for (int move = 0; move < 60; ++move) {
    const double x = kWidth * at(random), y = kHeight * at(random);
    const bool presses = move % 3 == 1;
    if (move % 9 == 8) {
      commands.emplace_back(rows.size(), tick::Command{tick::CommandKind::undo, 0});
      bench->ready.session->command(commands.back().second);
    }
    for (int n = 0; n < (presses ? 12 : 4); ++n) {
      bench->picture(x, y, presses ? std::optional(mouse::MouseAim::Push{4e-3, 1}) : std::nullopt);
      for (int t = 0; t < kTicksPerPicture; ++t) {
        bench->tick();
        rows.push_back(bench->row);
        if (!presses) hovering_force = std::max(hovering_force, bench->row.contact.force.norm());
      }
    }
  }
  EXPECT_GT(rows.back().ledger.removed, 0);
  EXPECT_GT(rows.back().ledger.undone, 0);
  EXPECT_LT(hovering_force, 0.05) << "also while strokes are undone";
  int jumps = 0;
  for (const tick::TickRow& row : rows) jumps += (row.contact.flags & rt::kFlagJump) != 0 ? 1 : 0;
  EXPECT_EQ(jumps, 0) << "to be set down elsewhere is no wrong reading";

  auto again = Bench::of("jaw", 1.0);
  ASSERT_TRUE(again);
  const sim::SessionSettings settings = again->ready.session->settings();
  auto owned = std::make_unique<device::ReplayedHand>(bench->ready.session->hand().spec());
  device::ReplayedHand& hand = *owned;
  NoProgress quiet;
  auto made =
      sim::Session::make(again->ready.session->bone_before(), std::move(owned), settings, quiet);
  ASSERT_TRUE(made);
  std::size_t next = 0;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    for (; next < commands.size() && commands[next].first == n; ++next)
      (*made)->command(commands[next].second);
    hand.set(rows[n].hand);
    ASSERT_EQ((*made)->servo().tick(false).hash, rows[n].hash) << "tick " << n;
  }
}

}  // namespace
}  // namespace burr::app
