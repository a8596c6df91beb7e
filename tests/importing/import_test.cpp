#include "burr/importing/import.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "burr/volume/volume_of.h"
#include "io/folder_of_test.h"

namespace burr::importing {
namespace {

using math::Ijk;
using math::Vec3;
using volume::Bone;

// A grey scan of a function of the position in mm; the origin is the middle of the grid.
io::Scan grey_scan(const Ijk& size, const Vec3& spacing_mm,
                   const std::function<double(const Vec3&)>& value) {
  io::Scan scan;
  scan.size = size;
  scan.spacing_mm = spacing_mm;
  scan.origin_mm = -0.5 * (size - Ijk::Ones()).cast<double>().cwiseProduct(spacing_mm);
  scan.hounsfield = true;
  scan.format = "test";
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i)
        scan.values.push_back(
            static_cast<float>(value(scan.origin_mm + Vec3(i, j, k).cwiseProduct(spacing_mm))));
  return scan;
}

io::Scan label_scan(const Ijk& size, const Vec3& spacing_mm,
                    const std::function<int(const Vec3&)>& label) {
  io::Scan scan = grey_scan(size, spacing_mm, [&](const Vec3& p) { return label(p); });
  scan.labels.assign(scan.values.begin(), scan.values.end());
  scan.values.clear();
  scan.hounsfield = false;
  return scan;
}

std::unique_ptr<Bone> import_or_fail(const io::Scan& scan,
                                     const scenario::BoneRecipe& options = {}) {
  NoProgress progress;
  auto made = import_bone(scan, options, progress);
  EXPECT_TRUE(made.ok()) << made.error().text;
  return made.ok() ? std::move(made->bone) : nullptr;
}

double field(const Bone& bone, const Vec3& p_grid) {
  const Ijk i = p_grid.array().floor().cast<int>();
  const Vec3 t = p_grid - i.cast<double>();
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const Ijk d(c & 1, c >> 1 & 1, c >> 2);
    double w = 1;
    for (int a = 0; a < 3; ++a) w *= d[a] != 0 ? t[a] : 1 - t[a];
    sum += w * bone.field(i.x() + d.x(), i.y() + d.y(), i.z() + d.z());
  }
  return sum;
}

// Where a ray from inside leaves the bone [mm from `from_mm`], and the error of the normal there.
struct Exit {
  double at_mm = 0;
  Vec3 normal = Vec3::Zero();  // out of the bone
};
Exit leave(const Bone& bone, const Vec3& from_mm, const Vec3& direction, double most_mm) {
  const auto value = [&](double t) {
    return field(bone, bone.grid().grid_from_world(1e-3 * (from_mm + t * direction))) - 32768;
  };
  const double step = 0.1 * bone.grid().voxel * 1e3;
  double lo = 0;
  while (lo < most_mm && value(lo + step) > 0) lo += step;
  double hi = lo + step;
  for (int n = 0; n < 40; ++n) (value(0.5 * (lo + hi)) > 0 ? lo : hi) = 0.5 * (lo + hi);
  Exit exit;
  exit.at_mm = lo;
  const Vec3 p = bone.grid().grid_from_world(1e-3 * (from_mm + lo * direction));
  for (int a = 0; a < 3; ++a) {
    const Vec3 h = 0.5 * Vec3::Unit(a);
    exit.normal[a] = field(bone, p - h) - field(bone, p + h);
  }
  exit.normal = (bone.grid().frame.q * exit.normal).normalized();
  return exit;
}

double angle_deg(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180 / M_PI;
}

// a ball as in a scanner's picture: a blurred step, -1000 to 1000 HU, half-way at the radius
double ct_ball(const Vec3& p, double radius, double blur) {
  return -1000.0 * std::erf((p.norm() - radius) / (std::sqrt(2.0) * blur));
}

