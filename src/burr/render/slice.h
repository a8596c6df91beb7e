// render/slice.h - a plane through the present bone with its labels: axial, coronal or sagittal, in
// the views that radiologists use.
//
//     axial     from the feet: the patient's left at the right, front at the top
//     coronal   from the front: left at the right, head at the top
//     sagittal  from the patient's left: front at the left, head at the top
//
// Bone is light, with an edge as sharp as the field gives it; tissues have their colours, soft ones
// dimmer. Drawn by the processor from copies of bricks, made while the servo cuts: a brick is
// copied again when it has changed. Frame: world (LPS). Units: m. Thread: one, besides the servo.
// Memory: 1 KiB for each brick that a slice went through, at most kMostKept of them.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/render/image.h"
#include "burr/render/look.h"
#include "burr/rt/changed_bits.h"
#include "burr/volume/bone.h"
#include "burr/volume/greys.h"

namespace burr::render {

enum class Plane : std::uint8_t { axial, coronal, sagittal };

struct Slice {
  Plane plane = Plane::axial;
  math::Vec3 through = math::Vec3::Zero();  // point in the middle of the picture
  double height = 60e-3;                    // height of the picture
  bool labels = true;                       // colours of tissues; false: all bone looks alike
  // The scan's values, black at level - window / 2 and white at level + window / 2. What was milled
  // away is dark, what was added has its colour; tissue colours are laid over it thinly. nullptr:
  // bone is light, everything else dark.
  const volume::Greys* greys = nullptr;
  double window = 4000, level = 700;  // in HU or the scan's unit
};

// Unit vectors in the world: to the right and up in the picture.
[[nodiscard]] math::Vec3 right_of(Plane plane);
[[nodiscard]] math::Vec3 up_of(Plane plane);

// The position of a point in a picture of that size [pixel], (0, 0): top left corner; and back,
// within the plane.
[[nodiscard]] Eigen::Vector2d pixel_of(const Slice& slice, const math::Vec3& p, int width,
                                       int height);
[[nodiscard]] math::Vec3 point_of(const Slice& slice, const Eigen::Vector2d& pixel, int width,
                                  int height);

class Slicer {
 public:
  static constexpr std::size_t kMostKept = 40'000;

  // Adds a watcher to the bone; call it before the session.
  explicit Slicer(volume::Bone& bone);

  // Draws into `image`, whose size it keeps. True: everything is up to date; false: the servo was
  // writing a brick, which is shown as it was before.
  bool draw(const Slice& slice, Image& image);

 private:
  struct Kept {
    volume::BrickField field;
    bool known = false;  // false: changed since it was copied
  };
  void forget();
  const volume::BrickField* brick(int bi, int bj, int bk);
  [[nodiscard]] double field(const math::Ijk& ijk);

  const volume::Bone& bone_;
  rt::ChangedBits& changed_;
  std::vector<std::int32_t> at_;  // (brick_count) index into kept_, or -1
  std::vector<Kept> kept_;
  bool all_now_ = true;
};

}  // namespace burr::render
