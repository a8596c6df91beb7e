// A segment of a formula-made bone is cut free by a scripted hand, moved along a plan, and measured
// against the truth.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "burr/device/simulated_hand.h"
#include "burr/math/turn.h"
#include "burr/metrics/piece_fit.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/scenario/rack.h"
#include "burr/sim/move_pieces.h"
#include "burr/sim/session.h"
#include "burr/surgeon/plane_cut.h"
#include "burr/tick/held_piece.h"
#include "burr/tick/servo.h"
#include "burr/volume/pieces.h"
#include "burr/volume/volume_of.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/piece_plan.h"
#include "burr/workshop/prepare.h"
#include "support/crossing.h"

namespace burr::workshop {
namespace {

using math::Quat;
using math::Vec3;
constexpr double kMm = 1e-3, kVoxel = 0.25 * kMm, kBurr = 1 * kMm;

// Strokes across the bar at x = 0, deeper each time, until it is divided.
device::HandPath across(double deepest) {
  device::HandPath path;
  double t = 0;
  const auto go = [&](double y, double z, double speed, double pedal) {
    const Vec3 p = Vec3(0, y, z) * kMm;
    if (!path.points.empty()) t += (p - path.points.back().world_from_tool.p).norm() / speed;
    path.points.push_back({t, {p, Quat::Identity()}, pedal});
  };
  go(-6, 5, 1, 1);
  double side = 1;
  const auto stroke = [&](double z) {
    go(-6 * side, z, 20 * kMm, 1);
    go(6 * side, z, 3 * kMm, 1);
    side = -side;
  };
  for (double z = 1.6; z > deepest; z -= 0.4) stroke(z);
  for (int n = 0; n < 4; ++n) stroke(deepest);  // the hand is ahead of the burr
  go(-6 * side, 5, 20 * kMm, 1);
  go(8, 6, 20 * kMm, 0);
  path.points.push_back({t + 3600, path.points.back().world_from_tool, 0});
  return path;
}

TEST(Segment, CutFreeAndMovedByFiveMillimetresItSitsWhereThePlanSays) {
  NoProgress quiet;
  // 18 mm to the left of the cut, 10 mm to the right of it; 5 mm wide, 3 mm thick
  const phantom::Depth bar = phantom::box({14 * kMm, 2.5 * kMm, 1.5 * kMm});
  auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3(-20, -6, -5) * kMm, Vec3(18, 6, 6) * kMm, kVoxel), {},
      [bar](const Vec3& p) { return bar(p + Vec3(4 * kMm, 0, 0)); }, 1024);
  const double whole = volume::volume_of(*bone);
  sim::SessionSettings settings;
  settings.servo.burr.radius = kBurr;
  settings.surface.reserve_blocks = 1 << 14;
  auto path = across(-3.4);
  const double seconds = path.points[path.points.size() - 2].t + 0.5;
  auto made = sim::Session::make(std::move(bone),
                                 std::make_unique<device::SimulatedHand>(
                                     std::move(path), device::ArmSettings{.stiffness = INFINITY}),
                                 settings, quiet);
  ASSERT_TRUE(made.ok()) << made.error().text;
  sim::Session& session = **made;
  session.run(seconds, quiet);
  const double kerf = session.outcome().ledger.removed;
  ASSERT_GT(1e9 * kerf, 20) << "the bar was not divided";
  ASSERT_EQ(volume::PieceFinder(std::as_const(session.bone())).pieces().size(), 2U);

  scenario::CaseLesson lesson;
  scenario::PlannedPiece& plan = lesson.pieces.emplace_back();
  plan.near.at = Vec3(6, 0, 0) * kMm;
  plan.by = Vec3(5, 0, 0) * kMm;
  edit::PieceStore store;
  const auto moved = sim::move_piece(session, store, {plan.near.at, plan.by, Vec3::Zero()}, quiet);
  ASSERT_TRUE(moved.ok()) << moved.error().text;
  EXPECT_NEAR(1e9 * moved->volume, 9 * 15, 0.03 * 9 * 15);
  auto places = store.moved(session.bone());
  ASSERT_EQ(places.size(), 1U);
  ASSERT_EQ(plan_of(lesson, *places[0].came_free), &plan);
  OffPlan off =
      off_plan(plan, places[0].now * places[0].centre - places[0].centre, places[0].now.q);
  EXPECT_LT(1e3 * off.off, 0.001);
  EXPECT_LT(off.turned_off * 180 / M_PI, 0.001);
  EXPECT_NEAR(1e3 * off.way, 5, 0.001);
  // the truth: its end was at x = 10
  EXPECT_NEAR(test::crossing(*places[0].piece, Vec3(12, 0, 0) * kMm, Vec3::UnitX()), 3 * kMm,
              0.1 * kVoxel);
  EXPECT_NEAR(test::crossing(*places[0].piece, Vec3(12, 0, 0) * kMm, Vec3::UnitY()), 2.5 * kMm,
              0.1 * kVoxel);
  const edit::Ledger ledger = session.outcome().ledger;
  EXPECT_NEAR(volume::volume_of(session.bone()) + ledger.removed + ledger.moved, whole,
              1e-6 * whole);