struct Errors {
  double worst_mm = 0, mean_deg = 0, worst_deg = 0;
};
Errors ball_errors(const Bone& bone, double radius, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Errors e;
  constexpr int kRays = 2000;
  for (int n = 0; n < kRays; ++n) {
    const Vec3 d = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Exit exit = leave(bone, Vec3::Zero(), d, 2 * radius);
    e.worst_mm = std::max(e.worst_mm, std::abs(exit.at_mm - radius));
    const double off = angle_deg(exit.normal, d);
    e.mean_deg += off / kRays;
    e.worst_deg = std::max(e.worst_deg, off);
  }
  return e;
}

TEST(ImportGrey, ABallOfCtKeepsItsSurfaceAndItsNormals) {
  const io::Scan scan =
      grey_scan({60, 60, 60}, {0.5, 0.5, 0.5}, [](const Vec3& p) { return ct_ball(p, 10, 0.6); });
  scenario::BoneRecipe options;
  options.iso = 0;
  const auto bone = import_or_fail(scan, options);
  ASSERT_TRUE(bone);
  const Errors e = ball_errors(*bone, 10, 1);
  EXPECT_LT(e.worst_mm, 0.05 * 0.5);
  EXPECT_LT(e.mean_deg, 0.3);
  EXPECT_LT(e.worst_deg, 1.0);
  const double truth = 4.0 / 3 * M_PI * 1000;
  EXPECT_NEAR(volume::volume_of(*bone) * 1e9, truth, 0.01 * truth);
}

TEST(ImportGrey, ThickSlicesBecomeCubicAndKeepTheSurface) {
  const io::Scan scan =
      grey_scan({60, 60, 30}, {0.5, 0.5, 1.0}, [](const Vec3& p) { return ct_ball(p, 10, 0.8); });
  scenario::BoneRecipe options;
  options.iso = 0;
  const auto bone = import_or_fail(scan, options);
  ASSERT_TRUE(bone);
  EXPECT_NEAR(bone->grid().voxel, 0.5e-3, 1e-12);
  EXPECT_EQ(bone->grid().size, Ijk(60, 60, 59));
  const Errors e = ball_errors(*bone, 10, 2);
  EXPECT_LT(e.worst_mm, 0.05 * 0.5);
  EXPECT_LT(e.mean_deg, 0.5);
}

TEST(ImportGrey, TheFieldIsTheDistanceWhateverTheContrast) {
  const io::Scan scan = grey_scan({50, 50, 50}, {0.5, 0.5, 0.5},
                                  [](const Vec3& p) { return 600 + 0.4 * ct_ball(p, 9, 0.7); });
  scenario::BoneRecipe options;
  options.iso = 600;
  const auto bone = import_or_fail(scan, options);
  ASSERT_TRUE(bone);
  for (int i = 0; i < 50; ++i) {
    const double off = (9.0 - std::sqrt(std::pow((i - 24.5) * 0.5, 2) + 2 * 0.0625)) / 0.5;
    if (std::abs(off) > 1.9) continue;
    EXPECT_NEAR(bone->field(i, 24, 24), 32768 + off * volume::kFieldPerVoxel,
                0.06 * volume::kFieldPerVoxel)
        << i;
  }
}

TEST(ImportGrey, NoiseIsMeasuredAndSmoothedUntilTouchIsSteady) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> noise(-200, 200);  // 10 % of the step, up and down
  const io::Scan scan = grey_scan({60, 60, 60}, {0.5, 0.5, 0.5}, [&](const Vec3& p) {
    return ct_ball(p, 10, 0.6) + noise(random);
  });
  scenario::BoneRecipe options;
  options.iso = 0;
  options.smooth = 0;
  const auto rough = import_or_fail(scan, options);
  options.smooth = -1;
  NoProgress progress;
  auto made = import_bone(scan, options, progress);
  ASSERT_TRUE(rough && made.ok());
  EXPECT_NEAR(made->summary.smooth, 400 / std::sqrt(12.0), 30) << "a uniform noise of this width";
  const Errors before = ball_errors(*rough, 10, 3), after = ball_errors(*made->bone, 10, 3);
  EXPECT_GT(before.mean_deg, 2) << "the noise matters";
  EXPECT_LT(after.mean_deg, 0.5 * before.mean_deg);
  EXPECT_LT(after.worst_mm, before.worst_mm);
  RecordProperty("mean_deg_before", std::to_string(before.mean_deg));
  RecordProperty("mean_deg_after", std::to_string(after.mean_deg));
}

