// A block of bone with a vein in it, and the lesson of a case on it, for the tests of this folder.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/scenario/lesson.h"
#include "burr/scenario/open_lesson.h"

namespace burr::surgeon {

constexpr double kMm = 1e-3;

// Bone below z = 0; the vein lies along x, 5 mm deep, with a radius of 1.5 mm. A hard stone sits in
// the bone beside the region of the step.
inline const phantom::Depth kVein =
    phantom::capsule({-8 * kMm, 0, -5 * kMm}, {8 * kMm, 0, -5 * kMm}, 1.5 * kMm);
inline const phantom::Depth kStone = phantom::ball(1.5 * kMm, {3 * kMm, 5 * kMm, -1.5 * kMm});

inline std::unique_ptr<volume::Bone> block_with_vein(double voxel_mm) {
  volume::TissueTable tissues;
  tissues.tissues.push_back({.name = "stone", .cutting_energy = 1e9, .spare = true});
  tissues.tissues.push_back({.name = "vein", .kind = volume::TissueKind::soft, .spare = true});
  phantom::Formula formula;
  const phantom::Depth slab = phantom::slab();
  formula.depth = [slab](const math::Vec3& p) { return std::min(slab(p), -kVein(p)); };
  formula.soft = [](const math::Vec3& p) { return kVein(p); };
  formula.tissue = [](const math::Vec3& p, double depth) -> volume::TissueId {
    if (kVein(p) > 0) return 3;
    if (kStone(p) > 0) return 2;
    return depth > -2 * kMm ? 1 : 0;
  };
  NoProgress quiet;
  auto bone = phantom::bone_from_formula(
      phantom::box_grid(math::Vec3(-9, -9, -9) * kMm, math::Vec3(9, 9, 2) * kMm, voxel_mm * kMm),
      tissues, formula, 256, 2, quiet);
  EXPECT_TRUE(bone.ok());
  return std::move(*bone);
}

inline scenario::CaseLesson block_lesson() {
  auto read = scenario::parse_lesson(R"(format = 2
title = "A trough over a vein"
phantom = "block"
description = "x"
approach = [[0, 0, 1]]
[burr]
diameter_mm = 3
rpm = 60000
[[structure]]
name = "vein"
intact = "soft"
[[structure]]
name = "stone"
intact = "solid"
[[region]]
name = "trough"
add = [{ shape = "box", at = [0, 1, -2], size_mm = [10, 8, 4] }]
[[step]]
id = "trough"
say = "Cut the trough."
region = "trough"
spare = ["vein", "stone"]
[reference]
remove = ["trough"]
leave = [{ structure = "vein", mm = 1 }, { structure = "stone", mm = 0.5 }]
)",
                                     "block.toml");
  EXPECT_TRUE(read.ok()) << (read.ok() ? "" : read.error().text);
  auto lesson = scenario::place(std::move(*read), {}, "block.toml");
  EXPECT_TRUE(lesson.ok());
  return std::move(*lesson);
}

}  // namespace burr::surgeon