  // and back, 1.3 mm nearer than it was: the kerf of 2 mm is then a gap of 0.7 mm
  const auto again = sim::move_piece(
      session, store, {Vec3(11, 0, 0) * kMm, Vec3(-6.3, 0, 0) * kMm, Vec3::Zero()}, quiet);
  ASSERT_TRUE(again.ok()) << again.error().text;
  places = store.moved(session.bone());
  ASSERT_EQ(places.size(), 1U);
  off = off_plan(plan, places[0].now * places[0].centre - places[0].centre, places[0].now.q);
  EXPECT_NEAR(1e3 * off.off, 6.3, 0.001);
  const metrics::PieceFit fit =
      metrics::piece_fit(*places[0].piece, *store.without_moved(session.bone()));
  EXPECT_NEAR(1e3 * fit.gap, 0.7, 0.15);
  EXPECT_NEAR(1e6 * fit.facing, 13, 3) << "of 15: the edges, which voxels round off, face nothing";
  ASSERT_TRUE(fit.has_step);
  EXPECT_LT(1e3 * fit.step, 0.1);

  // three degrees too far about z
  const auto turned = sim::move_piece(
      session, store, {Vec3(5, 0, 0) * kMm, Vec3(6.3, 0, 0) * kMm, Vec3(0, 0, 3 * M_PI / 180)},
      quiet);
  ASSERT_TRUE(turned.ok()) << turned.error().text;
  places = store.moved(session.bone());
  ASSERT_EQ(places.size(), 1U);
  off = off_plan(plan, places[0].now * places[0].centre - places[0].centre, places[0].now.q);
  EXPECT_LT(1e3 * off.off, 0.001);
  EXPECT_NEAR(off.turned_off * 180 / M_PI, 3, 0.001);
}