TEST(ImportGrey, CleanScansAreNotSmoothed) {
  const io::Scan scan =
      grey_scan({40, 40, 40}, {0.5, 0.5, 0.5}, [](const Vec3& p) { return ct_ball(p, 7, 0.6); });
  const auto plan = plan_import(scan, {});
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(plan->smooth, 0);
  EXPECT_EQ(plan->iso, 300) << "CT at 300 HU";
}

using ImportOwnMaterials = test::FolderTest;

TEST(ImportGrey, HuDecidesTheTissueAndTheRimOfCortexStaysCortex) {
  const io::Scan scan = grey_scan({40, 40, 40}, {0.5, 0.5, 0.5}, [](const Vec3& p) {
    const double r = p.norm();
    return r < 5 ? 450.0 : r < 7 ? 1200.0 : r < 7.5 ? 500.0 : -1000.0;  // border half filled
  });
  const auto bone = import_or_fail(scan);
  ASSERT_TRUE(bone);
  EXPECT_EQ(bone->tissue(20, 20, 20), 3) << "trabecular, 450 to 575 HU";
  EXPECT_EQ(bone->tissue(32, 20, 20), 5) << "cortical";
  EXPECT_EQ(bone->tissue(34, 20, 20), 5) << "the half-filled rim";
  EXPECT_GT(bone->tissues()[5].cutting_energy, bone->tissues()[3].cutting_energy);
  EXPECT_EQ(bone->intensity(20, 20, 20), 450);
}

TEST_F(ImportOwnMaterials, ReachEveryKindOfScan) {
  std::ofstream(path("m.toml")) << "[[material]]\nname = \"cortical bone\"\ncutting_energy_J_mm3 = "
                                   "{ value = 1.5, low = 1, high = 2, source = \"a test\", "
                                   "calibrated = true }\n";
  scenario::BoneRecipe options;
  options.materials = path("m.toml");
  io::Scan ct = grey_scan({24, 24, 24}, {0.5, 0.5, 0.5},
                          [](const Vec3& p) { return p.norm() < 4 ? 1200.0 : -1000.0; });
  const auto by_hu = plan_import(ct, options);
  ASSERT_TRUE(by_hu.ok()) << by_hu.error().text;
  EXPECT_NEAR(by_hu->tissues[4].tissue.cutting_energy, 1.5e9, 1) << by_hu->tissues[4].tissue.name;
  EXPECT_NEAR(import_or_fail(ct, options)->tissues()[5].cutting_energy, 1.5e9, 1);
  ct.hounsfield = false;
  EXPECT_NEAR(import_or_fail(ct, options)->tissues()[1].cutting_energy, 1.5e9, 1);
  const io::Scan labels =
      label_scan({24, 24, 24}, {1, 1, 1}, [](const Vec3& p) { return p.norm() < 8 ? 3 : 0; });
  EXPECT_NEAR(import_or_fail(labels, options)->tissues()[1].cutting_energy, 1.5e9, 1);
  options.materials = path("none.toml");
  EXPECT_FALSE(plan_import(ct, options).ok());
}

TEST(ImportGrey, WithoutHuTheLevelIsAnEstimateAndSaysSo) {
  io::Scan scan =
      grey_scan({30, 30, 30}, {1, 1, 1}, [](const Vec3& p) { return p.norm() < 9 ? 200.0 : 40.0; });
  scan.hounsfield = false;
  const auto plan = plan_import(scan, {});
  ASSERT_TRUE(plan.ok());
  EXPECT_TRUE(plan->iso_estimated);
  EXPECT_NEAR(plan->iso, 120, 5);
  EXPECT_NE(plan->notices.front().find("estimate"), std::string::npos);
  scenario::BoneRecipe old;
  old.check_values = false;
  const auto before = plan_import(scan, old);
  ASSERT_TRUE(before.ok());
  EXPECT_TRUE(before->iso_by_otsu);
  EXPECT_NEAR(before->iso, 120, 40);
  EXPECT_NE(before->notices.front().find("Otsu"), std::string::npos);
}

