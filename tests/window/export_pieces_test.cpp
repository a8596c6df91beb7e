// `burr export --part pieces`: a file for each piece, whose meshes hold the pieces' volumes.
#include "commands/export_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "burr/base/progress.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "support/folder.h"

namespace burr::app {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;

TEST(ExportPieces, NumbersStandBeforeTheEnding) {
  EXPECT_EQ(numbered("bone.stl", 2), "bone_2.stl");
  EXPECT_EQ(numbered("a.b/bone.seg.nrrd", 1), "a.b/bone_1.seg.nrrd");
  EXPECT_EQ(numbered("a.b/bone", 3), "a.b/bone_3");
}

// Balls of 3 and 2 mm, and a splinter of 0.5 mm.
std::unique_ptr<volume::Bone> three_balls() {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), 0.25 * kMm), {},
      [](const Vec3& p) {
        const auto ball = [&p](double x, double r) { return r - (p - Vec3(x, 0, 0)).norm(); };
        return std::max(
            {ball(-4 * kMm, 3 * kMm), ball(3 * kMm, 2 * kMm), ball(6.5 * kMm, 0.5 * kMm)});
      });
}

TEST(ExportPieces, EachIsAFileOfItsOwnAndSplintersAreCounted) {
  const test::Folder folder;
  NoProgress quiet;
  const auto bone = three_balls();
  const std::string out = (folder.path() / "bone.stl").string();
  testing::internal::CaptureStdout();
  const Status written = export_pieces(*bone, out, {}, false, true, quiet);
  const auto said = nlohmann::json::parse(testing::internal::GetCapturedStdout());
  ASSERT_TRUE(written.ok()) << written.error().text;
  ASSERT_EQ(said["pieces"].size(), 2U);
  EXPECT_EQ(said["splinters"], 1);
  const double balls[] = {4.0 / 3 * M_PI * 27, 4.0 / 3 * M_PI * 8};
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_NEAR(said["pieces"][n]["volume_mm3"].get<double>(), balls[n], 0.01 * balls[n]);
    const std::string path = said["pieces"][n]["file"];
    EXPECT_EQ(path, numbered(out, n + 1));
    // a binary STL: 84 bytes and 50 for each triangle
    EXPECT_EQ(std::filesystem::file_size(path),
              84 + 50 * said["pieces"][n]["triangles"].get<std::uintmax_t>());
  }
  EXPECT_FALSE(std::filesystem::exists(numbered(out, 3)));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(ExportPieces, NothingIsWrittenWhereNothingIsLargeEnough) {
  const test::Folder folder;
  NoProgress quiet;
  const auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-2 * kMm), Vec3::Constant(2 * kMm), 0.25 * kMm), {},
      phantom::ball(0.6 * kMm));
  const Status written =
      export_pieces(*bone, (folder.path() / "bone.stl").string(), {}, false, false, quiet);
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().text,
            "no piece of the bone is larger than 5 mm^3; nothing was written");
}

}  // namespace
}  // namespace burr::app
