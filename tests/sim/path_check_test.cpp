// What is said about a path is what the session does on it: with a ball, with tools of the rack turned
// anyhow, in either hand.
#include "burr/sim/path_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/scenario/rack.h"
#include "burr/sim/session.h"
#include "burr/tick/second_hand.h"
#include "burr/tick/servo.h"

namespace burr::sim {
namespace {

using math::Pose;
using math::Quat;
using math::Vec3;
constexpr double kMm = 1e-3;
const Pose kAbove{{0, 0, 60 * kMm}, Quat::Identity()};

struct Holds {
  const char* tool = nullptr;  // of the rack; nullptr: a ball
  double radius = 2 * kMm;
};

device::HandPath from_to(const Pose& a, const Pose& b, double seconds, double pedal = 0) {
  device::HandPath path;
  path.points = {{0, a, pedal}, {seconds, b, pedal}};
  return path;
}

// A slab whose top is z = 0; the first hand follows `path` exactly, the second, if there is one, `second`.
std::unique_ptr<Session> session_of(const Holds& holds, const device::HandPath& path,
                                    const std::optional<Holds>& beside = {},
                                    const device::HandPath& second_path = from_to(kAbove, kAbove,
                                                                                  1)) {
  NoProgress quiet;
  SessionSettings settings;
  settings.servo.burr.radius = holds.radius;
  settings.servo.undo_bricks = 2048;
  settings.surface.reserve_blocks = 1 << 13;
  const auto of_rack = [](const char* name) {
    const auto tool = scenario::built_in_rack().get(name);
    EXPECT_TRUE(tool.ok());
    return tool::ShapedTool{tool->name, tool->tool, tool->cutter};
  };
  if (holds.tool != nullptr) {
    settings.servo.tools = {of_rack(holds.tool)};
    settings.servo.tool = 0;
  }
  device::ArmSettings rigid;
  rigid.stiffness = INFINITY;
  auto made = Session::make(
      phantom::bone_from_distance(phantom::box_grid({-12 * kMm, -8 * kMm, -8 * kMm},
                                                    {12 * kMm, 8 * kMm, 8 * kMm}, 0.5 * kMm),
                                  {}, phantom::slab(), 256),
      std::make_unique<device::SimulatedHand>(path, rigid), settings, quiet);
  EXPECT_TRUE(made.ok()) << made.error().text;
  if (!beside) return std::move(*made);
  tick::SecondHandSettings second;
  second.radius = beside->radius;
  if (beside->tool != nullptr) second.tool = of_rack(beside->tool);
  const Status joined =
      (*made)->add_second_hand(std::make_unique<device::SimulatedHand>(second_path, rigid), second);
  EXPECT_TRUE(joined.ok()) << joined.error().text;
  return std::move(*made);
}

bool says(const std::vector<std::string>& sentences, const char* part) {
  for (const std::string& one : sentences)
    if (one.find(part) != std::string::npos) return true;
  return false;
}
constexpr const char* kInside = "is inside the bone at the first point";
constexpr const char* kNothing = "nothing was touched";

// By arithmetic: the top of the slab is z = 0.
TEST(PathCheck, ABallAndALongBurrAboveAndInTheSlab) {
  struct Case {
    const char* tool;
    double z;
    bool inside;
  };
  for (const Case& one :
       {Case{nullptr, 2.4, false}, Case{nullptr, 1.6, true}, Case{nullptr, -4, true},
        Case{"lindemann", 20, false}, Case{"lindemann", -1, true}, Case{"wheel", 12, false},
        Case{"wheel", 0, true}}) {
    const Pose at{{0, 0, one.z * kMm}, Quat::Identity()};
    const FollowedPath first{from_to(at, at, 1), "p.csv"};
    const auto session = session_of({one.tool}, first.path);
    EXPECT_EQ(says(doubts_before(*session, first), kInside), one.inside)
        << (one.tool != nullptr ? one.tool : "ball") << one.z;
    // the same in the other hand
    const FollowedPath second{first.path, "q.csv", true};
    const auto two = session_of({}, from_to(kAbove, kAbove, 1), Holds{one.tool}, second.path);
    EXPECT_EQ(says(doubts_before(*two, second), kInside), one.inside)
        << (one.tool != nullptr ? one.tool : "ball") << one.z << " in the second hand";
    EXPECT_FALSE(says(doubts_before(*two, {from_to(kAbove, kAbove, 1), "p.csv"}), kInside));
  }
}

// Tools at random places, turned anyhow: the session engages where nothing is said, and nowhere else.
TEST(PathCheck, IsInsideWhereTheSessionDoesNotEngage) {
  constexpr unsigned kSeed = 91;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> any(-1, 1);
  int inside = 0, all = 0;
  for (const char* tool : {static_cast<const char*>(nullptr), "lindemann", "wheel", "sagittal-saw"})
    for (int n = 0; n < 12; ++n, ++all) {
      Pose at;
      at.p = Vec3(4 * any(random), 4 * any(random), 8 * any(random)) * kMm;
      at.q = Quat(any(random), any(random), any(random), any(random)).normalized();
      const FollowedPath followed{from_to(at, at, 1), "p.csv"};
      const auto session = session_of({tool}, followed.path);
      const bool said = says(doubts_before(*session, followed), kInside);
      NoProgress quiet;
      session->step(50, quiet);
      EXPECT_EQ(said, session->servo().released()) << n;
      inside += said ? 1 : 0;
    }
  EXPECT_GT(inside, all / 10);
  EXPECT_LT(inside, 9 * all / 10);
}

// What the outcome contradicts is not said; what it bears out, is.
TEST(PathCheck, NothingWasTouchedIsSaidOnlyWhereNothingWas) {
  constexpr unsigned kSeed = 92;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> any(0, 1);
  int touched = 0, untouched = 0;
  for (const char* tool : {static_cast<const char*>(nullptr), "lindemann", "wheel"})
    for (int n = 0; n < 8; ++n) {
      const Pose high{{0, 0, 45 * kMm}, Quat::Identity()},
          low{{0, 0, (-1 + 40 * any(random)) * kMm}, Quat::Identity()};
      const FollowedPath followed{from_to(high, low, 0.5, n % 2), "p.csv"};
      const auto session = session_of({tool}, followed.path);
      NoProgress quiet;
      session->run(0.5, quiet);
      const auto said = doubts_after(*session, followed);
      const Outcome outcome = session->outcome();
      const bool felt = outcome.mean_force > 0 || outcome.ledger.removed > 0;
      const bool told = says(said, kNothing);
      EXPECT_FALSE(told && felt) << low.p.z();
      // the box of the bone ends within a brick, 4 mm, above it
      EXPECT_TRUE(told || felt || low.p.z() < 5 * kMm) << low.p.z();
      ++(felt ? touched : untouched);
    }
  EXPECT_GT(touched, 0);
  EXPECT_GT(untouched, 0);
}

// The hand comes near between two points: there, not at them, it is measured.
TEST(PathCheck, TheWayBetweenThePointsCounts) {
  const Pose left{{-60 * kMm, 0, 12 * kMm}, Quat::Identity()},
      right{{60 * kMm, 0, 12 * kMm}, Quat::Identity()};
  const FollowedPath followed{from_to(left, right, 0.5), "p.csv"};
  const auto session = session_of({}, followed.path);
  NoProgress quiet;
  session->run(0.5, quiet);
  const auto said = doubts_after(*session, followed);
  ASSERT_EQ(said.size(), 1U);
  // the bricks of the slab end within a brick of 4 mm above z = 0; at both ends it is 48 mm away
  const double mm = std::stod(said.front().substr(said.front().find("than ") + 5));
  EXPECT_GE(mm, 12 - 4.5);
  EXPECT_LE(mm, 12);
}

TEST(PathCheck, MetresInPlaceOfMillimetresAreNamed) {
  const Pose far{{0, 0, 20}, Quat::Identity()};
  const FollowedPath followed{from_to(far, far, 0.1), "p.csv"};
  const auto session = session_of({}, followed.path);
  NoProgress quiet;
  session->run(0.1, quiet);
  EXPECT_TRUE(says(doubts_before(*session, followed), "must be named x_mm,y_mm,z_mm"));
}

}  // namespace
}  // namespace burr::sim