// The case of the lower jaw: its front segment is sawn off along the planned plane, raised as planned,
// and measured against the formula.
TEST(Segment, TheJawIsSawnAlongItsPlanAndItsFrontIsRaisedAsPlanned) {
  NoProgress quiet;
  const auto work = scenario::read_case("jaw");
  ASSERT_TRUE(work.ok()) << work.error().text;
  const auto lesson = placed_lesson(*work);
  ASSERT_TRUE(lesson.ok()) << lesson.error().text;
  ASSERT_EQ(lesson->pieces.size(), 1U);
  const scenario::PlannedPiece& plan = lesson->pieces[0];
  EXPECT_NEAR(1e3 * plan.by.norm(), 5, 0.001);
  auto prepared = prepare(*work, quiet);
  ASSERT_TRUE(prepared.ok()) << prepared.error().text;
  const auto plane = surgeon::plane_of(*lesson, "divide");
  ASSERT_TRUE(plane.ok()) << plane.error().text;
  EXPECT_NEAR(plan.by.dot(plane->normal), 0, 1e-5) << "it slides along the cut";
  const scenario::RackTool saw = *scenario::built_in_rack().get("reciprocating-saw");
  auto path = surgeon::cut_along(*prepared->bone, *plane,
                                 surgeon::blade_of(saw.tool, saw.cutter, saw.lean), 50);
  ASSERT_TRUE(path.ok()) << path.error().text;
  const double seconds = path->duration();
  // and then the hand carries the segment: it grips, shifts as planned, and lets go
  constexpr double kLifted = 10, kCarries = 4, kHolds = 0.5;  // [s]
  const math::Pose rest = path->points.back().world_from_tool;
  const math::Pose raised{rest.p + plan.by, rest.q};
  path->points.push_back({seconds + 1e-3, rest, 0});
  path->points.push_back({seconds + kLifted, rest, 1});
  path->points.push_back({seconds + kLifted + kCarries, raised, 1});
  path->points.push_back({seconds + kLifted + kCarries + kHolds, raised, 0});
  path->points.push_back({seconds + 3600, raised, 0});

  // what lies in front of the kerf, and behind it, in voxels
  constexpr double kKerf = 0.7 * kMm, kNear = 0.3 * kMm;
  const auto inside = [&](const volume::Bone& bone, double from, double to) {
    double count = 0;
    for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
      const volume::Field* const field = bone.brick_field(brick);
      if (field == nullptr) continue;
      for (int v = 0; v < volume::kBrickVoxels; ++v) {
        const math::Ijk at = bone.brick_ijk(brick) + math::Ijk(v & 7, v >> 3 & 7, v >> 6);
        const double d =
            (bone.grid().world_from_grid(at.cast<double>()) - plane->at).dot(plane->normal);
        if (field[v] >= volume::kIso && d > from && d < to) ++count;
      }
    }
    return count;
  };
  constexpr double kFar = 1;  // [m]
  const double front = inside(*prepared->bone, kKerf / 2, kFar);
  const double untouched = inside(*prepared->bone, kKerf / 2 + kNear, kFar);
  const double behind = inside(*prepared->bone, -kFar, -kKerf / 2 - kNear);
  const double whole = volume::volume_of(*prepared->bone);

  sim::SessionSettings settings = settings_of(*prepared);
  settings.servo.tools = {{saw.name, saw.tool, saw.cutter}};
  settings.servo.tool = 0;
  // an arm that never tires, and a stiff spring, so that the saw needs a minute and not four
  settings.servo.force.stiffness = 5000;
  auto made =
      begin(*prepared,
            std::make_unique<device::SimulatedHand>(
                std::move(*path), device::ArmSettings{.stiffness = INFINITY},
                device::DeviceSpec{.peak_force = 8, .continuous_force = 8, .max_stiffness = 5000}),
            settings, quiet);
  ASSERT_TRUE(made.ok()) << made.error().text;
  sim::Session& session = **made;
  session.run(seconds, quiet);
  EXPECT_EQ(inside(session.bone(), kKerf / 2 + kNear, kFar), untouched);
  EXPECT_EQ(inside(session.bone(), -kFar, -kKerf / 2 - kNear), behind);

  // Carried by the hand the bone lets it go the whole way: nothing that lies loose in its pores stays behind
  // and holds it up. In the kerf it may lean on a splinter.
  {
    const std::uint64_t cut_free = session.bone().content_hash();
    edit::PieceStore carried;
    const auto lifted = sim::lift_piece(session, carried, plan.near.at, quiet);
    ASSERT_TRUE(lifted.ok()) << lifted.error().text;
    session.run(seconds + kLifted + kCarries + kHolds / 2 - session.outcome().seconds, quiet);
    const math::Pose there = session.servo().piece().pose();
    EXPECT_LT(1e3 * (there.p - lifted->centre - plan.by).norm(), 0.1);
    EXPECT_LT(math::rotation_vector(there.q).norm() * 180 / M_PI, 0.2);
    const auto left = sim::leave_piece(session);
    ASSERT_TRUE(left.ok() && *left);
    EXPECT_EQ(session.bone().content_hash(), cut_free);
  }

  edit::PieceStore store;
  ASSERT_EQ(store.list(session.bone()).size(), 1U) << "the cut did not free the segment";
  const auto moved = sim::move_piece(session, store, {plan.near.at, plan.by, Vec3::Zero()}, quiet);
  ASSERT_TRUE(moved.ok()) << moved.error().text;
  const auto places = store.moved(session.bone());
  ASSERT_EQ(places.size(), 1U);
  ASSERT_EQ(plan_of(*lesson, *places[0].came_free), &plan);
  EXPECT_NEAR(inside(*places[0].came_free, -kFar, kFar), front, 0.01 * front);
  const OffPlan off =
      off_plan(plan, places[0].now * places[0].centre - places[0].centre, places[0].now.q);
  EXPECT_LT(1e3 * off.off, 0.001);
  EXPECT_LT(off.turned_off * 180 / M_PI, 0.001);
  EXPECT_NEAR(1e3 * off.way, 5, 0.001);
  // the truth: by the formula its front end was flat, at y = -39 mm
  const Vec3 in_front = Vec3(-6.8, -38.2, -18) * kMm + plan.by;
  EXPECT_NEAR(1e3 * (in_front.y() - test::crossing(*places[0].piece, in_front, -Vec3::UnitY())),
              -39 + 0.696, 0.1 * 0.25);
  const metrics::PieceFit fit =
      metrics::piece_fit(*places[0].piece, *store.without_moved(session.bone()));
  // walls of cortex face each other over the kerf; pits of marrow are deeper
  EXPECT_NEAR(1e3 * fit.gap_least, 0.7, 0.15);
  ASSERT_TRUE(fit.has_step);
  EXPECT_GT(1e3 * fit.step_most, 3) << "at ridge and border; at the sides the outer faces go on";
  const edit::Ledger ledger = session.outcome().ledger;
  EXPECT_NEAR(volume::volume_of(session.bone()) + ledger.removed + ledger.moved, whole,
              1e-6 * whole);

  // as it was before the move, for who judges the cut
  const auto back = store.with_pieces_back(session.bone());
  EXPECT_NEAR(volume::volume_of(*back) + ledger.removed, whole, 1e-9 * whole);
  EXPECT_EQ(inside(*back, kKerf / 2 + kNear, kFar), untouched);
}

}  // namespace
}  // namespace burr::workshop
