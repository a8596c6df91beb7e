// Cutting with tools of any shape, compared with closed forms: docs/understand/cutting.md, "Tools
// of any shape". The tool is moved by the test, without touch.
#include "burr/edit/tool_body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "burr/base/hash.h"
#include "burr/edit/carve.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/rt/simd.h"
#include "burr/scenario/rack.h"
#include "burr/volume/sample.h"
#include "burr/volume/volume_of.h"
#include "support/mesh.h"
#include "support/rt_guard.h"

namespace burr::edit {
namespace {

using math::Pose;
using math::Quat;
using math::Vec3;
using tool::Role;
using tool::Shape;
using tool::ShapeKind;
constexpr double kMm = 1e-3;

tool::Tool one_part(const Shape& shape, const Pose& at = {}) {
  tool::Tool tool;
  EXPECT_TRUE(tool::add_part(tool, {shape, at, Role::cuts}));
  return tool;
}

// A bone and its carver. bare: margin and advance are 0, so the hole has the shape of the tool.
struct Work {
  Work(const phantom::Depth& depth, double h_mm, double half_mm, bool bare = true)
      : h(h_mm * kMm),
        bone(phantom::bone_from_distance(
            phantom::box_grid(Vec3::Constant(-half_mm * kMm), Vec3::Constant(half_mm * kMm), h), {},
            depth)),
        surface(*bone, {}, 1, quiet),
        undo(*bone, 4096),
        changed(*bone),
        writer(*bone, surface, undo, &changed),
        carver(writer, settings(bare)) {
    undo.begin_stroke(0);
  }
  static CarveSettings settings(bool bare) {
    if (!bare) return {};
    return {.advance_m = 0,
            .advance_least = 0,
            .margin_m = 0,
            .margin_least = 0,
            .margin_most = 0,
            .debt_timeout = 1e3};
  }
  // Removes all that is inside the tool there, whatever energy that takes.
  void cut_all(const tool::Tool& tool, const Pose& world_from_tool, Sweep sweep = Sweep::even,
               const Mirror& mirror = {}) {
    ToolBody body = cutting_body(tool, h);
    const volume::Grid& grid = bone->grid();
    body.grid_from_tool = {grid.grid_from_world(world_from_tool.p),
                           grid.frame.q.conjugate() * world_from_tool.q};
    body.sweep = sweep;
    std::uint32_t flags = 0;
    Cut cut;
    cut.body = &body;
    cut.energy = 1e6;
    cut.mirror = mirror;
    carver.carve(cut, flags);
  }
  [[nodiscard]] double volume() const { return volume::volume_of(*bone); }

  double h;
  NoProgress quiet;
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
  UndoStore undo;
  ChangedQueue changed;
  BoneWriter writer;
  Carver carver;
};

class CarveShapes : public testing::TestWithParam<double> {};  // voxel [mm]

// A block of half width 2 mm along y, 5 mm along x, top at z = 0.
phantom::Depth bar() {
  return [](const Vec3& p) {
    const Vec3 q(std::abs(p.x()) - 5 * kMm, std::abs(p.y()) - 2 * kMm,
                 std::abs(p.z() + 3 * kMm) - 3 * kMm);
    const Vec3 out = q.cwiseMax(0.0);
    return -(out.norm() + std::min(0.0, q.maxCoeff()));
  };
}

const Quat kTurned = Quat(Eigen::AngleAxisd(0.31, Vec3(0.3, -0.2, 0.93).normalized()));

TEST_P(CarveShapes, ASideMillTakesTheSegmentOfItsCircle) {
  // a cylinder of radius 2 mm lies along y across the bar, 0.8 mm deep
  const double a = 2 * kMm, d = 0.8 * kMm, wide = 4 * kMm;
  Work work(bar(), GetParam(), 7);
  const double before = work.volume();
  const tool::Tool mill = one_part({ShapeKind::cylinder, a - 0.1 * kMm, 0, 5 * kMm, 0.1 * kMm});
  const Quat lying(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()));
  work.cut_all(mill, {Vec3(0.1 * kMm, 0, a - d), lying});
  const double want =
      wide * (a * a * std::acos(1 - d / a) - (a - d) * std::sqrt(2 * a * d - d * d));
  EXPECT_NEAR(before - work.volume(), want, 0.015 * want);
  EXPECT_NEAR(work.carver.ledger().removed, before - work.volume(), 1e-9 * want);
}

TEST_P(CarveShapes, ASideMillThatIsAMeshTakesTheSameSegment) {
  const double a = 2 * kMm, d = 0.8 * kMm, wide = 4 * kMm;
  Work work(bar(), GetParam(), 7);
  const double before = work.volume();
  const tool::Tool mill = one_part(test::cylinder_grid(a, 5 * kMm, 0.15 * kMm));
  ASSERT_EQ(mill.count, 1);
  const Quat lying(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()));
  work.cut_all(mill, {Vec3(0.1 * kMm, 0, a - d), lying});
  const double want =
      wide * (a * a * std::acos(1 - d / a) - (a - d) * std::sqrt(2 * a * d - d * d));
  EXPECT_NEAR(before - work.volume(), want, 0.015 * want);
}

