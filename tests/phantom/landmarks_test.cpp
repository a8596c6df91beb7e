// The landmarks of the formulas lie where the bone's labels say that they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/phantom/phantoms.h"
#include "burr/volume/sample.h"

namespace burr::phantom {
namespace {

const Landmark& landmark(const std::vector<Landmark>& all, std::string_view name) {
  for (const Landmark& one : all)
    if (one.name == name) return one;
  ADD_FAILURE() << "no landmark " << name;
  return all.front();
}

std::string tissue_at(const volume::Bone& bone, const Vec3& p) {
  const math::Vec3 at = bone.grid().frame.inverse() * p / bone.grid().voxel;
  return bone.tissues()
      .tissues[bone.tissue(static_cast<int>(std::lround(at.x())),
                           static_cast<int>(std::lround(at.y())),
                           static_cast<int>(std::lround(at.z())))]
      .name;
}

TEST(Landmarks, HaveNamesOfTheirOwnPointsAndUnitNormals) {
  for (const std::string_view name : phantom_names()) {
    SCOPED_TRACE(name);
    std::set<std::string> seen;
    for (const Landmark& one : landmarks(name)) {
      EXPECT_TRUE(seen.insert(one.name).second) << one.name;
      ASSERT_FALSE(one.points.empty()) << one.name;
      for (const Vec3& p : one.points) EXPECT_TRUE(p.allFinite() && p.norm() < 0.2) << one.name;
      if (one.normal) {
        EXPECT_NEAR(one.normal->norm(), 1, 1e-12) << one.name;
        EXPECT_EQ(one.points.size(), 1U) << one.name << ": a plane has one point";
      }
    }
  }
  EXPECT_TRUE(landmarks("no such bone").empty());
}

TEST(Landmarks, OfTheTemporalBoneLieInTheirTissues) {
  NoProgress nobody;
  const auto made = phantom("temporal-bone", 0.4, nobody, 0);
  ASSERT_TRUE(made) << made.error().text;
  const volume::Bone& bone = **made;
  const auto all = landmarks("temporal-bone");
  EXPECT_EQ(tissue_at(bone, landmark(all, "antrum").points.front()), "antrum air");
  EXPECT_EQ(tissue_at(bone, landmark(all, "dome of the lateral canal").points.front()),
            "semicircular canals");
  // the nerve and the sinus, in the middle of each part
  for (const auto& [curve, tissue] : {std::pair{"facial nerve, mastoid part", "facial nerve"},
                                      std::pair{"facial nerve, tympanic part", "facial nerve"},
                                      std::pair{"mastoid sinus", "sigmoid sinus"}}) {
    const auto& points = landmark(all, curve).points;
    ASSERT_GE(points.size(), 6U) << curve;
    for (std::size_t n = points.size() / 4; n < 3 * points.size() / 4; ++n)
      EXPECT_EQ(tissue_at(bone, points[n]), tissue) << curve << " " << n;
  }
  // parts of the nerve follow each other from the brain to the foramen
  EXPECT_LT((landmark(all, "facial nerve, tympanic part").points.back() -
             landmark(all, "facial nerve, mastoid part").points.front())
                .norm(),
            1e-9);
  EXPECT_EQ(landmark(all, "second genu").points.front(),
            landmark(all, "facial nerve, mastoid part").points.front());
  EXPECT_LT(landmark(all, "stylomastoid foramen").points.front().z(), -15e-3);
}

TEST(Landmarks, OfJawToothAndSpineLieInTheirTissues) {
  NoProgress nobody;
  const auto jaw = phantom("jaw", 0.4, nobody, 0);
  ASSERT_TRUE(jaw);
  const auto of_jaw = landmarks("jaw");
  const auto& nerve = landmark(of_jaw, "inferior alveolar nerve").points;
  EXPECT_EQ(tissue_at(**jaw, nerve[nerve.size() / 2]), "inferior alveolar nerve");
  EXPECT_EQ(landmark(of_jaw, "mental foramen").points.front(), nerve.back());

  const auto tooth = phantom("tooth", 0.2, nobody, 0);
  ASSERT_TRUE(tooth);
  const auto of_tooth = landmarks("tooth");
  const auto& caries = landmark(of_tooth, "caries").points;
  EXPECT_EQ(tissue_at(**tooth, 0.5 * (caries[0] + caries[1])), "caries");
  EXPECT_EQ(tissue_at(**tooth, landmark(of_tooth, "pulp chamber").points.front()), "pulp");

  const auto of_spine = landmarks("spine");
  const auto& left = landmark(of_spine, "left pedicle").points;
  const auto& right = landmark(of_spine, "right pedicle").points;
  for (std::size_t n = 0; n < 2; ++n)
    EXPECT_EQ(left[n], Vec3(-right[n].x(), right[n].y(), right[n].z()));
  EXPECT_GT(left[0].y(), left[1].y()) << "from behind to the front";
}

// The middle of a tissue's voxels in a box [mm]
Vec3 middle_of(const volume::Bone& bone, const std::string& tissue, const Vec3& lo,
               const Vec3& hi) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  const math::Ijk& size = bone.grid().size;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        if (bone.tissues()[bone.tissue(i, j, k)].name != tissue) continue;
        const Vec3 p = 1e3 * bone.grid().world_from_grid(Vec3(i, j, k));
        if ((p.array() < lo.array()).any() || (p.array() > hi.array()).any()) continue;
        sum += p;
        ++count;
      }
  EXPECT_GT(count, 0) << tissue;
  return count > 0 ? Vec3(sum / count) : sum;
}

