// The built-in rubrics about the shape of the cut: an untouched bone meets nothing, work that follows the
// plan meets all that the bone decides, and work that misses the plan in one way loses the items for it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/scenario/case.h"
#include "burr/scenario/open_lesson.h"
#include "burr/scoring/reference.h"
#include "burr/scoring/score.h"
#include "burr/volume/bone.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"

namespace burr::scoring {
namespace {

using math::Vec3;
using scenario::CaseLesson;

constexpr double kMm = 1e-3;

// A built-in rubric with its case, and a coarser bone.
class Shape : public ::testing::TestWithParam<std::pair<const char*, double>> {
 protected:
  void open(const std::string& name, double voxel_mm) {
    auto rubric = read_rubric(name);
    const auto work = scenario::read_case(name);
    ASSERT_TRUE(rubric && work);
    rubric_ = std::move(*rubric);
    auto read = scenario::lesson_of(*work);
    ASSERT_TRUE(read);
    auto placed = scenario::place(std::move(*read), workshop::landmarks_of(*work), name);
    ASSERT_TRUE(placed) << placed.error().text;
    lesson_ = std::move(*placed);
    ASSERT_TRUE(check(rubric_, lesson_)) << check(rubric_, lesson_).error().text;
    for (std::unique_ptr<volume::Bone>* bone : {&before_, &after_}) {
      scenario::BoneRecipe coarse;
      coarse.voxel_mm = voxel_mm;
      auto made = workshop::open_bone(workshop::recipe_of(*work, coarse), quiet_);
      ASSERT_TRUE(made) << made.error().text;
      *bone = std::move(made->bone);
    }
  }

  // wrong: changes the plan that is cut, not the one that is scored
  void cut(const std::function<void(CaseLesson&)>& wrong = {}) {
    CaseLesson plan = lesson_;
    if (wrong) wrong(plan);
    ASSERT_TRUE(cut_to_reference(*after_, *before_, plan, quiet_));
  }

  // The items that the bone decides and that are not met.
  std::set<std::string> unmet() {
    const auto made = score(rubric_, lesson_, *before_, *after_, nullptr, quiet_);
    EXPECT_TRUE(made) << made.error().text;
    std::set<std::string> ids;
    for (std::size_t n = 0; n < rubric_.items.size(); ++n) {
      const Outcome& one = made->outcomes[n];
      if (needs_recording(rubric_.items[n])) continue;
      if (one.verdict != Verdict::met) ids.insert(one.id);
    }
    return ids;
  }