TEST_P(CarveShapes, ASawLeavesAKerfAsWideAsItsTeeth) {
  // teeth 0.9 mm thick, blade 0.6 mm; goes 3 mm deep into the bar, along y
  const double kerf = 0.9 * kMm, depth = 3 * kMm;
  tool::Tool saw = one_part({ShapeKind::box, 0.4 * kMm, 5 * kMm, 0.45 * kMm, 0.05 * kMm});
  ASSERT_TRUE(tool::add_part(saw, {{ShapeKind::box, 0.3 * kMm, 5 * kMm, 8 * kMm, 0},
                                   {Vec3(0, 0, 8.5 * kMm), Quat::Identity()},
                                   Role::rubs}));
  Work work(bar(), GetParam(), 7);
  const double before = work.volume();
  for (double z = 0; z <= depth; z += 0.1 * kMm)
    work.cut_all(saw, {Vec3(0.03 * kMm, 0, 0.5 * kMm - z), Quat::Identity()});
  const double want = kerf * depth * 4 * kMm;
  EXPECT_NEAR(before - work.volume(), want, 0.015 * want);
  // the walls stand a kerf apart
  const auto wall = [&](double way) {
    double inside = 2 * kMm, outside = 0;
    for (int n = 0; n < 40; ++n) {
      const double x = 0.5 * (inside + outside);
      const Vec3 p =
          work.bone->grid().grid_from_world(Vec3(0.03 * kMm + way * x, 0.1 * kMm, -1.5 * kMm));
      (volume::sample(*work.bone, p) > 0.5 ? inside : outside) = x;
    }
    return inside;
  };
  EXPECT_NEAR(wall(1) + wall(-1), kerf, 0.1 * work.h);
}

TEST_P(CarveShapes, AFlameLeavesItsOwnHollow) {
  // a flame (vesica) 3 mm wide, 10 mm long, buried in a slab, turned against the grid
  const double a = 1.5 * kMm, l = 5 * kMm;
  Work work(phantom::slab({0, 0, 1}, {0, 0, 8 * kMm}), GetParam(), 9);
  const double before = work.volume();
  work.cut_all(one_part({ShapeKind::vesica, a, 0, l, 0}), {Vec3(0.1, 0.2, -0.3) * kMm, kTurned});
  // the arc r(z) = sqrt(R^2 - z^2) - b, turned about z
  const double b = (l * l - a * a) / (2 * a), r = a + b;
  const double want = 2 * M_PI *
                      ((r * r + b * b) * l - l * l * l / 3 -
                       b * (l * std::sqrt(r * r - l * l) + r * r * std::asin(l / r)));
  EXPECT_NEAR(before - work.volume(), want, 0.015 * want);
}

TEST_P(CarveShapes, APlungedDrillLeavesAHoleAsWideAsItIs) {
  // the twist drill of the rack goes 4 mm deep into a slab, turning, while the slab lies turned to the grid
  const scenario::RackTool* drill = scenario::built_in_rack().find("twist-drill");
  ASSERT_NE(drill, nullptr);
  const Vec3 top = Vec3(0.1, -0.2, 3) * kMm, up = kTurned * Vec3::UnitZ();
  Work work(phantom::slab(up, top), GetParam(), 8);
  const double before = work.volume(), depth = 4 * kMm;
  // the end of its point lies this much below its origin
  double low = 0;
  for (int p = 0; p < drill->tool.count; ++p) {
    const tool::Part& part = drill->tool.parts[static_cast<std::size_t>(p)];
    if (part.role == Role::cuts)
      low = std::max(low, tool::support(part.shape, -Vec3::UnitZ()) - part.tool_from_part.p.z());
  }
  // by steps as small as those of a hand; at the end it turns on the spot, for its middle cuts more slowly than its rim
  constexpr int kSteps = 800, kTurnsOn = 40;
  for (int n = 0; n < kSteps + kTurnsOn; ++n) {
    const double deep = depth * std::min(1.0, (n + 1.0) / kSteps);
    work.cut_all(drill->tool, {top + (low - deep) * up, kTurned}, Sweep::turning);
  }
  const double r = 1 * kMm, chisel = 0.2 * kMm, cone = 0.462 * kMm;
  const double want =
      M_PI * r * r * (depth - cone) + M_PI / 3 * cone * (r * r + r * chisel + chisel * chisel);
  EXPECT_NEAR(before - work.volume(), want, 0.015 * want);
}