TEST(Landmarks, AHighNerveLiesHigherAndItsLandmarkWithIt) {
  NoProgress nobody;
  const auto usual = phantom("jaw", 0.4, nobody, 0),
             high = phantom("jaw?high-nerve", 0.4, nobody, 0);
  ASSERT_TRUE(usual && high);
  // between the gap and the molar, where the nerve runs almost level
  const Vec3 lo(-10, -4, -25), hi(10, 10, 0);
  const Vec3 was = middle_of(**usual, "inferior alveolar nerve", lo, hi);
  const Vec3 is = middle_of(**high, "inferior alveolar nerve", lo, hi);
  EXPECT_NEAR(is.z() - was.z(), 2.5, 0.1);
  const auto of_usual = landmarks("jaw"), of_high = landmarks("jaw?high-nerve");
  const auto& a = landmark(of_usual, "inferior alveolar nerve").points;
  const auto& b = landmark(of_high, "inferior alveolar nerve").points;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n)
    EXPECT_LT((b[n] - a[n] - Vec3(0, 0, 2.5e-3)).norm(), 1e-9);
}

TEST(Landmarks, AForwardSinusAndALowDuraMoveWithTheirLandmarks) {
  NoProgress nobody;
  const auto usual = phantom("temporal-bone", 0.6, nobody, 0);
  const auto sinus = phantom("temporal-bone?forward-sinus", 0.6, nobody, 0);
  const auto dura = phantom("temporal-bone?low-dura", 0.6, nobody, 0);
  ASSERT_TRUE(usual && sinus && dura);
  // the descending part, at one height
  const Vec3 lo(4, 5, -8), hi(24, 35, 2);
  EXPECT_NEAR(middle_of(**sinus, "sigmoid sinus", lo, hi).y() -
                  middle_of(**usual, "sigmoid sinus", lo, hi).y(),
              -4, 0.4);
  const auto of_usual = landmarks("temporal-bone");
  const auto of_sinus = landmarks("temporal-bone?forward-sinus");
  const auto& a = landmark(of_usual, "mastoid sinus").points;
  const auto& b = landmark(of_sinus, "mastoid sinus").points;
  ASSERT_EQ(a.size(), b.size());
  EXPECT_NEAR(b[a.size() / 2].y() - a[a.size() / 2].y(), -4e-3, 0.3e-3);
  // the plate over the mastoid, behind the antrum
  const Vec3 from(8, 11, 0), to(14, 17, 20);
  EXPECT_NEAR(middle_of(**dura, "bony dura plate (tegmen)", from, to).z() -
                  middle_of(**usual, "bony dura plate (tegmen)", from, to).z(),
              -4, 0.6);
  const auto of_dura = landmarks("temporal-bone?low-dura");
  EXPECT_NEAR(
      landmark(of_dura, "tegmen").points[0].z() - landmark(of_usual, "tegmen").points[0].z(),
      -3.9e-3, 0.2e-3);
}

