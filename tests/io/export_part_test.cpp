#include "burr/io/export_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/folder_of_test.h"
#include "surface/surface_bones.h"

namespace burr::io {
namespace {

using math::Vec3;

// a slab, and the same slab after a ball was milled out of its top
class ExportPart : public test::FolderTest {
 protected:
  ExportPart() {
    const auto slab = [](const Vec3& p) { return 20.3 - p.z(); };
    const auto ball = [](const Vec3& p) { return 9.1 - (p - Vec3(24.2, 23.7, 22.5)).norm(); };
    before = test::bone_of(test::askew({49, 48, 32}), slab);
    now = test::bone_of(test::askew({49, 48, 32}),
                        [&](const Vec3& p) { return std::min(slab(p), -ball(p)); });
  }
  Result<Exported> to(const std::string& name, ExportOptions options = {}) {
    NoProgress progress;
    return export_part(*before, *now, path(name), options, progress);
  }
  std::unique_ptr<volume::Bone> before, now;
};

TEST_F(ExportPart, EveryEndingGivesAFileAndRemovedAndLeftAddUp) {
  const double height = 6.9;
  const double cap =
      std::numbers::pi * height * height * (3 * 9.1 - height) / 3 * std::pow(0.5e-3, 3);
  const double slab = 49 * 48 * 20.8 * std::pow(0.5e-3, 3);  // 20.3 and half a voxel below
  for (const char* name :
       {"a.stl", "a.ply", "a.obj", "a.3mf", "a.glb", "a.seg.nrrd", "a.nrrd", "A.STL"}) {
    SCOPED_TRACE(name);
    const auto bone = to(name);
    ASSERT_TRUE(bone.ok());
    EXPECT_NEAR(bone.value().volume / (slab - cap), 1, 0.01);
    const auto removed = to(name, {.part = Part::removed});
    ASSERT_TRUE(removed.ok());
    EXPECT_NEAR(removed.value().volume / cap, 1, 0.02);
    const std::string ending = std::string(name).substr(2);
    EXPECT_EQ(removed.value().triangles == 0, ending == "nrrd" || ending == "seg.nrrd");
    EXPECT_TRUE(std::filesystem::exists(path(name)));
  }
  EXPECT_EQ(files(), 8);
}

// The way back: what was removed before is what is added now.
TEST_F(ExportPart, WhatWasAddedIsOneClosedPiece) {
  const auto none = to("a.stl", {.part = Part::added});
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().trouble, Trouble::data);
  EXPECT_EQ(files(), 0);
  const auto removed = to("a.stl", {.part = Part::removed});
  std::swap(before, now);
  const auto added = to("b.stl", {.part = Part::added, .frame = Frame::print});
  ASSERT_TRUE(removed.ok() && added.ok());
  EXPECT_EQ(added.value().volume, removed.value().volume);
  EXPECT_EQ(added.value().triangles, removed.value().triangles);
  EXPECT_EQ(added.value().shells.parts, 1U);
  EXPECT_NEAR(added.value().shells.volume / added.value().volume, 1, 0.02);
}

TEST_F(ExportPart, WhatCannotBeIsSaidBeforeTheWork) {
  const auto trouble = [&](const char* name, ExportOptions options) {
    const Status status = check_export(path(name), options);
    return status.ok() ? 0 : static_cast<int>(status.error().trouble);
  };
  EXPECT_EQ(trouble("a.stl", {.frame = Frame::print}), 0);
  EXPECT_EQ(trouble("a.vtk", {}), 2);
  EXPECT_EQ(trouble("a", {}), 2);
  EXPECT_EQ(trouble("a.glb", {.frame = Frame::print}), 2);
  EXPECT_EQ(trouble("a.seg.nrrd", {.frame = Frame::ras}), 2);
  EXPECT_EQ(trouble("a.stl", {.scan = true}), 2);
  EXPECT_EQ(trouble("a.nrrd", {.part = Part::removed, .scan = true}), 2);
  EXPECT_EQ(trouble("a.nrrd", {.scan = true}), 0);
  EXPECT_FALSE(to("a.nrrd", {.scan = true}).ok()) << "this bone has no grey values";
  now = test::bone_of(test::askew({49, 48, 32}), [](const Vec3& p) { return 20.3 - p.z(); });
  const auto nothing = to("a.stl", {.part = Part::removed});
  ASSERT_FALSE(nothing.ok());
  EXPECT_EQ(nothing.error().trouble, Trouble::data);
  EXPECT_EQ(files(), 0);
}

TEST_F(ExportPart, SaysHowManyPartsThereAreAndWritesTheLargest) {
  now = test::bone_of(test::askew({49, 48, 32}), [](const Vec3& p) {
    return std::max({9.1 - (p - Vec3(14.2, 15.7, 16)).norm(), 5 - (p - Vec3(38, 30, 16)).norm(),
                     0.6 - (p - Vec3(40, 6, 6)).norm()});
  });
  const double large = 4.0 / 3 * std::numbers::pi * std::pow(9.1 * 0.5e-3, 3);
  const auto all = to("all.ply"), largest = to("largest.ply", {.largest = true});
  ASSERT_TRUE(all && largest);
  EXPECT_EQ(all->shells.parts, 3U);
  EXPECT_EQ(all->shells.islands, 1U);
  EXPECT_EQ(all->shells.cavities, 0U);
  EXPECT_EQ(largest->shells.parts, 3U) << "what was left out is still told";
  EXPECT_LT(largest->triangles, all->triangles);
  EXPECT_NEAR(largest->volume / large, 1, 0.01);
  EXPECT_FALSE(check_export("a.nrrd", {.largest = true}));
}

}  // namespace
}  // namespace burr::io
