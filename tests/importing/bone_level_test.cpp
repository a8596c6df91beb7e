// The level of bone in scans that are not in Hounsfield units, against scans whose level is known.
#include "burr/importing/bone_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "burr/importing/import.h"
#include "burr/io/read/read_scan.h"
#include "support/body.h"
#include "support/data.h"

namespace burr::importing {
namespace {

using test::Body;

BoneLevel level_of(const io::Scan& scan) {
  return estimate_bone_level(scan, math::Ijk::Zero(), scan.size);
}

// A dense block, to be milled: metal in the scan.
void add_metal(io::Scan& scan, float value) {
  for (int k = 10; k < 14; ++k)
    for (int j = 26; j < 30; ++j)
      for (int i = 26; i < 30; ++i)
        scan.values[static_cast<std::size_t>(i + scan.size.x() * (j + scan.size.y() * k))] = value;
}

TEST(BoneLevel, IsThatOf300HuWhateverTheScaleOfTheValues) {
  struct Scale {
    double slope, intercept;
    bool whole;
  };
  for (const Scale& scale : {Scale{1, 1000, true},
                             {1, 8192, true},
                             {0.4, 700, true},
                             {0.05, 55, true},
                             {12, -40, true},
                             {1e-3, 1.5, false},
                             {1, -30000, true}}) {
    Body body;
    body.slope = scale.slope;
    body.intercept = scale.intercept;
    body.whole = scale.whole;
    const BoneLevel level = level_of(test::scan_of(body));
    EXPECT_TRUE(level.found);
    EXPECT_EQ(level.sure, Sure::high) << level.why;
    EXPECT_NEAR((level.level - scale.intercept) / scale.slope, 300, 30) << level.why;
  }
}

TEST(BoneLevel, NoisePaddingAndMetalDoNotMoveTheBone) {
  const Body clean{.noise = 0};
  const double truth = test::mm3_above(test::scan_of(clean), 300);
  for (const double noise : {0.0, 5.0, 20.0, 60.0})
    for (const float metal : {0.0F, 15000.0F, 60000.0F})
      for (const bool padded : {false, true}) {
        Body body;
        body.noise = noise;
        body.intercept = 1200;
        io::Scan scan = test::scan_of(body);
        if (metal > 0) add_metal(scan, metal);
        if (padded) {
          test::fill_outside(scan, 12.5, 0.0F);
          scan.outside = 0.0F;
        }
        const BoneLevel level = level_of(scan);
        EXPECT_NEAR(test::mm3_above(scan, level.level), truth, 0.1 * truth)
            << noise << " " << metal << " " << padded << ": " << level.level << " " << level.why;
      }
}

TEST(BoneLevel, SmallBonesAndLargeOnesAndFatAreFound) {
  for (const double ball : {3.0, 9.0})
    for (const double bone : {700.0, 1200.0, 1900.0}) {
      Body body;
      body.intercept = 1024;
      body.ball_mm = ball;
      body.bone = bone;
      EXPECT_NEAR(level_of(test::scan_of(body)).level, 1324, 60) << ball << " " << bone;
    }
}

TEST(BoneLevel, TwoMaterialsArePartedHalfWayAndOneIsNone) {
  Body two;
  two.soft = two.air = 40;
  two.bone = 200;
  two.noise = 3;
  BoneLevel level = level_of(test::scan_of(two));
  EXPECT_NEAR(level.level, 120, 10) << level.why;
  EXPECT_EQ(level.sure, Sure::medium);
  Body one = two;
  one.bone = 40;
  level = level_of(test::scan_of(one));
  EXPECT_FALSE(level.found);
  EXPECT_EQ(level.sure, Sure::low);
}

TEST(BoneLevel, TheImportSaysThatItIsAnEstimateAndOldRecordingsGetOtsu) {
  Body body;
  body.intercept = 1024;
  const io::Scan scan = test::scan_of(body);
  const auto plan = plan_import(scan, {});
  ASSERT_TRUE(plan.ok()) << plan.error().text;
  EXPECT_TRUE(plan->iso_estimated);
  EXPECT_FALSE(plan->iso_by_otsu);
  EXPECT_EQ(plan->iso_sure, Sure::high);
  EXPECT_NEAR(plan->iso, 1324, 40);
  EXPECT_NE(plan->notices.front().find("estimate"), std::string::npos) << plan->notices.front();
  EXPECT_NE(plan->notices.front().find("`iso`"), std::string::npos);
  scenario::BoneRecipe old;
  old.check_values = false;
  const auto before = plan_import(scan, old);
  ASSERT_TRUE(before.ok());
  EXPECT_TRUE(before->iso_by_otsu);
  EXPECT_FALSE(before->iso_estimated);
  EXPECT_NEAR(before->iso, 600, 150) << "Otsu parts air from all else: the skin";
  scenario::BoneRecipe given;
  given.iso = 1500;
  EXPECT_FALSE(plan_import(scan, given)->iso_estimated);
}

TEST(BoneLevel, AFillFarAwayCostsTheBoneNoDetail) {
  Body body;
  body.slope = 1 / 2500.0;  // 0..1
  body.intercept = 0.42;
  body.whole = false;
  const io::Scan clean = test::scan_of(body);
  NoProgress progress;
  const auto truth = import_bone(clean, {}, progress);
  ASSERT_TRUE(truth.ok());
  for (const float fill : {-9999.0F, -1e6F}) {
    io::Scan scan = clean;
    test::fill_outside(scan, 12.5, fill);
    scan.outside = fill;
    const auto made = import_bone(scan, {}, progress, true);
    ASSERT_TRUE(made.ok()) << made.error().text;
    EXPECT_NEAR(made->summary.solid_mm3, truth->summary.solid_mm3, 0.01 * truth->summary.solid_mm3);
    EXPECT_GT(made->summary.low, -1) << "the range is that of what was measured";
    EXPECT_GT(made->greys->least, -1);
  }
}

struct Real {
  const char* path;
  double least, most;  // volume of the estimate over that of 300 HU
};

// Real scans without their HU.
class BoneLevelOfRealScans : public testing::TestWithParam<Real> {};

TEST_P(BoneLevelOfRealScans, IsNear300Hu) {
  BURR_NEEDS_DATA(GetParam().path);
  NoProgress progress;
  auto scan = io::read_scan(test::data_dir() / GetParam().path, {}, progress);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  ASSERT_TRUE(scan->hounsfield);
  const double truth = test::mm3_above(*scan, 300);
  for (float& v : scan->values) v = 0.4F * v + 900.0F;
  scan->hounsfield = false;
  const BoneLevel level = level_of(*scan);
  const double ratio = test::mm3_above(*scan, level.level) / truth;
  RecordProperty("ratio", std::to_string(ratio));
  EXPECT_GT(ratio, GetParam().least) << (level.level - 900) / 0.4 << " HU: " << level.why;
  EXPECT_LT(ratio, GetParam().most) << (level.level - 900) / 0.4 << " HU: " << level.why;
}

INSTANTIATE_TEST_SUITE_P(Shared, BoneLevelOfRealScans,
                         testing::Values(Real{"head_ct/ct_example.nii.gz", 0.9, 1.1},
                                         Real{"headsq/headsq_hu.mha", 0.7, 1.3},
                                         Real{"jaw_cbct/jaw_cbct_half_0.4mm.nii.gz", 0.7, 1.3},
                                         Real{"spine_lumbar/example_ct.nii.gz", 0.8, 1.2},
                                         Real{"spine_lumbar/example_ct_dicom", 0.7, 1.2},
                                         Real{"spine_thorax/LIDC-IDRI-0314_spine_crop.nii.gz", 0.8,
                                              1.2},
                                         Real{"skull_phantom/std_5mm_jpegll", 0.7, 1.2}));

}  // namespace
}  // namespace burr::importing
