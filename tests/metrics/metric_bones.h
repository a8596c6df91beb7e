// tests/metrics/metric_bones.h - bones whose answers are known: a formula before the cut, the same formula
// with a cavity after it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/metrics/voxel_set.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/volume/bone.h"
#include "burr/volume/distance_to.h"

namespace burr::metrics::test {

using math::Vec3;
using phantom::Depth;

inline constexpr double kMm = 1e-3;
inline constexpr std::array<double, 3> kVoxels = {0.4e-3, 0.25e-3, 0.125e-3};  // h [m]
inline const Vec3 kUp = {0, 0, 1};

enum Id : volume::TissueId { kAir, kBone, kNerve, kHard, kMarrow, kCanal };

inline volume::TissueTable table() {
  volume::TissueTable t;
  t.tissues = {{.name = "air", .kind = volume::TissueKind::air},
               {.name = "bone"},
               {.name = "nerve", .kind = volume::TissueKind::soft},
               {.name = "hard"},
               {.name = "marrow", .kind = volume::TissueKind::soft},
               {.name = "canal", .kind = volume::TissueKind::air}};
  return t;
}

// A bone by formula. The labels of soft tissues and of air go by the formula's depth in them.
struct Plan {
  Vec3 lo = Vec3::Constant(-8 * kMm), hi = Vec3::Constant(8 * kMm);
  Depth bone;                                     // the solid before the cut
  std::vector<std::pair<Depth, Id>> labels = {};  // the first that holds the point gives its tissue
  double lipschitz = 1;
};

inline std::unique_ptr<volume::Bone> build(const Plan& plan, const Depth& depth, double h) {
  phantom::Formula formula;
  formula.depth = depth;
  formula.lipschitz = plan.lipschitz;
  formula.tissue = [&plan](const Vec3& p, double) -> volume::TissueId {
    for (const auto& [shape, id] : plan.labels)
      if (shape(p) > 0) return id;
    return kBone;
  };
  formula.soft = [&plan](const Vec3& p) {
    double deepest = -1;
    for (const auto& [shape, id] : plan.labels) deepest = std::max(deepest, shape(p));
    return deepest;
  };
  NoProgress quiet;
  auto bone = phantom::bone_from_formula(phantom::box_grid(plan.lo, plan.hi, h), table(), formula,
                                         0, 2, quiet);
  EXPECT_TRUE(bone.ok());
  return std::move(*bone);
}

struct Cut {
  std::unique_ptr<volume::Bone> before, after;
};

// What lies in `cavity` is cut away.
inline Cut cut(const Plan& plan, const Depth& cavity, double h) {
  return {build(plan, plan.bone, h), build(plan, phantom::without(plan.bone, cavity), h)};
}

inline VoxelSet voxels_of(const volume::Bone& bone, volume::TissueId id) {
  const std::array<volume::TissueId, 1> ids = {id};
  return VoxelSet::of_tissues(bone, ids);
}

inline std::shared_ptr<const volume::DistanceTo> distance_to(const volume::Bone& bone,
                                                             volume::TissueId id) {
  const std::array<volume::TissueId, 1> ids = {id};
  NoProgress quiet;
  auto made = volume::DistanceTo::make(bone, ids, {}, quiet);
  EXPECT_TRUE(made.ok());
  return std::make_shared<const volume::DistanceTo>(std::move(*made));
}

// The half-space of all points above a height.
inline Depth above(double z) { return phantom::slab({0, 0, -1}, {0, 0, z}); }
// A block without sides: bone below a height.
inline Depth below(double z) { return phantom::slab({0, 0, 1}, {0, 0, z}); }

}  // namespace burr::metrics::test
