// A crumb joins the part that it touches over an edge or a corner; two bones that touch stay two.
#include "burr/importing/crumbs.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace burr::importing {
namespace {

using math::Ijk;

constexpr std::int16_t kLevel = 300;
const Ijk kSize(20, 12, 12);

std::size_t at(const Ijk& v) {
  return static_cast<std::size_t>(v.x() + kSize.x() * (v.y() + kSize.y() * v.z()));
}
bool in_box(const Ijk& p, const Ijk& low, const Ijk& high) {
  return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
}

struct Voxels {
  std::vector<std::int16_t> values;
  explicit Voxels(const std::function<int(const Ijk&)>& value) {
    for (int k = 0; k < kSize.z(); ++k)
      for (int j = 0; j < kSize.y(); ++j)
        for (int i = 0; i < kSize.x(); ++i)
          values.push_back(static_cast<std::int16_t>(value({i, j, k})));
  }
  [[nodiscard]] Parts parts() const {
    NoProgress progress;
    return *find_parts(
        kSize,
        [this](int j, int k, std::span<std::uint8_t> row) {
          for (std::size_t i = 0; i < row.size(); ++i)
            row[i] = values[at({static_cast<int>(i), j, k})] >= kLevel ? 1 : 0;
        },
        progress);
  }
};

const Ijk kLow(4, 4, 4), kHigh(7, 7, 7);  // a cube of 64 voxels

TEST(Crumbs, JoinOverAnEdgeByTheBrighterVoxel) {
  const Ijk crumb(8, 8, 5), brighter(8, 7, 5);
  Voxels voxels([&](const Ijk& p) {
    return in_box(p, kLow, kHigh) ? 900 : p == crumb ? 310 : p == brighter ? 120 : 40;
  });
  ASSERT_EQ(voxels.parts().parts.size(), 2U);
  EXPECT_EQ(join_crumbs(voxels.parts(), kLevel, voxels.values), 1U);
  EXPECT_EQ(voxels.values[at(brighter)], kLevel);
  EXPECT_EQ(voxels.parts().parts, std::vector<std::int64_t>{66});
}

TEST(Crumbs, JoinOverACornerByTwo) {
  Voxels voxels(
      [&](const Ijk& p) { return in_box(p, kLow, kHigh) || p == Ijk(8, 8, 8) ? 900 : 40; });
  EXPECT_EQ(join_crumbs(voxels.parts(), kLevel, voxels.values), 2U);
  EXPECT_EQ(voxels.parts().parts, std::vector<std::int64_t>{67});
}

TEST(Crumbs, AChainOfThemIsOneRod) {
  Voxels voxels([&](const Ijk& p) {
    return p.x() == p.y() && p.x() == p.z() && p.x() > 1 && p.x() < 9 ? 900 : 40;
  });
  ASSERT_EQ(voxels.parts().parts.size(), 7U);
  join_crumbs(voxels.parts(), kLevel, voxels.values);
  EXPECT_EQ(voxels.parts().parts.size(), 1U);
}

TEST(Crumbs, TwoBonesThatTouchStayTwoAlsoByACrumbBetween) {
  const Ijk crumb(8, 8, 5);
  const auto both = [&](const Ijk& p) {
    return in_box(p, kLow, kHigh) || in_box(p, {9, 9, 4}, {12, 11, 7});
  };
  Voxels touching([&](const Ijk& p) {
    return in_box(p, kLow, kHigh) || in_box(p, {8, 8, 4}, {11, 11, 7}) ? 900 : 40;
  });
  EXPECT_EQ(join_crumbs(touching.parts(), kLevel, touching.values), 0U);
  EXPECT_EQ(touching.parts().parts.size(), 2U);
  Voxels between([&](const Ijk& p) { return both(p) || p == crumb ? 900 : 40; });
  ASSERT_EQ(between.parts().parts.size(), 3U);
  EXPECT_EQ(join_crumbs(between.parts(), kLevel, between.values), 1U);
  EXPECT_EQ(between.parts().parts.size(), 2U);
}

TEST(Crumbs, FarAwayTheyStay) {
  Voxels voxels(
      [&](const Ijk& p) { return in_box(p, kLow, kHigh) || p == Ijk(9, 8, 5) ? 900 : 40; });
  EXPECT_EQ(join_crumbs(voxels.parts(), kLevel, voxels.values), 0U);
  EXPECT_EQ(voxels.parts().parts.size(), 2U);
}

}  // namespace
}  // namespace burr::importing