TEST_P(CarveShapes, EveryKindTakesItsOwnVolume) {
  const double mm = kMm;
  // a sheet of half thickness t about a sphere of radius a, up to the height b, and half a ring around its rim
  const double a = 3, b = 0.5, t = 1, rim = std::sqrt(a * a - b * b);
  const double spoon = 2.0 / 3 * M_PI * (1 + b / a) * (std::pow(a + t, 3) - std::pow(a - t, 3)) +
                       M_PI * M_PI * t * t * (rim - b / a * 4 * t / (3 * M_PI));
  const struct {
    Shape shape;
    double volume;  // [mm^3], of the core with sharp edges
  } kinds[] = {
      {{ShapeKind::ball, 0, 0, 0, 2 * mm}, 4.0 / 3 * M_PI * 8},
      {{ShapeKind::capsule, 0, 0, 2 * mm, 1.5 * mm}, M_PI * 2.25 * 4 + 4.0 / 3 * M_PI * 3.375},
      {{ShapeKind::cylinder, 2 * mm, 0, 3 * mm, 0}, M_PI * 4 * 6},
      {{ShapeKind::frustum, 1 * mm, 2.5 * mm, 3 * mm, 0}, M_PI * 6 / 3 * (1 + 2.5 + 6.25)},
      {{ShapeKind::box, 1.5 * mm, 2 * mm, 2.5 * mm, 0}, 8 * 1.5 * 2 * 2.5},
      {{ShapeKind::wedge, 1.5 * mm, 2 * mm, 6 * mm, 0}, 1.5 * 6 * 4},
      {{ShapeKind::tube, 3 * mm, 1 * mm, 2.5 * mm, 0}, M_PI * (9 - 1) * 5},
      {{ShapeKind::half_shell, a * mm, b * mm, 0, t * mm}, spoon},
  };
  for (const auto& kind : kinds) {
    Work work(phantom::slab({0, 0, 1}, {0, 0, 9 * mm}), GetParam(), 10);
    const double before = work.volume();
    work.cut_all(one_part(kind.shape), {Vec3(0.12, -0.21, 0.4) * mm, kTurned});
    EXPECT_NEAR((before - work.volume()) / 1e-9, kind.volume, 0.015 * kind.volume)
        << "kind " << static_cast<int>(kind.shape.kind);
  }
}

INSTANTIATE_TEST_SUITE_P(Voxels, CarveShapes, testing::Values(0.25, 0.125),
                         [](const auto& each) { return each.param > 0.2 ? "coarse" : "fine"; });

TEST(ToolBody, ABallAsAPartCutsWhatTheBallCuts) {
  const double r = 2 * kMm;
  Work ball(phantom::slab(), 0.25, 6), part(phantom::slab(), 0.25, 6);
  const double before = ball.volume();
  std::uint32_t flags = 0;
  Cut cut;
  cut.centre = ball.bone->grid().grid_from_world({0.1 * kMm, -0.2 * kMm, 1 * kMm});
  cut.push = Vec3(0, 0, -1);
  cut.radius = r / ball.h;
  cut.energy = 1e6;
  ball.carver.carve(cut, flags);
  part.cut_all(one_part({ShapeKind::ball, 0, 0, 0, r}),
               {Vec3(0.1 * kMm, -0.2 * kMm, 1 * kMm), kTurned});
  const double taken = before - ball.volume();
  ASSERT_GT(taken, 0);
  EXPECT_NEAR(before - part.volume(), taken, 1e-5 * taken);
}

TEST(ToolBody, ThePoleOfATurningToolCutsNothing) {
  // no least weight: a place on the axis never moves over the bone
  Work work(phantom::slab(), 0.25, 6, true);
  ToolBody body = cutting_body(one_part({ShapeKind::ball, 0, 0, 0, 2 * kMm}), work.h);
  body.grid_from_tool.p = work.bone->grid().grid_from_world({0, 0, 1.9 * kMm});
  body.sweep = Sweep::turning;
  body.least_weight = 0;
  const Vec3 pole = work.bone->grid().grid_from_world({0, 0, 0});
  const double before = volume::sample(*work.bone, pole), all = work.volume();
  std::uint32_t flags = 0;
  Cut cut;
  cut.body = &body;
  cut.energy = 1e-4;
  for (int n = 0; n < 200; ++n) work.carver.carve(cut, flags);
  EXPECT_LT(work.volume(), all) << "beside the pole it cuts";
  EXPECT_NEAR(volume::sample(*work.bone, pole), before, 0.02);
}

