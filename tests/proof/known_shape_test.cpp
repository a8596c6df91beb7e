// Shapes against what a ruler says, the language against every mistake, and a bone that is cut and made whole again.
#include "burr/proof/known_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/proof/cut.h"
#include "burr/proof/known_bone.h"
#include "burr/volume/sample.h"

namespace burr::proof {
namespace {

using math::Vec3;

const Places kPlaces = {{"an axis", {{{1, 2, 3}, {1, 2, -7}}, {}}},
                        {"a bow", {{{0, 0, 0}, {4, 0, 0}, {4, 6, 0}}, {}}},
                        {"a face", {{{0, 5, 0}}, Vec3(0, 1, 0)}},
                        {"a point", {{{7, 8, 9}}, {}}}};

double depth(const std::string& shapes, const Vec3& at) {
  const auto work = read_work(shapes, kPlaces);
  EXPECT_TRUE(work) << work.error().text;
  return work ? work->gone(at) : NAN;
}

TEST(Shape, HasTheDepthThatARulerSays) {
  EXPECT_DOUBLE_EQ(depth("ball 1 2 3 2", {1, 2, 4}), 1);
  EXPECT_DOUBLE_EQ(depth("cyl 0 0 0 0 0 10 2", {1.5, 0, 5}), 0.5);
  EXPECT_DOUBLE_EQ(depth("cyl 0 0 0 0 0 10 2", {0, 0, 10.25}), -0.25) << "a flat end";
  EXPECT_DOUBLE_EQ(depth("cap 0 0 0 0 0 10 2", {0, 0, 10.25}), 1.75) << "a round end";
  EXPECT_DOUBLE_EQ(depth("box 0 0 0 2 4 6", {0.25, 0, 0}), 0.75);
  EXPECT_DOUBLE_EQ(depth("half 0 0 2 6", {9, 9, 4}), 1) << "n . p > d for a normal of any length";
  EXPECT_DOUBLE_EQ(depth("tube a_bow 1", {4.5, 3, 0}), 0.5);
  EXPECT_DOUBLE_EQ(depth("plane a_face 1", {0, 8, 0}), 2);
  EXPECT_DOUBLE_EQ(depth("slab a_face -1 1", {0, 4.25, 0}), 0.25);
}

TEST(Shape, LiesWhereItsLandmarkDoes) {
  EXPECT_DOUBLE_EQ(depth("ball at a_point 1 0 -1 2", {8, 8, 8}), 2);
  EXPECT_DOUBLE_EQ(depth("ball of a_bow 0.5 0 0 1 2", {4, 1, 1}), 2) << "5 of 10 mm, a mm higher";
  // down from (1, 2, 3): u is x and v is y
  EXPECT_DOUBLE_EQ(depth("ball on an_axis 4 0.5 -0.25 2", {1.5, 1.75, -1}), 2);
  const Frame slanting = frame_of({0, 0, 0}, {3, 0, 4});
  EXPECT_NEAR(slanting.u.dot(slanting.along), 0, 1e-15);
  EXPECT_NEAR(slanting.v.norm(), 1, 1e-15);
  EXPECT_NEAR(frame_of({0, 0, 0}, {5, 0, 0}).u.y(), 1, 1e-15) << "along x";
}

TEST(Shape, SignsSayWhatIsKeptCutAndAdded) {
  EXPECT_LT(depth("ball 0 0 0 3 ; - ball 0 0 0 1", {0, 0, 0}), 0);
  EXPECT_GT(depth("ball 0 0 0 3 ; -ball 0 0 0 1 ; !ball 0 0 0 0.5", {0, 0, 0}), 0);
  EXPECT_DOUBLE_EQ(depth("ball 0 0 0 3 & half 0 0 1 0", {0, 0, 1}), 1) << "what lies in both";
  EXPECT_LT(depth("ball 0 0 0 3 & half 0 0 1 0", {0, 0, -1}), 0);
  const auto work = read_work("+ ball 0 0 0 2", kPlaces);
  ASSERT_TRUE(work);
  EXPECT_DOUBLE_EQ(work->grown({0, 0, 1}), 1);
  EXPECT_LT(work->gone({0, 0, 0}), -1e6) << "nothing is cut";
  EXPECT_LT(depth("", {0, 0, 0}), -1e6);
}

TEST(Shape, SaysWhatIsWrongWithALine) {
  const std::vector<std::pair<const char*, const char*>> wrong = {
      {"bal 0 0 0 1", "no shape"},
      {"ball 0 0 1", "gives no radius"},
      {"ball 0 0 x 1", "\"x\" as its point"},
      {"ball 0 0 0 -1", "a radius of -1"},
      {"ball 0 0 0 1 1", "\"1\" too much"},
      {"ball 0 0 0 1 &", "is empty"},
      {"cyl 0 0 0 0 0 0 1", "begins where it ends"},
      {"half 0 0 0 1", "without length"},
      {"ball at nowhere 0 0 0 1", "\"nowhere\", which is no landmark"},
      {"ball on a_point 0 0 0 1", "no curve"},
      {"plane an_axis 1", "without a normal"},
      {"ball 0 0 nan 1", "\"nan\" as its point"},
      {"tube", "gives no landmark"}};
  for (const auto& [line, why] : wrong) {
    const auto work = read_work(line, kPlaces);
    ASSERT_FALSE(work) << line;
    EXPECT_NE(work.error().text.find(why), std::string::npos) << line << ": " << work.error().text;
  }
}

TEST(KnownBone, IsCutWhereTheShapeIsAndMadeWholeAgain) {
  NoProgress quiet;
  auto block = KnownBone::make({.case_name = "block", .voxel_mm = 1}, quiet);
  ASSERT_TRUE(block) << block.error().text;
  const std::uint64_t untouched = block->before().content_hash();
  const auto share_at = [&](const Vec3& mm) {
    return volume::sample(block->after(), block->after().grid().grid_from_world(mm * 1e-3));
  };
  ASSERT_TRUE(block->cut("ball 0 0 0 6 ; + ball 0 0 14 2", quiet));
  EXPECT_NEAR(share_at({6, 0, 0}), 0.5, 0.03) << "on the surface of the ball";
  EXPECT_NEAR(share_at({6.5, 0, 0}), 0.625, 0.03) << "half a voxel inside the bone";
  EXPECT_EQ(share_at({0, 0, 0}), 0);
  EXPECT_NEAR(share_at({0, 0, 16}), 0.5, 0.06) << "added";
  ASSERT_TRUE(block->cut("", quiet));
  EXPECT_EQ(block->after().content_hash(), untouched);
  const auto* cleared = block->outcome("groove.cleared");
  ASSERT_NE(cleared, nullptr);
  EXPECT_EQ(cleared->verdict, scoring::Verdict::unmet);
  EXPECT_EQ(block->outcome("strokes.long"), nullptr) << "it needs a recording";
}

TEST(KnownBone, SaysWhichCaseItCannotMake) {
  NoProgress quiet;
  EXPECT_FALSE(KnownBone::make({.case_name = "block", .bone_number = 1}, quiet)) << "one bone only";
  EXPECT_FALSE(KnownBone::make({.case_name = "no-case"}, quiet));
}

}  // namespace
}  // namespace burr::proof