TEST(ImportGrey, ABoneThatIsTurnedStaysTurned) {
  io::Scan scan = grey_scan({40, 44, 48}, {0.5, 0.5, 0.5},
                            [](const Vec3& p) { return ct_ball(p - Vec3(1, 2, 3), 6, 0.6); });
  scan.axes = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  scenario::BoneRecipe options;
  options.iso = 0;
  const auto bone = import_or_fail(scan, options);
  ASSERT_TRUE(bone);
  // the middle of the ball, in the scan's voxels
  const Vec3 ijk = (Vec3(1, 2, 3) - (-0.5 * (scan.size - Ijk::Ones()).cast<double>() * 0.5)) / 0.5;
  const Vec3 middle = scan.origin_mm + scan.axes * (ijk * 0.5);
  for (const Vec3& d : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0.6, 0, 0.8)})
    EXPECT_NEAR(leave(*bone, middle, d, 12).at_mm, 6, 0.03);
}

TEST(ImportGrey, ARegionIsCountedAsTheFileCountsIt) {
  io::Scan scan = grey_scan({30, 30, 30}, {1, 1, 1},
                            [](const Vec3& p) { return p.z() > 6 ? 1000.0 : -1000.0; });
  scenario::BoneRecipe options;
  options.region = scenario::Region{{5, 14}, {6, 17}, {0, 9}};
  options.iso = 300;
  EXPECT_FALSE(plan_import(scan, options).ok()) << "only air there";
  scan.k_reversed = true;  // slices 0..9 of the file are the last ones here
  const auto bone = import_or_fail(scan, options);
  ASSERT_TRUE(bone);
  EXPECT_EQ(bone->grid().size, Ijk(14, 16, 14)) << "two layers of air where the region cuts bone";
  EXPECT_EQ(bone->field(7, 7, 9), volume::kSolid);
  const Vec3 first = scan.origin_mm + scan.axes * Vec3(5, 6, 20);
  EXPECT_LT((bone->grid().world_from_grid({2, 2, 2}) * 1e3 - first).norm(), 1e-9);
  options.region->k = {0, 30};
  const auto outside = plan_import(scan, options);
  ASSERT_FALSE(outside.ok());
  EXPECT_EQ(outside.error().trouble, Trouble::usage);
}

TEST(ImportGrey, TheMemoryBudgetMakesVoxelsCoarserAndSaysSo) {
  const io::Scan scan = grey_scan({128, 128, 128}, {0.5, 0.5, 0.5},
                                  [](const Vec3& p) { return ct_ball(p, 20, 0.6); });
  scenario::BoneRecipe options;
  options.reserve_bricks = 64;
  options.memory_mb = 4;
  const auto plan = plan_import(scan, options);
  ASSERT_TRUE(plan.ok());
  EXPECT_GT(plan->voxel_mm, 0.7);
  EXPECT_LE(plan->memory_mb, 4);
  EXPECT_NE(plan->notices.back().find("budget"), std::string::npos) << plan->notices.back();
}

TEST(ImportGrey, TheSameScanGivesTheSameBone) {
  const io::Scan scan =
      grey_scan({40, 40, 24}, {0.5, 0.5, 0.9}, [](const Vec3& p) { return ct_ball(p, 7, 0.6); });
  const auto one = import_or_fail(scan), two = import_or_fail(scan);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->content_hash(), two->content_hash());
}

TEST(ImportGrey, OneSliceOrNothingButAirIsASentence) {
  const io::Scan slice = grey_scan({30, 30, 1}, {1, 1, 1}, [](const Vec3&) { return 0.0; });
  EXPECT_NE(plan_import(slice, {}).error().text.find("not a volume"), std::string::npos);
  scenario::BoneRecipe options;
  options.iso = 5000;
  const io::Scan scan =
      grey_scan({30, 30, 30}, {1, 1, 1}, [](const Vec3& p) { return ct_ball(p, 9, 1); });
  EXPECT_NE(plan_import(scan, options).error().text.find("`iso`"), std::string::npos);
}

