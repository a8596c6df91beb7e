// dataset/eye.h - the camera of a data set: where it is at a tick, and its matrices.
//
// The camera of AMBF looks along -x, y is to the right and z is up in the picture. That of OpenCV
// looks along z, x is to the right and y is down. Frame: world (LPS). Units: m, rad. Thread: any.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burr/math/pose.h"
#include "burr/record/player.h"
#include "burr/record/view.h"
#include "burr/render/camera.h"
#include "burr/volume/bone.h"

namespace burr::dataset {

// cv_from_ambf, row by row.
inline constexpr std::array<double, 16> kCvFromAmbf = {0,  1, 0, 0, 0, 0, -1, 0,
                                                       -1, 0, 0, 0, 0, 0, 0,  1};

// Where a session was seen from.
class Eyes {
 public:
  // As recorded; without a recorded view: from the viewpoint of its pictures at the end, at rest.
  [[nodiscard]] static Result<Eyes> of(record::Player& player, const volume::Bone& before);

  // Ticks must not decrease.
  [[nodiscard]] const record::View& at(std::uint64_t tick);
  // Of the first view. The pictures of a data set share one, because they share one matrix.  [rad]
  [[nodiscard]] double field_of_view() const { return views_.front().field_of_view; }
  [[nodiscard]] bool recorded() const { return recorded_; }

 private:
  std::vector<record::View> views_;  // at least one
  std::size_t now_ = 0;
  bool recorded_ = true;
};

// world_from_camera, as AMBF has it.
[[nodiscard]] math::Pose ambf_camera(const record::View& view);
// A camera with this field of view, moved to its right.
[[nodiscard]] render::Camera camera_of(const record::View& view, double field_of_view,
                                       double aspect, double right);
// 3 x 3, row by row. Pictures are measured from their top left corner: the first pixel reaches from
// 0 to 1.
[[nodiscard]] std::array<double, 9> intrinsic(double field_of_view, int width, int height);

}  // namespace burr::dataset
