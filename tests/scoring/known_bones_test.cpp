// Bones of the built-in cases whose right marks are known, cut by shapes that burr's regions and measures do not use.
#include "scoring/known_bones.h"

#include <gtest/gtest.h>

#include <string>

namespace burr::scoring {
namespace {

using test::known_line;
using test::KnownBone;

// ---- the jaw: a bed of 4 mm, to the plan's end 10 mm under the ridge

constexpr const char* kJaw = "jaw.txt";
constexpr double kHalfVoxel = 0.125;  // of the jaw [mm]

TEST(KnownBones, ABedOnThePlanIsAsWideAsItIs) {
  BURR_NEEDS_DATA("known_bones/jaw.txt");
  KnownBone jaw("jaw");
  jaw.cut(known_line(kJaw, "plan exact: 4x10"));
  EXPECT_LT(jaw.mm("bed.width"), 0.05) << "off 4.00";
  EXPECT_LT(jaw.mm("bed.depth"), kHalfVoxel);
  EXPECT_LT(jaw.mm("bed.entry"), 0.1);
  EXPECT_LT(*jaw.outcome("bed.angle").value, 0.5 * M_PI / 180);
  for (const char* id : {"bed.width", "bed.depth", "bed.entry", "bed.end", "bed.angle",
                         "bed.cleared", "bed.one-way"})
    EXPECT_TRUE(jaw.met(id)) << id;
  jaw.cut(known_line(kJaw, "bed too wide 0.4"));
  EXPECT_NEAR(jaw.mm("bed.width"), 0.8, 0.05) << "a radius of 2.4";
  EXPECT_FALSE(jaw.met("bed.width"));
  jaw.cut(known_line(kJaw, "bed 0.5 mm too deep"));
  EXPECT_NEAR(jaw.mm("bed.depth"), 0.5, kHalfVoxel);
  jaw.cut(known_line(kJaw, "bed 1 mm off"));
  EXPECT_NEAR(jaw.mm("bed.entry"), 1, 0.1);
  EXPECT_NEAR(jaw.mm("bed.end"), 1, kHalfVoxel);
}

TEST(KnownBones, HolesBesideABedLeaveItAsItIsAndTheBoneBesideIsNot) {
  BURR_NEEDS_DATA("known_bones/jaw.txt");
  KnownBone jaw("jaw");
  jaw.cut(known_line(kJaw, "bed exact and 3 holes 5 mm beside"));
  EXPECT_LT(jaw.mm("bed.width"), 0.05);
  EXPECT_LT(jaw.mm("bed.depth"), kHalfVoxel);
  for (const char* id : {"bed.width", "bed.depth", "bed.entry", "bed.end", "bed.angle"})
    EXPECT_TRUE(jaw.met(id)) << id << ": " << jaw.outcome(id).reason;
  EXPECT_FALSE(jaw.met("bed.one-way"));
}

// ---- the spine

constexpr const char* kSpine = "spine.txt";

TEST(KnownBones, CorridorsToTheEndOfThePlanHaveItsDepth) {
  BURR_NEEDS_DATA("known_bones/spine.txt");
  KnownBone spine("spine");
  spine.cut(known_line(kSpine, "both exact to the very end"));
  constexpr double kHalf = 0.2;  // voxel [mm]
  for (const std::string side : {"left", "right"}) {
    EXPECT_LT(spine.mm(side + ".depth"), kHalf) << side;
    EXPECT_LT(spine.mm(side + ".entry"), 0.15) << side;
    EXPECT_NEAR(spine.mm(side + ".width"), 0.5, 0.1) << side << ": 5.0 for 4.5";
    EXPECT_TRUE(spine.met(side + ".one-way")) << side;
  }
  spine.cut(known_line(kSpine, "left 7 mm too short"));
  // along the plan, which leans by 7.9 degrees to the y axis
  EXPECT_NEAR(spine.mm("left.depth"), 7.06, kHalf);
  EXPECT_FALSE(spine.met("left.depth"));
  spine.cut(known_line(kSpine, "left 5 mm too long"));
  EXPECT_NEAR(spine.mm("left.depth"), 5.0, kHalf);
  EXPECT_TRUE(spine.met("left.one-way")) << "too long is not a second way";
}

TEST(KnownBones, ASecondWayBesideACorridorIsASecondWayAndNoOtherAxis) {
  BURR_NEEDS_DATA("known_bones/spine.txt");
  KnownBone spine("spine");
  spine.cut(known_line(kSpine, "left exact and second way"));
  for (const char* id : {"left.entry", "left.angle-axial", "left.angle-sagittal", "left.end",
                         "left.depth", "left.width"})
    EXPECT_TRUE(spine.met(id)) << id << ": " << spine.outcome(id).reason;
  EXPECT_FALSE(spine.met("left.one-way"));
  EXPECT_TRUE(spine.met("right.one-way"));
}

// ---- the ear

constexpr const char* kEar = "nerve.txt";

TEST(KnownBones, ANerveThatIsSeenThroughNeedlesHolesIsNotFound) {
  BURR_NEEDS_DATA("known_bones/nerve.txt");
  KnownBone ear("temporal-bone");
  ear.cut(known_line(kEar, "peepholes only"));
  EXPECT_FALSE(ear.met("facial.mastoid-identified"));
  EXPECT_EQ(ear.outcome("facial.mastoid-identified").value.value_or(-1), 0);
}

// What lies between counts, cells included: a nerve behind opened cells is not found. A quarter of this one's course lies beside
// the antrum, which is wide, and is seen there whatever stands.
TEST(KnownBones, ANerveUnderALayerIsFoundWhereTheLayerIsThin) {
  BURR_NEEDS_DATA("known_bones/nerve.txt");
  KnownBone ear("temporal-bone");
  constexpr const char* kId = "facial.mastoid-identified";
  ear.cut(known_line(kEar, "nerve cover 0.5"));
  EXPECT_GT(*ear.outcome(kId).value, 0.9);
  ear.cut(known_line(kEar, "nerve cover 0.9"));
  EXPECT_TRUE(ear.met(kId)) << *ear.outcome(kId).value;
  ear.cut(known_line(kEar, "nerve cover 2.0"));
  EXPECT_FALSE(ear.met(kId)) << *ear.outcome(kId).value;
  ear.cut("box 3.5 9 -8 27 14 20 ; -tube facial_nerve,_mastoid_part 4.25");
  EXPECT_LE(*ear.outcome(kId).value, 0.25) << "under 3 mm";
}

TEST(KnownBones, AHoleInThePlateIsAsLargeAsItIs) {
  BURR_NEEDS_DATA("known_bones/nerve.txt");
  KnownBone ear("temporal-bone");
  ear.cut(known_line(kEar, "nerve cover 0.5, hole 0.5 mm2"));
  EXPECT_TRUE(ear.met("facial.not-bare"));
  EXPECT_NEAR(*ear.outcome("facial.not-bare").value * 1e6, 0.5, 0.35);
  ear.cut(known_line(kEar, "nerve cover 0.5, hole 2.0 mm2"));
  EXPECT_FALSE(ear.met("facial.not-bare"));
}

// The bone behind y = 8 mm is gone each time, so that what is kept is a merit.
TEST(KnownBones, ACanalWallMayBeThinnedEvenlyAndNotHoled) {
  KnownBone ear("temporal-bone");
  ear.cut("half 0 1 0 8");
  EXPECT_TRUE(ear.met("canal-wall.kept"));
  ear.cut("half 0 1 0 8 ; cyl 7 0 0.3 7 9 0.3 1.5");
  EXPECT_FALSE(ear.met("canal-wall.kept")) << *ear.outcome("canal-wall.kept").value;
  ear.cut("half 0 1 0 2 ; -tube ear_canal 5.2");  // the canal's radius is 4.1 to 4.2 mm here
  EXPECT_TRUE(ear.met("canal-wall.kept")) << *ear.outcome("canal-wall.kept").value;
}

}  // namespace
}  // namespace burr::scoring