// ---- labels

struct Shape {
  const char* name;
  double bar;  // allowed error of the volume
  std::function<bool(const Vec3&)> inside;
};

TEST(ImportLabels, EveryShapeKeepsItsVolume) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> any(-0.5, 0.5);
  std::vector<Shape> shapes;
  for (const double radius : {1.6, 2.2, 3.0, 4.5, 8.0, 12.0})
    shapes.push_back(
        {"ball", 2 * radius > 3 ? 0.01 : 0.05, [=](const Vec3& p) { return p.norm() < radius; }});
  for (const double thickness : {1.2, 1.8, 2.5, 3.5, 5.0, 8.0})
    shapes.push_back({"plate", thickness > 3 ? 0.01 : 0.05, [=](const Vec3& p) {
                        const Vec3 n = Vec3(0.3, 0.5, 0.8).normalized();
                        return std::abs(n.dot(p)) < thickness / 2 && p.cwiseAbs().maxCoeff() < 12;
                      }});
  for (const double radius : {0.9, 1.4, 2.0, 3.5})
    shapes.push_back({"tube", 2 * radius > 3 ? 0.01 : 0.05, [=](const Vec3& p) {
                        const Vec3 d = Vec3(0.9, 0.35, 0.2).normalized();
                        return (p - d * d.dot(p)).norm() < radius && p.cwiseAbs().maxCoeff() < 12;
                      }});
  for (const Shape& shape : shapes) {
    const Vec3 shift(any(random), any(random), any(random));
    const io::Scan scan = label_scan(
        {32, 32, 32}, {1, 1, 1}, [&](const Vec3& p) { return shape.inside(p + shift) ? 1 : 0; });
    const auto bone = import_or_fail(scan);
    ASSERT_TRUE(bone);
    const double truth = static_cast<double>(std::count(scan.labels.begin(), scan.labels.end(), 1));
    EXPECT_NEAR(volume::volume_of(*bone, 1) * 1e9 / truth, 1, shape.bar)
        << shape.name << " " << truth;
  }
}

// The staircase of voxels must not be felt: the surface of a ball and its normals are smooth.
TEST(ImportLabels, TheStaircaseIsSmoothed) {
  const io::Scan scan =
      label_scan({48, 48, 48}, {0.5, 0.5, 0.5}, [](const Vec3& p) { return p.norm() < 9 ? 1 : 0; });
  const auto bone = import_or_fail(scan);
  ASSERT_TRUE(bone);
  const Errors e = ball_errors(*bone, 9, 5);
  EXPECT_LT(e.worst_mm, 0.4 * 0.5);
  EXPECT_LT(e.mean_deg, 3.0) << "binary voxels are off by 20 and more";
}

TEST(ImportLabels, TwoSolidLabelsMeetWithoutAGap) {
  io::Scan scan = label_scan({32, 32, 32}, {1, 1, 1},
                             [](const Vec3& p) { return p.norm() < 11 ? (p.x() < 0 ? 1 : 2) : 0; });
  scan.label_names = {{1, "Bone", {1, 1, 1}}, {2, "Incus", {0, 1, 0}}};
  const auto bone = import_or_fail(scan);
  ASSERT_TRUE(bone);
  for (int i = 8; i < 24; ++i) EXPECT_EQ(bone->field(i, 16, 16), volume::kSolid) << i;
  EXPECT_EQ(bone->tissue(15, 16, 16), 1);
  EXPECT_EQ(bone->tissue(16, 16, 16), 2);
  EXPECT_EQ(bone->tissues()[2].name, "Incus");
  EXPECT_TRUE(bone->tissues()[2].spare);
  for (const volume::TissueId id : {volume::TissueId{1}, volume::TissueId{2}})
    EXPECT_NEAR(volume::volume_of(*bone, id) * 1e9 /
                    static_cast<double>(std::count(scan.labels.begin(), scan.labels.end(), id)),
                1, 0.01);
}