TEST(ToolBody, PartsThatRubCutNothing) {
  tool::Tool shaft;
  ASSERT_TRUE(
      tool::add_part(shaft, {{ShapeKind::capsule, 0, 0, 5 * kMm, 1.2 * kMm}, {}, Role::rubs}));
  Work work(phantom::slab(), 0.25, 6);
  const double before = work.volume();
  work.cut_all(shaft, {Vec3(0, 0, 0), kTurned});
  EXPECT_EQ(work.volume(), before);
}

TEST(ToolBody, ItsImageInAMirrorIsTheSameToTheBit) {
  Work work(phantom::slab(), 0.25, 6);
  const volume::Grid& grid = work.bone->grid();
  const Mirror mirror = mirror_at(0, 0.5 * grid.size.x() + 0.5, grid.size);
  work.cut_all(one_part({ShapeKind::frustum, 0.5 * kMm, 1.5 * kMm, 2 * kMm, 0.1 * kMm}),
               {Vec3(2.2, 0.4, 0.3) * kMm, kTurned}, Sweep::turning, mirror);
  int cut = 0, differ = 0;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const int other = mirror.twice - i;
        if (other < 0 || other >= grid.size.x()) continue;
        const int here = work.bone->field(i, j, k), there = work.bone->field(other, j, k);
        cut += here != 0 && here != 65535 ? 1 : 0;
        differ += here != there ? 1 : 0;
      }
  EXPECT_GT(cut, 1000);
  EXPECT_EQ(differ, 0);
}

TEST(ToolBody, TheLedgerIsExactAndTheTickTakesNoMemory) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  Work work(phantom::slab(), 0.25, 6, false);
  const double before = work.volume();
  tool::Tool mill = one_part({ShapeKind::cylinder, 1.4 * kMm, 0, 3 * kMm, 0.1 * kMm});
  ToolBody body = cutting_body(mill, work.h);
  body.sweep = Sweep::turning;
  std::uint32_t flags = 0;
  {
    const test::RtGuard guard;
    for (int n = 0; n < 300; ++n) {
      body.grid_from_tool.p = work.bone->grid().grid_from_world(
          Vec3(any(random), any(random), 0.8 + 0.3 * any(random)) * kMm);
      body.grid_from_tool.q = Quat(Eigen::AngleAxisd(any(random), Vec3::UnitX()));
      body.ahead = Vec3(0, 0, -1);
      body.turn = Vec3(0, 0.01, 0);
      Cut cut;
      cut.body = &body;
      cut.energy = 1e-4;
      work.carver.carve(cut, flags);
    }
    EXPECT_EQ(guard.allocations(), 0);
  }
  const Ledger ledger = work.carver.ledger();
  EXPECT_NEAR(ledger.removed, before - work.volume(), 1e-12 * before);
  EXPECT_NEAR(ledger.asked, ledger.removed + ledger.debt + ledger.not_cut, 1e-9 * ledger.asked);
  EXPECT_GT(ledger.removed, 0);
}

TEST(ToolBody, EveryInstructionSetGivesTheSameBits) {
  const rt::Simd before = rt::simd();
  std::vector<std::uint64_t> hashes;
  for (const rt::Simd which : {rt::Simd::scalar, rt::Simd::avx2, rt::Simd::avx512}) {
    rt::force_simd(which);
    if (rt::simd() != which) continue;  // not on this processor
    std::uint64_t hash = 0;
    for (const ShapeKind kind :
         {ShapeKind::ball, ShapeKind::capsule, ShapeKind::cylinder, ShapeKind::frustum,
          ShapeKind::vesica, ShapeKind::box, ShapeKind::wedge, ShapeKind::half_shell,
          ShapeKind::tube, ShapeKind::grid}) {
      Work work(phantom::slab(), 0.25, 5);
      const Shape shape = kind == ShapeKind::grid
                              ? test::cylinder_grid(1 * kMm, 2 * kMm, 0.1 * kMm)
                              : Shape{kind, 1 * kMm, 0.7 * kMm, 2 * kMm, 0.2 * kMm};
      work.cut_all(one_part(shape), {Vec3(0.1, 0.2, -0.5) * kMm, kTurned}, Sweep::turning);
      EXPECT_GT(work.carver.ledger().removed, 0) << "kind " << static_cast<int>(kind);
      hash = base::mix(hash, work.bone->content_hash());
    }
    hashes.push_back(hash);
  }
  rt::force_simd(before);
  ASSERT_FALSE(hashes.empty());
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
}

}  // namespace
}  // namespace burr::edit
