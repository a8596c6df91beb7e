// The landmarks of the formulas lie where the bone's labels say that they are.
#include <gtest/gtest.h>

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

namespace burr::phantom {
namespace {

const Landmark& landmark(const std::vector<Landmark>& all, const std::string& name) {
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

}  // namespace
}  // namespace burr::phantom