TEST(ImportLabels, SoftLabelsAreSeenButNotFelt) {
  io::Scan scan = label_scan({32, 32, 32}, {1, 1, 1}, [](const Vec3& p) {
    return p.cwiseAbs().maxCoeff() > 14 ? 0 : std::hypot(p.x(), p.y()) < 4 ? 7 : p.x() > 8 ? 9 : 1;
  });
  scan.label_names = {
      {1, "Bone", {1, 1, 1}}, {7, "Facial_Nerve", {1, 1, 0}}, {9, "EAC", {0, 0, 1}}};
  const auto bone = import_or_fail(scan);
  ASSERT_TRUE(bone);
  const volume::TissueId nerve = bone->tissue(16, 16, 16);
  EXPECT_EQ(bone->tissues()[nerve].name, "Facial_Nerve");
  EXPECT_EQ(bone->tissues()[nerve].kind, volume::TissueKind::soft);
  EXPECT_TRUE(bone->tissues()[nerve].spare);
  EXPECT_EQ(bone->field(16, 16, 16), 0);
  EXPECT_EQ(bone->field(8, 8, 16), volume::kSolid);
  EXPECT_EQ(bone->tissue(28, 16, 16), 0) << "the ear canal is air";
  EXPECT_EQ(bone->field(28, 16, 16), 0);
  EXPECT_NEAR(volume::volume_of(*bone, 1) * 1e9 /
                  static_cast<double>(std::count(scan.labels.begin(), scan.labels.end(), 1)),
              1, 0.01);
}

TEST(ImportLabels, FlatVoxelsBecomeCubicAtTheSameVolume) {
  const io::Scan scan =
      label_scan({40, 40, 14}, {0.5, 0.5, 1.5}, [](const Vec3& p) { return p.norm() < 8 ? 3 : 0; });
  const auto bone = import_or_fail(scan);
  ASSERT_TRUE(bone);
  EXPECT_NEAR(bone->grid().voxel, 0.5e-3, 1e-12);
  const double truth =
      static_cast<double>(std::count(scan.labels.begin(), scan.labels.end(), 3)) * 0.5 * 0.5 * 1.5;
  EXPECT_NEAR(volume::volume_of(*bone) * 1e9 / truth, 1, 0.01);
}

// Bone that the border cuts ends in a flat face half a voxel beyond the last voxel, as a ramp; and
// the volume stays that of the voxels.
void expect_flat_face(const io::Scan& scan, double volume_mm3, double share) {
  const auto bone = import_or_fail(scan);
  ASSERT_TRUE(bone);
  EXPECT_EQ(bone->grid().size, Ijk(24, 24, 24));
  // the first voxel of the scan keeps its place
  EXPECT_LT((bone->grid().world_from_grid({2, 2, 2}) - 1e-3 * scan.origin_mm).norm(), 1e-9);
  constexpr double kClose = 0.01 * volume::kFieldPerVoxel;  // keeps the volume of a label
  for (const int j : {10, 12, 15})
    for (int out = 0; out < 4; ++out) {
      // of the voxel second to last, and of the next
      const double wanted = volume::field_from_depth(1.5 - out);
      EXPECT_NEAR(bone->field(14, j, 20 + out), wanted, kClose) << j << " " << out;
      EXPECT_NEAR(bone->field(14, 20 + out, 15), wanted, kClose) << j << " " << out;
    }
  EXPECT_NEAR(volume::volume_of(*bone) * 1e9, volume_mm3, share * volume_mm3);
  EXPECT_NE(bone->tissue(12, 12, 22), 0);
  scenario::BoneRecipe before;
  before.margin = false;
  const auto old = import_or_fail(scan, before);
  ASSERT_TRUE(old);
  EXPECT_EQ(old->grid().size, scan.size);
  EXPECT_EQ(old->field(10, 10, 19), volume::kSolid);
}