// At the tympanic part of the nerve no bone is left over 3 mm, and none is missing elsewhere.
TEST(Landmarks, ADehiscentCanalIsBareWhereItsLandmarkSays) {
  const auto at = landmark(landmarks("temporal-bone?dehiscent"), "dehiscence of the facial canal");
  const Phantom usual = temporal_bone(0.25e-3),
                bare = temporal_bone(0.25e-3, Variant({"dehiscent"}));
  int opened = 0, elsewhere = 0;
  for (double x = -6; x <= 6; x += 0.25)
    for (double y = -6; y <= 6; y += 0.25)
      for (double z = -6; z <= 6; z += 0.25) {
        const Vec3 p = at.points[0] + 1e-3 * Vec3(x, y, z);
        if (usual.formula.depth(p) <= 0 || bare.formula.depth(p) > 0) continue;
        (1e-3 * Vec3(x, y, z).norm() <= 2.5e-3 ? opened : elsewhere) += 1;
      }
  EXPECT_GT(opened, 20);
  EXPECT_EQ(elsewhere, 0);
}

TEST(Landmarks, ASclerosisHasNoCellsAndAThinPedicleIsThinner) {
  NoProgress nobody;
  const auto bone = phantom("temporal-bone?sclerotic", 0.6, nobody, 0);
  ASSERT_TRUE(bone);
  const auto& tissues = (*bone)->tissues().tissues;
  for (int k = 0; k < (*bone)->grid().size.z(); ++k)
    for (int j = 0; j < (*bone)->grid().size.y(); ++j)
      for (int i = 0; i < (*bone)->grid().size.x(); ++i)
        ASSERT_NE(tissues[(*bone)->tissue(i, j, k)].name, "mastoid air cells");
  // half-way along the left pedicle, across
  const auto width = [](const Phantom& made) {
    const std::vector<Vec3>& axis = landmark(made.landmarks, "left pedicle").points;
    const Vec3 middle = 0.5 * (axis[0] + axis[1]);
    const Vec3 across = Vec3::UnitX();
    double left = 0, right = 0;
    // spongy inside: the outermost bone counts
    for (double d = 0; d < 8e-3; d += 0.05e-3) {
      if (made.formula.depth(middle + d * across) > 0) left = d;
      if (made.formula.depth(middle - d * across) > 0) right = d;
    }
    return left + right;
  };
  const double thin = width(spine(0.4e-3, Variant({"thin-pedicle"}))), usual = width(spine(0.4e-3));
  EXPECT_NEAR(1e3 * (usual - thin), 2.4, 0.8);
}

// The lowest caries in the middle of the tooth [mm]
double floor_of_caries(const std::string& name, const std::string& tissue) {
  NoProgress nobody;
  const auto tooth = phantom(name, 0.1, nobody, 0);
  EXPECT_TRUE(tooth);
  const volume::Bone& bone = **tooth;
  double lowest = 1e3;
  for (int k = 0; k < bone.grid().size.z(); ++k) {
    const Vec3 p = bone.grid().grid_from_world(
        Vec3(0, 0.8e-3, bone.grid().world_from_grid(Vec3(0, 0, k)).z()));
    const math::Ijk v = p.array().round().cast<int>();
    if (bone.tissues()[bone.tissue(v.x(), v.y(), v.z())].name != tissue) continue;
    lowest = std::min(lowest, 1e3 * bone.grid().world_from_grid(v.cast<double>()).z());
  }
  return lowest;
}

TEST(Landmarks, ShallowAndDeepCariesEndHigherAndLower) {
  const double usual = floor_of_caries("tooth?graded", "firm caries");
  EXPECT_NEAR(floor_of_caries("tooth?graded,shallow", "firm caries") - usual, 0.8, 0.11);
  EXPECT_NEAR(floor_of_caries("tooth?graded,deep", "firm caries") - usual, -0.4, 0.11);
  const auto z = [](const char* name) {
    return landmark(landmarks(name), "caries").points.back().z();
  };
  EXPECT_NEAR(z("tooth?graded,shallow") - z("tooth?graded"), 0.8e-3, 1e-9);
  EXPECT_NEAR(z("tooth?graded,deep") - z("tooth?graded"), -0.4e-3, 1e-9);
}

