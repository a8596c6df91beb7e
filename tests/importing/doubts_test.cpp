// What burr makes of a scan that it doubts, and how sure it says it is: reports of scans that went
// wrong, with the right volumes, and bodies made here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "burr/importing/cut_off.h"
#include "burr/importing/import.h"
#include "burr/importing/scan_notes.h"
#include "burr/io/read/read_scan.h"
#include "support/body.h"
#include "support/data.h"

namespace burr::importing {
namespace {

using math::Ijk;
using math::Vec3;
using test::Body;

// The ball and the block of the reports, by marching cubes at 300 HU.
constexpr double kTrueMm3 = 960.5;

Result<io::Scan> report(const std::string& name) {
  NoProgress progress;
  return io::read_scan(test::data_dir() / "reports3" / name, {}, progress);
}
Result<Imported> made_of(const io::Scan& scan, const scenario::BoneRecipe& recipe = {}) {
  NoProgress progress;
  return import_bone(scan, recipe, progress);
}
bool says(const std::vector<std::string>& notices, const std::string& words) {
  return std::any_of(notices.begin(), notices.end(),
                     [&](const std::string& one) { return one.find(words) != std::string::npos; });
}
std::string all_of(const std::vector<std::string>& notices) {
  std::string text;
  for (const std::string& one : notices) text += one + "\n";
  return text;
}
// A refused plan, and what it says.
std::string refusal(const io::Scan& scan, const scenario::BoneRecipe& recipe = {}) {
  const auto plan = plan_import(scan, recipe);
  EXPECT_FALSE(plan.ok());
  return plan.ok() ? std::string() : plan.error().text;
}

TEST(ImportDoubts, InvertedValuesGiveTheSameBoneAsHounsfieldUnits) {
  BURR_NEEDS_DATA("reports3/X2_mono1");
  const auto inverted = report("X2_mono1/inverted.zip");
  const auto control = report("X2_mono1/hu_control.zip");
  ASSERT_TRUE(inverted.ok() && control.ok());
  const auto right = made_of(*control), turned = made_of(*inverted);
  ASSERT_TRUE(right.ok()) << right.error().text;
  ASSERT_TRUE(turned.ok()) << turned.error().text;
  EXPECT_NEAR(right->summary.solid_mm3, kTrueMm3, 0.03 * kTrueMm3);
  EXPECT_NEAR(turned->summary.solid_mm3, kTrueMm3, 0.05 * kTrueMm3)
      << all_of(turned->summary.notices);
}

TEST(ImportDoubts, AbsentSlicesStopUntilTheyAreAllowed) {
  BURR_NEEDS_DATA("reports3/X3_absent");
  for (const char* name :
       {"dicomdir", "images_in_acquisition.zip", "concatenation_without_first.zip"}) {
    const auto scan = report(std::string("X3_absent/") + name);
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    const std::string why = refusal(*scan);
    EXPECT_NE(why.find("so slices are missing"), std::string::npos) << why;
    EXPECT_NE(why.find("`allow_missing`"), std::string::npos) << why;
    scenario::BoneRecipe allowed;
    allowed.allow_missing = true;
    const auto plan = plan_import(*scan, allowed);
    ASSERT_TRUE(plan.ok()) << plan.error().text;
    EXPECT_TRUE(says(plan->notices, "used all the same (`allow_missing`)"))
        << all_of(plan->notices);
  }
}

TEST(ImportDoubts, WhatIsNoCtStopsUntilItIsWantedAsItIs) {
  BURR_NEEDS_DATA("reports3/X6_not_ct");
  const auto scan = report("X6_not_ct/mr_t1.zip");
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  const std::string why = refusal(*scan);
  EXPECT_NE(why.find("(MR): bone is dark"), std::string::npos) << why;
  EXPECT_NE(why.find("`as_it_is`"), std::string::npos) << why;
  scenario::BoneRecipe wanted;
  wanted.as_it_is = true;
  const auto plan = plan_import(*scan, wanted);
  ASSERT_TRUE(plan.ok()) << plan.error().text;
  EXPECT_TRUE(says(plan->notices, "used all the same (`as_it_is`)")) << all_of(plan->notices);
  EXPECT_EQ(plan->modality, "MR");
}

TEST(ImportDoubts, CutOffValuesAreSaidAndNothingIsSure) {
  BURR_NEEDS_DATA("reports3/X5_clipped_values");
  for (const char* name : {"w_m200_1300", "w_m200_1300_bone1400", "w_m160_240"}) {
    const auto scan = report(std::string("X5_clipped_values/") + name + ".nii.gz");
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    const auto plan = plan_import(*scan, {});
    ASSERT_TRUE(plan.ok()) << plan.error().text;
    EXPECT_TRUE(plan->iso_estimated);
    EXPECT_EQ(plan->iso_sure, Sure::low) << name << "\n" << all_of(plan->notices);
    EXPECT_TRUE(says(plan->notices, "of the voxels hold exactly the lowest value (0)"))
        << all_of(plan->notices);
  }
  // half-way from soft tissue to bone is 300 HU here
  const auto scan = report("X5_clipped_values/w_m200_1300.nii.gz");
  const auto made = made_of(*scan);
  ASSERT_TRUE(made.ok()) << made.error().text;
  EXPECT_NEAR(made->summary.solid_mm3, kTrueMm3, 0.05 * kTrueMm3) << all_of(made->summary.notices);
}

// The same body as a viewer saves it: cut off at both ends of a window.
io::Scan windowed(Body body, double low, double high, bool eight_bit) {
  body.intercept = 0;
  io::Scan scan = test::scan_of(body);
  for (float& value : scan.values) {
    value = std::clamp(value, static_cast<float>(low), static_cast<float>(high));
    if (eight_bit)
      value = std::round((value - static_cast<float>(low)) / static_cast<float>(high - low) * 255);
  }
  return scan;
}

TEST(CutOff, IsFoundAtTheEndsOfAnyWindowAndNotWithout) {
  const auto cut_of = [](const io::Scan& scan) {
    return find_cut_off(
        io::sample_values(scan.values.data(), scan.size, Ijk::Zero(), scan.size, scan.outside));
  };
  for (const double bone : {560.0, 1200.0})
    for (const bool eight_bit : {false, true})
      for (const auto& [low, high] :
           {std::pair{-200.0, 1000.0}, {-160.0, 240.0}, {-500.0, 2000.0}}) {
        const CutOff cut = cut_of(windowed({.bone = bone}, low, high, eight_bit));
        EXPECT_TRUE(cut.low) << low << " " << high << " " << bone << piles_text(cut);
        EXPECT_EQ(cut.high, bone > high + 40) << low << " " << high << " " << bone;
      }
  for (const double noise : {0.0, 3.0, 20.0, 60.0})
    for (const double slope : {0.05, 1.0}) {
      Body body;
      body.noise = noise;
      body.slope = slope;
      const CutOff cut = cut_of(test::scan_of(body));
      EXPECT_FALSE(cut.any()) << noise << " " << slope << " " << piles_text(cut);
    }
  // air whose noise ends at 0, as scanners without negative numbers give it
  Body body;
  body.intercept = 1010;
  io::Scan scan = test::scan_of(body);
  for (float& value : scan.values) value = std::max(value, 0.0F);
  EXPECT_FALSE(cut_of(scan).low) << piles_text(cut_of(scan));
}

TEST(CutOff, HounsfieldUnitsBelowBoneAreRefusedAndAboveItSaid) {
  io::Scan scan = windowed({}, -160, 240, false);
  scan.hounsfield = true;
  const std::string why = refusal(scan);
  EXPECT_NE(why.find("the highest (240)"), std::string::npos) << why;
  EXPECT_NE(why.find("bone begins at 300 HU"), std::string::npos) << why;
  scenario::BoneRecipe own;
  own.iso = 150;
  EXPECT_TRUE(plan_import(scan, own).ok());
  own = {};
  own.as_it_is = true;
  EXPECT_TRUE(plan_import(scan, own).ok());

  scan = windowed({}, -200, 1000, false);
  scan.hounsfield = true;
  const auto plan = plan_import(scan, {});
  ASSERT_TRUE(plan.ok()) << plan.error().text;
  EXPECT_EQ(plan->iso, 300);
  EXPECT_TRUE(says(plan->notices, "cut off, as by the window of a viewer"))
      << all_of(plan->notices);
  io::Scan whole = test::scan_of({});
  whole.hounsfield = true;
  const auto silent = plan_import(whole, {});
  ASSERT_TRUE(silent.ok());
  EXPECT_FALSE(says(silent->notices, "cut off")) << all_of(silent->notices);
}

TEST(ImportDoubts, ABorderOfBoneMakesAnEstimateUnsure) {
  io::Scan scan = test::scan_of({.bone = 560});
  for (float& value : scan.values) value = 3000 - value;  // dark is dense, and nothing says so
  const auto level = estimate_bone_level(scan, Ijk::Zero(), scan.size);
  ASSERT_TRUE(level.found);
  EXPECT_EQ(level.sure, Sure::low) << level.why;
  EXPECT_NE(level.why.find("of the scan's border would be bone"), std::string::npos) << level.why;
}

// ---- what a scan cannot show

io::Scan block(const Ijk& size, const Vec3& spacing_mm) {
  io::Scan scan;
  scan.format = "test";
  scan.hounsfield = true;
  scan.size = size;
  scan.spacing_mm = spacing_mm;
  scan.values.assign(static_cast<std::size_t>(size.prod()), -1000.0F);
  return scan;
}
void fill(io::Scan& scan, const Ijk& from, const Ijk& to) {  // both inside
  for (int k = from.z(); k <= to.z(); ++k)
    for (int j = from.y(); j <= to.y(); ++j)
      for (int i = from.x(); i <= to.x(); ++i)
        scan.values[static_cast<std::size_t>(i + scan.size.x() * (j + scan.size.y() * k))] = 1000;
}

TEST(ScanNotes, TheAreaOfBoneAtEachBorderIsThatOfItsVoxels) {
  io::Scan scan = block({20, 20, 20}, {0.5, 0.5, 1});
  fill(scan, {5, 5, 5}, {9, 9, 9});
  EXPECT_FALSE(says(plan_import(scan, {})->notices, "reaches the border"));
  fill(scan, {5, 5, 10}, {9, 8, 19});  // to the head: 5 x 4 voxels of 0.25 mm2
  fill(scan, {0, 6, 6}, {5, 7, 8});    // to the right: 2 x 3 voxels of 0.5 mm2
  auto plan = plan_import(scan, {});
  ASSERT_TRUE(plan.ok());
  EXPECT_TRUE(says(plan->notices, "reaches the border of the scan: 8 mm2 (right 3, head 5)"))
      << all_of(plan->notices);
  scan.axes.col(0) = -Vec3::UnitX();  // rows to the right, columns to the front
  scan.axes.col(1) = -Vec3::UnitY();
  plan = plan_import(scan, {});
  EXPECT_TRUE(says(plan->notices, "8 mm2 (left 3, head 5)")) << all_of(plan->notices);
  scenario::BoneRecipe region;
  region.region = scenario::Region{{4, 12}, {3, 12}, {3, 12}};
  plan = plan_import(scan, region);
  ASSERT_TRUE(plan.ok());
  EXPECT_TRUE(says(plan->notices, "border of the region")) << all_of(plan->notices);
  // one voxel alone is noise
  io::Scan dotted = block({20, 20, 20}, {2, 2, 2});
  fill(dotted, {5, 5, 5}, {9, 9, 9});
  fill(dotted, {3, 3, 0}, {3, 3, 0});
  EXPECT_FALSE(says(plan_import(dotted, {})->notices, "reaches the border"));
}

TEST(ScanNotes, LabelsAtTheBorderCountWhereTheyAreSolid) {
  io::Scan scan = block({10, 10, 10}, {1, 1, 1});
  fill(scan, {3, 3, 0}, {6, 6, 5});
  scan.labels.resize(scan.values.size());
  for (std::size_t v = 0; v < scan.values.size(); ++v) scan.labels[v] = scan.values[v] > 0 ? 1 : 0;
  scan.values.clear();
  scan.hounsfield = false;
  scan.label_names = {{1, "mandible"}};
  auto plan = plan_import(scan, {});
  ASSERT_TRUE(plan.ok()) << plan.error().text;
  EXPECT_TRUE(says(plan->notices, "16 mm2 (feet 16)")) << all_of(plan->notices);
}

TEST(ScanNotes, FewAndThickSlicesAreSaid) {
  const auto notices = [](int slices, double gap) {
    io::Scan scan = block({20, 20, slices}, {0.5, 0.5, gap});
    fill(scan, {5, 5, 1}, {9, 9, 2});
    const auto plan = plan_import(scan, {});
    EXPECT_TRUE(plan.ok());
    return plan.ok() ? plan->notices : std::vector<std::string>();
  };
  EXPECT_TRUE(says(notices(4, 1), "There are only 4 slices"));
  EXPECT_FALSE(says(notices(5, 1), "There are only"));
  EXPECT_TRUE(says(notices(9, 3.5), "The slices lie 3.5 mm apart"));
  EXPECT_FALSE(says(notices(9, 3), "mm apart"));
}

}  // namespace
}  // namespace burr::importing
