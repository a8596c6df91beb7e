// What a header says of its values is believed only as far as the values bear it out.
#include "burr/io/read/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "burr/io/read/read_scan.h"
#include "burr/io/read/samples.h"
#include "support/body.h"
#include "support/data.h"

namespace burr::io {
namespace {

using test::Body;

std::string all_of(const Scan& scan) {
  std::string text = scan.hounsfield ? "HU\n" : "grey\n";
  for (const std::string& n : scan.notices) text += n + "\n";
  return text;
}
bool says(const Scan& scan, const std::string& words) {
  return std::any_of(scan.notices.begin(), scan.notices.end(),
                     [&](const std::string& n) { return n.find(words) != std::string::npos; });
}

// What a header can say.
Claim says_hu() {
  Claim claim;
  claim.hounsfield = claim.clip_below_air = true;
  claim.period = 65536;
  return claim;
}
Claim says_nothing() {
  Claim claim;
  claim.period = 65536;
  return claim;
}

Scan judged(Scan scan, const Claim& claim) {
  const Status status = calibrate(scan, claim);
  EXPECT_TRUE(status.ok());
  return scan;
}

double truth_mm3() {
  static const double volume = test::mm3_above(test::scan_of({}), 300);
  return volume;
}

void add_metal(Scan& scan, float value) {
  for (int k = 10; k < 14; ++k)
    for (int j = 26; j < 30; ++j)
      for (int i = 26; i < 30; ++i)
        scan.values[static_cast<std::size_t>(i + scan.size.x() * (j + scan.size.y() * k))] = value;
}

TEST(Calibration, AnOrdinaryCtIsBelievedAndAssumed) {
  for (const double noise : {5.0, 20.0, 80.0})
    for (const float metal : {1000.0F, 3071.0F, 30000.0F})
      for (const Claim& claim : {says_hu(), says_nothing()}) {
        Body body;
        body.noise = noise;
        Scan scan = test::scan_of(body);
        add_metal(scan, metal);
        const Scan out = judged(scan, claim);
        EXPECT_TRUE(out.hounsfield) << noise << " " << metal << all_of(out);
        EXPECT_FALSE(out.outside.has_value()) << all_of(out);
        EXPECT_EQ(out.notices.empty(), claim.hounsfield && noise < 10) << all_of(out);
        EXPECT_TRUE(claim.hounsfield || out.values == scan.values) << "nothing is changed";
      }
}

TEST(Calibration, FillsAreNoValues) {
  for (const float fill : {-2000.0F, -3024.0F, -8192.0F, -9999.0F, -32768.0F, 32767.0F, 65535.0F})
    for (const double radius : {10.5, 12.5})  // all air is replaced, or only some of it
      for (const Claim& claim : {says_hu(), says_nothing()}) {
        Scan scan = test::scan_of({});
        test::fill_outside(scan, radius, fill);
        const Scan out = judged(scan, claim);
        EXPECT_TRUE(out.hounsfield) << fill << " " << radius << " " << all_of(out);
        EXPECT_NEAR(test::mm3_above(out, 300), truth_mm3(), 0.005 * truth_mm3())
            << fill << " " << radius << " " << all_of(out);
        EXPECT_EQ(out.values.front(), -1024) << fill << all_of(out);
        EXPECT_TRUE(says(out, "not measured")) << all_of(out);
      }
}

TEST(Calibration, AirThatIsZeroOrNoNumberIsOutside) {
  Scan zero = test::scan_of({});
  test::fill_outside(zero, 11.2, 0.0F);
  Scan out = judged(zero, says_nothing());
  EXPECT_TRUE(out.hounsfield) << all_of(out);
  ASSERT_TRUE(out.outside.has_value());
  EXPECT_EQ(*out.outside, 0);
  Scan none = test::scan_of({});
  test::fill_outside(none, 11.2, std::numeric_limits<float>::quiet_NaN());
  Claim claim = says_nothing();
  claim.broken = static_cast<std::size_t>(
      std::count_if(none.values.begin(), none.values.end(), [](float v) { return std::isnan(v); }));
  out = judged(none, claim);
  EXPECT_TRUE(out.hounsfield) << all_of(out);
  EXPECT_EQ(out.values.front(), -1024);
  EXPECT_TRUE(says(out, "no finite number")) << all_of(out);
}

TEST(Calibration, ShiftedValuesAreNotHounsfieldUnitsWhateverTheHeaderSays) {
  for (const double shift : {1000.0, 1024.0, 8192.0, 32768.0, -8192.0})
    for (const double noise : {5.0, 30.0}) {
      Body body;
      body.intercept = shift;
      body.noise = noise;
      Scan scan = test::scan_of(body);
      if (shift < 2000 && shift > 0)  // as an unsigned type cuts them off
        for (float& v : scan.values) v = std::max(v, 0.0F);
      for (const Claim& claim : {says_hu(), says_nothing()}) {
        const Scan out = judged(scan, claim);
        EXPECT_FALSE(out.hounsfield) << shift << " " << all_of(out);
        EXPECT_EQ(says(out, "The header says Hounsfield units, but"), claim.hounsfield)
            << all_of(out);
      }
    }
}

TEST(Calibration, PicturesOfOtherScalesAreNotHounsfieldUnits) {
  Body window;  // 8 bit
  window.slope = 255.0 / 2500;
  window.intercept = 1000 * window.slope;
  Scan eight = test::scan_of(window);
  for (float& v : eight.values) v = std::clamp(v, 0.0F, 255.0F);
  add_metal(eight, 255);
  Body share;  // 0..1
  share.slope = 1 / 2500.0;
  share.intercept = 0.42;
  share.whole = false;
  Body magnetic;  // bone is dark, fat is bright
  magnetic.air = 20;
  magnetic.soft = 500;
  magnetic.bone = 60;
  for (const Scan& scan : {eight, test::scan_of(share)})
    for (const Claim& claim : {says_hu(), says_nothing()})
      EXPECT_FALSE(judged(scan, claim).hounsfield) << all_of(judged(scan, claim));
  EXPECT_FALSE(judged(test::scan_of(magnetic), says_nothing()).hounsfield);
  // phase pictures run from -4096 to 4095, or -1000 to 1000, and most of it is noise
  std::mt19937 random(3);
  for (const double most : {1000.0, 4095.0}) {
    std::uniform_real_distribution<double> any(-most, most);
    Scan phase = test::scan_of({});
    for (float& v : phase.values) v = static_cast<float>(std::round(any(random)));
    EXPECT_FALSE(judged(phase, says_nothing()).hounsfield) << most;
  }
  Claim other = says_nothing();
  other.can_be_hounsfield = false;
  EXPECT_FALSE(judged(test::scan_of({}), other).hounsfield) << "a picture of another kind";
}

TEST(Calibration, NothingThatIsRightIsDoubted) {
  Body inside;  // a piece of bone and flesh without any air
  inside.cylinder_mm = 1000;
  Body bone = inside;  // bone alone
  bone.ball_mm = 1000;
  Body brain = inside;  // flesh alone, and thin bone
  brain.ball_mm = 2;
  Body thick = inside;  // cortex and marrow
  thick.soft = 180;
  thick.bone = 1500;
  for (const Body& body : {inside, bone, brain, thick}) {
    const Scan out = judged(test::scan_of(body), says_hu());
    EXPECT_TRUE(out.hounsfield) << all_of(out);
    EXPECT_TRUE(out.notices.empty()) << all_of(out);
  }
  Scan lossy = test::scan_of({});  // compression blurred what lay outside the field of view
  test::fill_outside(lossy, 10, -2000.0F);
  std::mt19937 random(9);
  std::normal_distribution<double> blur(0, 30);
  for (float& v : lossy.values)
    if (v == -2000) v = static_cast<float>(std::round(-2000 + blur(random)));
  EXPECT_TRUE(judged(lossy, says_hu()).hounsfield) << all_of(judged(lossy, says_hu()));
  Scan steps = test::scan_of({});  // a slope of 10
  for (float& v : steps.values) v = 10 * std::round(v / 10);
  EXPECT_TRUE(judged(steps, says_hu()).hounsfield);
  EXPECT_FALSE(judged(steps, says_hu()).outside.has_value());
  EXPECT_TRUE(judged(steps, says_nothing()).hounsfield);
  Body clean;  // without noise, half of the voxels have the same value
  clean.noise = 0;
  const Scan out = judged(test::scan_of(clean), says_hu());
  EXPECT_TRUE(out.hounsfield && out.notices.empty()) << all_of(out);
}

TEST(Calibration, NumbersOfTheOtherSignAreMended) {
  for (const double period : {65536.0, 4096.0}) {
    Scan scan = test::scan_of({});
    for (float& v : scan.values)
      if (v < 0) v += static_cast<float>(period);
    Claim claim = says_hu();
    claim.period = period;
    const Scan out = judged(scan, claim);
    EXPECT_TRUE(out.hounsfield) << all_of(out);
    EXPECT_TRUE(says(out, "read as signed numbers")) << all_of(out);
    EXPECT_NEAR(test::mm3_above(out, 300), truth_mm3(), 1e-9);
  }
  Body body;
  body.intercept = 32768;
  Scan scan = test::scan_of(body);
  const Scan right = scan;
  for (float& v : scan.values)
    if (v > 32767) v -= 65536;
  const Scan out = judged(scan, says_hu());
  EXPECT_TRUE(says(out, "read as unsigned numbers")) << all_of(out);
  EXPECT_FALSE(out.hounsfield);
  EXPECT_TRUE(out.values == right.values);
}

TEST(Calibration, PaddingWithoutHounsfieldUnitsStaysOutOfEveryCount) {
  Body body;
  body.intercept = 1300;
  Scan scan = test::scan_of(body);
  test::fill_outside(scan, 12, std::numeric_limits<float>::quiet_NaN());
  Claim claim = says_nothing();
  claim.padded = 1;
  const Scan out = judged(scan, claim);
  ASSERT_TRUE(out.outside.has_value()) << all_of(out);
  float low = 1e9F;
  for (const float v : scan.values)
    if (!std::isnan(v)) low = std::min(low, v);
  EXPECT_LT(*out.outside, low);
  EXPECT_GE(*out.outside, low - 1);
  EXPECT_EQ(*out.outside, std::floor(*out.outside)) << "whole numbers stay whole";
  EXPECT_EQ(out.values.front(), *out.outside);
  // a fill that is only guessed stays in the values
  Scan guessed = test::scan_of(body);
  test::fill_outside(guessed, 12, -9999.0F);
  const Scan same = judged(guessed, says_nothing());
  EXPECT_FALSE(same.hounsfield);
  EXPECT_EQ(same.outside.value_or(0), -9999) << all_of(same);
  EXPECT_TRUE(same.values == guessed.values);
  // but not above all others, where it would be bone
  test::fill_outside(guessed, 12, 65535.0F);
  const Scan lower = judged(guessed, says_nothing());
  EXPECT_LT(lower.values.front(), 1000) << all_of(lower);
  EXPECT_EQ(lower.values.front(), lower.outside.value_or(0));
}

TEST(Calibration, LabelsStayLabelsAndOldRecordingsKeepTheirRules) {
  Scan body = test::scan_of({});
  VoxelSink labels(body.values.size());
  std::vector<float> numbers;
  for (const float v : body.values) numbers.push_back(v > 600 ? 1200.0F : v > -480 ? 40.0F : 0.0F);
  labels.add(numbers.data(), numbers.size());
  Scan out;
  out.size = body.size;
  ASSERT_TRUE(labels.finish(out, false).ok());
  EXPECT_FALSE(out.labels.empty());
  for (const bool check : {true, false}) {
    Scan filled = body;
    test::fill_outside(filled, 10.5, -32768.0F);
    VoxelSink grey(filled.values.size());
    grey.add(filled.values.data(), filled.values.size());
    Scan read;
    read.size = filled.size;
    ASSERT_TRUE(grey.finish(read, false, check).ok());
    EXPECT_TRUE(read.labels.empty());
    EXPECT_EQ(read.hounsfield, check) << all_of(read);
    EXPECT_EQ(read.values.front(), check ? -1024.0F : -32768.0F);
  }
}

// ---- the files of ../shared/data/reports

Result<Scan> report(const std::string& name, const ReadOptions& options = {}) {
  NoProgress progress;
  return read_scan(test::data_dir() / "reports" / name, options, progress);
}

TEST(Calibration, TheReportsThatAreHounsfieldUnitsAreReadAsSuch) {
  BURR_NEEDS_DATA("reports/C00_control/dcm");
  const auto control = report("C00_control/dcm");
  ASSERT_TRUE(control.ok());
  EXPECT_TRUE(control->notices.empty()) << all_of(*control);
  const double truth = test::mm3_above(*control, 300);
  for (const char* name :
       {"D07_sign_mixup/dcm", "D14_photon_counting/dcm", "D14_photon_counting/pcct.nii.gz",
        "D14_photon_counting/pad_only.nii.gz", "D14_photon_counting/metal_only.nii.gz",
        "D15_intercept_without_slope/no_slope", "D15_intercept_without_slope/empty_slope",
        "D19_hu_mod/HU_MOD", "D19_hu_mod/US", "D29_ge_16bit_padding/ge",
        "N17_background_fill/m32768.nii.gz", "N17_background_fill/zero.nii.gz",
        "N17_background_fill/nan.nii.gz"}) {
    const auto scan = report(name);
    ASSERT_TRUE(scan.ok()) << name << ": " << scan.error().text;
    EXPECT_TRUE(scan->hounsfield) << name << ": " << all_of(*scan);
    EXPECT_NEAR(test::mm3_above(*scan, 300), truth, 0.01 * truth) << name << all_of(*scan);
  }
}

TEST(Calibration, TheReportsThatAreNotSaySo) {
  BURR_NEEDS_DATA("reports/C00_control/dcm");
  for (const char* name : {"D06_cbct_offset/dcm", "D07_sign_mixup/unsigned_said_signed"}) {
    const auto scan = report(name);
    ASSERT_TRUE(scan.ok()) << name;
    EXPECT_FALSE(scan->hounsfield) << name;
    EXPECT_TRUE(says(*scan, "The header says Hounsfield units, but")) << name << all_of(*scan);
  }
  for (const char* name :
       {"D08_cbct_padding_no_hu/pad", "D08_cbct_padding_no_hu/nopad", "D30_craniofacial/cf",
        "N17_background_fill/plus1024.nii.gz", "N08_8bit_grey_as_labels/full_noise10.nii.gz"}) {
    const auto scan = report(name);
    ASSERT_TRUE(scan.ok()) << name;
    EXPECT_FALSE(scan->hounsfield) << name << all_of(*scan);
  }
  const auto padded = report("D08_cbct_padding_no_hu/pad");
  EXPECT_TRUE(padded->outside.has_value()) << all_of(*padded);
  ReadOptions old;
  old.check_values = false;
  EXPECT_TRUE(report("D06_cbct_offset/dcm", old)->hounsfield) << "as recordings of before need it";
}

}  // namespace
}  // namespace burr::io