// Soft inside leathery inside firm, each about as thick as the formula says.
TEST(Landmarks, TheGradesOfCariesLieInEachOther) {
  const double soft = floor_of_caries("tooth?graded", "soft caries");
  const double leathery = floor_of_caries("tooth?graded", "leathery caries");
  const double firm = floor_of_caries("tooth?graded", "firm caries");
  EXPECT_NEAR(soft - leathery, 0.35, 0.11);
  EXPECT_NEAR(leathery - firm, 0.35, 0.11);
  EXPECT_GT(firm, 2.2 + 0.5) << "dentine over the pulp";
}

// The defect is empty from its floor to the face that the bone had, and keeps away from the nerve, also
// from one that lies high.
TEST(Landmarks, TheDefectOfTheJawIsEmptyFromItsFloorToItsFace) {
  NoProgress nobody;
  for (const char* name : {"jaw?defect", "jaw?long,defect,high-nerve"}) {
    const auto made = phantom(name, 0.4, nobody, 0);
    ASSERT_TRUE(made);
    const auto all = landmarks(name);
    const Landmark& face = landmark(all, "face over the defect");
    const Vec3 floor = landmark(all, "floor of the defect").points[0];
    ASSERT_TRUE(face.normal);
    const Vec3 out = *face.normal;
    EXPECT_NEAR((face.points[0] - floor).norm(), 2.5e-3, 1e-9);
    EXPECT_NEAR(volume::depth_at(**made, floor), 0, 0.1e-3);
    EXPECT_GT(volume::depth_at(**made, floor - 0.5e-3 * out), 0.2e-3);
    EXPECT_LT(volume::depth_at(**made, floor + 0.5e-3 * out), 0);
    EXPECT_LT(volume::depth_at(**made, face.points[0]), 0);
    // beside the defect the face is where the bone's is, as well as a plane can say it
    const Vec3 beside = face.points[0] + 4.6e-3 * out.cross(Vec3::UnitZ()).normalized();
    EXPECT_GT(volume::depth_at(**made, beside - 0.6e-3 * out), 0);
    EXPECT_LT(volume::depth_at(**made, beside + 0.6e-3 * out), 0);
    double nearest = 1;
    for (const Vec3& p : landmark(all, "inferior alveolar nerve").points)
      nearest = std::min(nearest, (p - landmark(all, "middle of the defect").points[0]).norm());
    EXPECT_GT(nearest - 4.45e-3, 1.5e-3 + 0.7e-3);
  }
}

// The planned osteotomy is 5 mm in front of the nerve on the cheek's side, crosses all of the bone, and has
// the floor of the mouth behind it.
TEST(Landmarks, TheOsteotomyLiesInFrontOfTheNerve) {
  NoProgress nobody;
  const auto made = phantom("jaw?long", 0.4, nobody, 0);
  ASSERT_TRUE(made);
  const auto all = landmarks("jaw?long");
  const Landmark& back = landmark(all, "back face of the osteotomy");
  const Landmark& front = landmark(all, "front face of the osteotomy");
  ASSERT_TRUE(back.normal && front.normal);
  EXPECT_NEAR((front.points[0] - back.points[0]).dot(*back.normal), 3e-3, 1e-9);
  EXPECT_LT((*back.normal + *front.normal).norm(), 1e-9);
  double nearest = 1;
  const volume::Bone& bone = **made;
  for (int k = 0; k < bone.grid().size.z(); ++k)
    for (int j = 0; j < bone.grid().size.y(); ++j)
      for (int i = 0; i < bone.grid().size.x(); ++i) {
        const std::string& name = bone.tissues()[bone.tissue(i, j, k)].name;
        if (name != "inferior alveolar nerve" && name != "nerve sheath") continue;
        const Vec3 p = bone.grid().world_from_grid(Vec3(i, j, k));
        nearest = std::min(nearest, (back.points[0] - p).dot(*back.normal));
      }
  EXPECT_NEAR(1e3 * nearest, 5, 0.5);
}

}  // namespace
}  // namespace burr::phantom