  NoProgress quiet_;
  Rubric rubric_;
  CaseLesson lesson_;
  std::unique_ptr<volume::Bone> before_, after_;
};

scenario::CaseRegion& region_of(CaseLesson& lesson, const std::string& name) {
  for (scenario::CaseRegion& one : lesson.regions)
    if (one.name == name) return one;
  throw std::out_of_range(name);
}

TEST_P(Shape, UntouchedMeetsNothingAndThePlanMeetsAll) {
  open(GetParam().first, GetParam().second);
  if (HasFatalFailure()) return;
  std::size_t of_bone = 0;
  for (const Item& item : rubric_.items)
    if (!needs_recording(item)) ++of_bone;
  EXPECT_GE(of_bone, 4U);
  EXPECT_EQ(unmet().size(), of_bone);
  cut();
  EXPECT_EQ(unmet(), std::set<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, Shape,
                         ::testing::Values(std::pair{"block", 0.4}, std::pair{"spine", 0.4},
                                           std::pair{"jaw", 0.4}, std::pair{"tooth", 0.1}),
                         [](const auto& one) { return std::string(one.param.first); });

class WrongShape : public Shape {};

TEST_F(WrongShape, AGrooveThatIsTooWideAndDeepLosesDepthAndEdges) {
  open("block", 0.4);
  cut([](CaseLesson& plan) { region_of(plan, "groove").add.front().radius = 2.9 * kMm; });
  EXPECT_EQ(unmet(),
            (std::set<std::string>{"groove.kept-narrow", "groove.depth", "groove.outline"}));
}

TEST_F(WrongShape, AShortGrooveIsNotCleared) {
  open("block", 0.4);
  cut([](CaseLesson& plan) { region_of(plan, "groove").add.front().b.at.x() = 4 * kMm; });
  EXPECT_EQ(unmet(), (std::set<std::string>{"groove.cleared", "groove.outline"}));
}

// The corridor turned about its entry by 8 degrees, in the plane of the axes a and b.
void turn_corridor(CaseLesson& plan, int a, int b) {
  std::vector<Vec3>& axis = region_of(plan, "left corridor").add.front().points;
  const Vec3 entry = axis.front(), whole = axis.back() - entry;
  const double by = 8 * M_PI / 180;
  Vec3 turned = whole;
  turned[a] = whole[a] * std::cos(by) - whole[b] * std::sin(by);
  turned[b] = whole[a] * std::sin(by) + whole[b] * std::cos(by);
  axis.back() = entry + turned;
}

TEST_F(WrongShape, ACorridorTurnedOutwardsLosesTheAngleFromAboveAndTheEnd) {
  open("spine", 0.4);
  cut([](CaseLesson& plan) { turn_corridor(plan, 0, 1); });
  EXPECT_EQ(unmet(), (std::set<std::string>{"left.angle-axial", "left.end", "left.cleared",
                                            "left.one-way"}));
}

TEST_F(WrongShape, ACorridorTurnedUpwardsLosesTheAngleFromTheSideAndTheEnd) {
  open("spine", 0.4);
  cut([](CaseLesson& plan) { turn_corridor(plan, 1, 2); });
  EXPECT_EQ(unmet(), (std::set<std::string>{"left.angle-sagittal", "left.end", "left.cleared",
                                            "left.one-way"}));
}

TEST_F(WrongShape, ACorridorAtTheSideOfThePedicleLosesTheBoneRoundTheScrew) {
  open("spine", 0.4);
  cut([](CaseLesson& plan) {
    for (Vec3& point : region_of(plan, "left corridor").add.front().points) point.x() += 4 * kMm;
  });
  EXPECT_EQ(unmet(), (std::set<std::string>{"left.entry", "left.end", "left.in-bone",
                                            "left.cleared", "left.one-way"}));
}

// as wide as the screw and half as much again
TEST_F(WrongShape, ACorridorThatIsTooWideLosesItsWidthAndTheBoneBeside) {
  open("spine", 0.4);
  cut([](CaseLesson& plan) { region_of(plan, "left corridor").add.front().radius = 3.6 * kMm; });
  EXPECT_EQ(unmet(), (std::set<std::string>{"left.width", "left.one-way"}));
}

TEST_F(WrongShape, ABedThatIsTooDeepLosesItsDepthAndTheDistanceToTheNerve) {
  open("jaw", 0.4);
  cut([](CaseLesson& plan) {
    scenario::Shape& bed = region_of(plan, "implant bed").add.front();
    bed.points.back().z() -= 5 * kMm;
    plan.reference->leave.clear();
  });
  EXPECT_EQ(unmet(), (std::set<std::string>{"bed.depth", "nerve.clear"}));
}

// Who stops early must not have a better mark than who goes on: what a short bed cannot show stays in
// the denominator.
TEST_F(WrongShape, HalfABedIsUnmetAndNotLeftOut) {
  open("jaw", 0.4);
  cut([](CaseLesson& plan) {
    std::vector<Vec3>& axis = region_of(plan, "implant bed").add.front().points;
    axis.back() = axis.front() + 0.4 * (axis.back() - axis.front());
  });
  const auto made = score(rubric_, lesson_, *before_, *after_, nullptr, quiet_);
  ASSERT_TRUE(made) << made.error().text;
  std::size_t of_axis = 0;
  for (std::size_t n = 0; n < rubric_.items.size(); ++n) {
    if (std::string(rubric_.items[n].how->name).rfind("axis_", 0) != 0) continue;
    ++of_axis;
    EXPECT_EQ(made->outcomes[n].verdict, Verdict::unmet) << made->outcomes[n].id;
    EXPECT_NE(made->outcomes[n].reason, "") << made->outcomes[n].id;
  }
  EXPECT_EQ(of_axis, 5U);
}

TEST_F(WrongShape, ABedBesideTheGapLosesEntryAndEnd) {
  open("jaw", 0.4);
  cut([](CaseLesson& plan) {
    for (Vec3& point : region_of(plan, "implant bed").add.front().points) point.x() += 1.8 * kMm;
  });
  EXPECT_EQ(unmet(), (std::set<std::string>{"bed.entry", "bed.end", "bed.cleared", "bed.one-way"}));
}

// The slab between the two faces of the osteotomy, changed
void move_osteotomy(CaseLesson& plan, const std::function<void(scenario::Shape&)>& change) {
  scenario::CaseRegion& slab = region_of(plan, "osteotomy");
  change(slab.add.front());
  change(slab.take.front());
}

TEST_F(WrongShape, AnOsteotomyTooFarInFrontLosesItsPlace) {
  open("jaw", 0.4);
  cut([](CaseLesson& plan) {
    move_osteotomy(plan, [](scenario::Shape& face) { face.a.at.y() -= 2 * kMm; });
  });
  EXPECT_EQ(unmet(), (std::set<std::string>{"cut.place", "cut.cleared", "cut.front-spared"}));
}

TEST_F(WrongShape, AnOsteotomyThatLeansTooMuchLosesItsAngle) {
  open("jaw", 0.4);
  cut([](CaseLesson& plan) {
    const double a = 16 * M_PI / 180;
    move_osteotomy(plan, [a](scenario::Shape& face) {
      // about the middle of the slab, which is as high as the middle of the bone there
      const Vec3 middle(-5.7 * kMm, -29.45 * kMm, -21 * kMm);
      const Vec3 across = Vec3(0, -std::cos(a), std::sin(a));
      const double off = (face.a.at - Vec3(-5.7, -29.45, -18) * kMm).dot(face.normal);
      face.a.at = middle + off * across;
      face.normal = across;
    });
  });
  const auto lost = unmet();
  EXPECT_TRUE(lost.contains("cut.angle"));
  EXPECT_FALSE(lost.contains("cut.divided"));
  EXPECT_FALSE(lost.contains("cut.even-behind"));
  EXPECT_FALSE(lost.contains("cut.even-front"));
}

TEST_F(WrongShape, ABridgeLosesTheDivisionAlone) {
  open("jaw", 0.4);
  cut([](CaseLesson& plan) {
    scenario::Shape bridge;
    bridge.kind = scenario::ShapeKind::box;
    bridge.a.at = Vec3(-5.7, -30.5, -27) * kMm;  // at the lower border
    bridge.size = Vec3(3, 8, 2.4) * kMm;
    region_of(plan, "osteotomy").take.push_back(bridge);
  });
  EXPECT_EQ(unmet(), (std::set<std::string>{"cut.divided"}));
}

TEST_F(WrongShape, AnUnevenFaceLosesEvennessAlone) {
  open("jaw", 0.4);
  cut([](CaseLesson& plan) {
    for (int n = 0; n < 4; ++n) {
      scenario::Shape dent;
      dent.kind = scenario::ShapeKind::ball;
      dent.a.at = Vec3(-10.5 + 3.2 * n, -26.9, -19 - 1.5 * (n % 2)) * kMm;
      dent.radius = 2.1 * kMm;
      region_of(plan, "osteotomy").add.push_back(dent);
    }
  });
  const auto lost = unmet();
  EXPECT_TRUE(lost.contains("cut.even-behind"));
  EXPECT_FALSE(lost.contains("cut.even-front"));
  EXPECT_FALSE(lost.contains("cut.divided"));
}

TEST_F(WrongShape, ADefectHalfFilledLosesItsShareAndOneFilledTooHighItsLevel) {
  open("jaw", 0.4);
  cut([](CaseLesson& plan) { region_of(plan, "defect").take.front().a.at.x() -= 0.7 * kMm; });
  EXPECT_EQ(unmet(), (std::set<std::string>{"defect.filled"}));
  open("jaw", 0.4);
  cut([](CaseLesson& plan) { region_of(plan, "defect").take.front().a.at.x() += 0.9 * kMm; });
  EXPECT_EQ(unmet(), (std::set<std::string>{"defect.level"}));
}

TEST_F(WrongShape, AWideOpeningLosesTheToothAndTheOutline) {
  open("tooth", 0.1);
  cut([](CaseLesson& plan) {
    region_of(plan, "way in").add.front().radius = 2.6 * kMm;
    region_of(plan, "deep caries").add.front().radius = 2.6 * kMm;
  });
  EXPECT_EQ(unmet(), (std::set<std::string>{"dentine.spared", "outline.kept"}));
}

TEST_F(WrongShape, WhoClearsCariesDownToThePulpLosesItsRoof) {
  open("tooth", 0.1);
  cut([](CaseLesson& plan) {
    scenario::CaseRegion& caries = region_of(plan, "deep caries");
    caries.take.erase(caries.take.begin());  // what keeps away from the pulp
    caries.add.front().points.back().z() -= 0.3 * kMm;
    plan.reference->leave.front().second = 0.2 * kMm;
  });
  EXPECT_EQ(unmet(), (std::set<std::string>{"roof.kept", "pulp.covered"}));
}

TEST_F(WrongShape, WhoLeavesNoDentineOverThePulpBreaksTheGate) {
  open("tooth", 0.1);
  cut([](CaseLesson& plan) {
    scenario::CaseRegion& caries = region_of(plan, "deep caries");
    caries.take.erase(caries.take.begin());  // what keeps away from the pulp
    caries.add.front().points.back().z() -= 1.2 * kMm;
    plan.reference->leave.clear();
  });
  EXPECT_TRUE(unmet().contains("pulp.not-bare"));
}

TEST_F(WrongShape, WhoLeavesCariesAtOneSideLosesBothItemsAboutIt) {
  open("tooth", 0.1);
  cut([](CaseLesson& plan) {
    scenario::Shape side;
    side.kind = scenario::ShapeKind::half_space;
    side.a.at = Vec3(-0.5, 0, 0) * kMm;
    side.normal = -Vec3::UnitX();
    region_of(plan, "deep caries").take.push_back(side);
    region_of(plan, "way in").add.front().b.at.z() += 1 * kMm;  // which would take it away too
  });
  EXPECT_EQ(unmet(), (std::set<std::string>{"caries.soft", "caries.firm"}));
}

TEST_F(WrongShape, AFrontCavityTooDeepLosesItsDepthAlone) {
  open("tooth", 0.1);
  cut([](CaseLesson& plan) {
    scenario::Shape& box = region_of(plan, "pit cavity").add.front();
    box.a.at.z() -= 0.35 * kMm;
    box.size.z() += 0.7 * kMm;
  });
  EXPECT_EQ(unmet(), (std::set<std::string>{"pit.depth"}));
}

TEST_F(WrongShape, AFrontCavityBesideThePitLosesPlaceAndCaries) {
  open("tooth", 0.1);
  cut([](CaseLesson& plan) { region_of(plan, "pit cavity").add.front().a.at.x() += 0.9 * kMm; });
  EXPECT_EQ(unmet(), (std::set<std::string>{"pit.cleared", "pit.outline", "pit.spared"}));
}

TEST_F(WrongShape, AGrooveInTheFloorInFrontLosesFlatnessAlone) {
  open("tooth", 0.1);
  cut([](CaseLesson& plan) {
    scenario::CaseRegion& pit = region_of(plan, "pit cavity");
    scenario::Shape dent;
    dent.kind = scenario::ShapeKind::box;
    dent.a.at = Vec3(-0.1, -2.7, 4.6) * kMm;
    dent.size = Vec3(0.8, 2.2, 1.4) * kMm;
    pit.add.push_back(dent);
  });
  EXPECT_EQ(unmet(), (std::set<std::string>{"pit.floor"}));
}

}  // namespace
}  // namespace burr::scoring
