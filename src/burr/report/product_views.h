// report/product_views.h - the ten views in which every product is shown, whoever looks at it: the bone at the end
// from four sides, and two sections along each plane through what was removed.
//
//     const math::Aabb removed = removed_box(before, after);
//     for (const ProductView& view : product_views(removed, towards, work.at)) ...
//
// Where nothing was removed there are the four sides alone. Frame: world (LPS). Units: m, rad. Thread: any.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/math/vec3.h"
#include "burr/render/camera.h"
#include "burr/render/slice.h"
#include "burr/scenario/case.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/bone.h"

namespace burr::report {

inline constexpr int kViewWide = 440, kViewHigh = 400;  // of a picture of such a view [pixel]

struct ProductView {
  std::string name;       // "straight", "below", "left", "right", "axial-1" .. "sagittal-2"
  double height = 0;      // of what it shows, at its middle
  render::Camera camera;  // of a side
  std::optional<render::Slice> slice;  // none: it is a side
  [[nodiscard]] double wide() const { return height * kViewWide / kViewHigh; }
};

// Around the centres of the voxels that lost half a voxel or more; empty: nothing was removed.
[[nodiscard]] math::Aabb removed_box(const volume::Bone& before, const volume::Bone& after);

// The unit vector from the bone to the surgeon.
[[nodiscard]] math::Vec3 towards_surgeon(const scenario::CaseLesson& lesson,
                                         const scenario::Case& work);

// Looks at the target from there; height: of what is seen at the target.
[[nodiscard]] render::Camera camera_from(const math::Vec3& towards, const math::Vec3& target,
                                         double height);

// at: where the work is, if nothing was removed.
[[nodiscard]] std::vector<ProductView> product_views(const math::Aabb& removed,
                                                     const math::Vec3& towards,
                                                     const std::optional<math::Vec3>& at);

}  // namespace burr::report