TEST(ImportBorder, CutsLabelsInAFlatFace) {
  expect_flat_face(
      label_scan({20, 20, 20}, {0.5, 0.5, 0.5}, [](const Vec3& p) { return p.x() > -2 ? 1 : 0; }),
      20 * 20 * 14 * 0.125, 0.005);
}

TEST(ImportBorder, CutsGreyInAFlatFaceHoweverDenseTheBone) {
  expect_flat_face(grey_scan({20, 20, 20}, {0.5, 0.5, 0.5},
                             [](const Vec3& p) {
                               return p.x() > -2 ? 1200 + 600 * std::sin(3 * p.y()) : -1800.0;
                             }),
                   20 * 20 * 14 * 0.125, 0.03);
}

// A scan written from the bone ends where the bone does: beyond the border the values are as far
// below the level as the last ones are above it.
TEST(ImportBorder, WritesValuesBelowTheLevelBeyondIt) {
  const auto bone = import_or_fail(grey_scan(
      {20, 20, 20}, {0.5, 0.5, 0.5}, [](const Vec3& p) { return p.x() > 0 ? 1000 : -1000; }));
  ASSERT_TRUE(bone);
  EXPECT_EQ(bone->intensity(18, 12, 21), 1000);
  EXPECT_EQ(bone->intensity(18, 12, 22), -400);
}

// What is not solid ends with the scan, and a bone in the middle gets no margin.
TEST(ImportBorder, LeavesSoftLabelsAndFreeBonesAlone) {
  io::Scan scan = label_scan({20, 20, 20}, {1, 1, 1}, [](const Vec3& p) {
    return p.y() > 4 ? 2 : p.x() > 3 ? 1 : 0;
  });
  scan.label_names = {{1, "bone", {1, 1, 1}}, {2, "nerve", {1, 1, 0}}};
  const auto bone = import_or_fail(scan);
  ASSERT_TRUE(bone);
  EXPECT_EQ(bone->grid().size, Ijk(24, 24, 24));
  EXPECT_NE(bone->tissue(10, 18, 21), 0);
  EXPECT_EQ(bone->tissue(10, 18, 22), 0);
  const auto ball = import_or_fail(
      label_scan({20, 20, 20}, {1, 1, 1}, [](const Vec3& p) { return p.norm() < 6 ? 1 : 0; }));
  ASSERT_TRUE(ball);
  EXPECT_EQ(ball->grid().size, Ijk(20, 20, 20));
}

using ImportLabelsTable = test::FolderTest;

TEST_F(ImportLabelsTable, OverridesTheNames) {
  const std::string path = this->path("tissues.toml");
  std::ofstream(path)
      << "[[label]]\nvalue = 1\nkind = \"soft\"\n"
         "[[label]]\nname = \"facial nerve\"\nkind = \"solid\"\ncutting_energy_J_mm3 = 0.2\n"
         "colour = [0, 0.5, 1]\n";
  io::Scan scan = label_scan({24, 24, 24}, {1, 1, 1}, [](const Vec3& p) {
    return p.norm() < 5 ? 7 : p.norm() < 10 ? 1 : 0;
  });
  scan.label_names = {{1, "Bone", {1, 1, 1}}, {7, "Facial_Nerve", {1, 1, 0}}};
  scenario::BoneRecipe options;
  options.labels = path;
  const auto bone = import_or_fail(scan, options);
  ASSERT_TRUE(bone);
  EXPECT_EQ(bone->field(12, 12, 12), volume::kSolid);
  const volume::Tissue& nerve = bone->tissues()[bone->tissue(12, 12, 12)];
  EXPECT_NEAR(nerve.cutting_energy, 0.2e9, 1);
  EXPECT_NEAR(nerve.colour[1], 0.5, 1e-6);
  EXPECT_EQ(bone->field(12, 12, 20), 0) << "bone is soft now";
  std::ofstream(path) << "[[label]]\nvalue = 1\nkind = \"hard\"\n";
  const auto wrong = plan_import(scan, options);
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().text.find("tissues.toml: label 1: kind \"hard\""), std::string::npos)
      << wrong.error().text;
}

}  // namespace
}  // namespace burr::importing
