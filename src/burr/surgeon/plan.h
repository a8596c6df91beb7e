// surgeon/plan.h - what a surgeon means to remove in one step of a case, as a field over the bone.
//
//     goal(p) = min( depth of p in the step's region and in all that lies between it and the surgeon,
//                    D_S(p) - m_S of every structure S that is spared )
//
// as this surgeon believes it (believed.h), and no larger than anywhere on the straight way from p
// out to the surgeon: nobody cuts what cannot be reached without cutting what must stay. Positive:
// may go; it changes by at most 1 m per m, so a ball of radius r fits where goal >= r. Margins m_S:
// those of the case's reference result, otherwise kUsualMargin.
//
// Kept at every second voxel, at most 0.5 mm apart, interpolated trilinearly; beyond the grid as at
// its border. Frame: world (LPS). Units: m. Thread: at() any, wait-free.
#pragma once

#include <cstddef>
#include <vector>

#include "burr/math/pose.h"
#include "burr/rt/rt.h"
#include "burr/scenario/lesson.h"
#include "burr/surgeon/believed.h"
#include "burr/volume/bone.h"

namespace burr::surgeon {

inline constexpr double kUsualMargin = 0.5e-3;  // bone left where the case names no thickness [m]

// Numbers at the nodes of a cubic grid.
class FieldGrid {
 public:
  FieldGrid() = default;
  // Covers the bone.
  explicit FieldGrid(const volume::Grid& bone);

  [[nodiscard]] double at(const math::Vec3& p) const BURR_RT;
  [[nodiscard]] math::Vec3 slope(const math::Vec3& p) const BURR_RT;  // gradient of at()
  [[nodiscard]] math::Vec3 node(std::size_t n) const;                 // world
  [[nodiscard]] std::size_t nodes() const { return value.size(); }
  [[nodiscard]] double spacing() const { return spacing_; }
  [[nodiscard]] const math::Ijk& size() const { return size_; }
  [[nodiscard]] const math::Quat& axes() const { return frame_.q; }  // world from grid

  std::vector<float> value;  // (size), x fastest [m]

 private:
  math::Ijk size_ = {0, 0, 0};
  double spacing_ = 1e-3;
  math::Pose frame_;
};

// The largest value at a point and straight ahead of it in the direction `out` (unit).
[[nodiscard]] FieldGrid behind(const FieldGrid& field, const math::Vec3& out);

// The least D_S(p) - m_S over all structures that are spared; the least believed D_S(p) over all of
// them; and over those that a step of the case names as spared. Margins are bone that is left over a
// structure when bone is cut away. Who adds material leaves none: it only must not enter.
struct Spare {
  FieldGrid free, outside, near;
};
[[nodiscard]] Spare spare_of(const volume::Grid& bone, const scenario::CaseLesson& lesson,
                             const Believed& believed, double margin_less);

// The goal of a step in `region`, for a surgeon who is in these directions (approach_of).
[[nodiscard]] FieldGrid goal_of(const scenario::CaseRegion& region,
                                const std::vector<math::Vec3>& approach, const Believed& believed,
                                const Spare& spare);

// Unit, from the bone to the surgeon; at least one. Of a step, or of the lesson where it has none.
[[nodiscard]] std::vector<math::Vec3> approach_of(const scenario::CaseLesson& lesson);
[[nodiscard]] std::vector<math::Vec3> approach_of(const scenario::CaseLesson& lesson,
                                                  const scenario::Step& step);

}  // namespace burr::surgeon
