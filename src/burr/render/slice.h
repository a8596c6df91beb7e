// render/slice.h - a plane through the bone as it is now, with its labels: axial, coronal or
// sagittal, as radiologists look at them.
//
//     axial     from the feet: the patient's left at the right, front at the top
//     coronal   from the front: left at the right, head at the top
//     sagittal  from the patient's left: front at the left, head at the top
//
// Bone is light, its edge as sharp as the field knows it; tissues have their colours, soft ones
// dimmer. Drawn by the processor, bricks copied while the servo cuts: each when it changed.
// Frame: world (LPS). Units: m. Thread: one; beside the servo. Memory: 1 KiB for each brick a slice
// went through, at most kMostKept of them.
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
  math::Vec3 through = math::Vec3::Zero();  // is in the middle of the picture
  double height = 60e-3;                    // of what is shown
  bool labels = true;                       // colours of tissues; false: bone is bone
  // What the scan measured, between black at level - window / 2 and white at level + window / 2,
  // with what was milled away dark and what was added in its colour; tissues' colours are laid over
  // it thinly. nullptr: bone is light, all else dark.
  const volume::Greys* greys = nullptr;
  double window = 4000, level = 700;  // in HU or the scan's unit
};

// Unit vectors of the world: to the right and up in the picture.
[[nodiscard]] math::Vec3 right_of(Plane plane);
[[nodiscard]] math::Vec3 up_of(Plane plane);

// Where a point lies in a picture of that size [pixel], (0, 0): top left corner; and back, within
// the plane.
[[nodiscard]] Eigen::Vector2d pixel_of(const Slice& slice, const math::Vec3& p, int width,
                                       int height);
[[nodiscard]] math::Vec3 point_of(const Slice& slice, const Eigen::Vector2d& pixel, int width,
                                  int height);

class Slicer {
 public:
  static constexpr std::size_t kMostKept = 40'000;

  // Before the session: adds a watcher.
  explicit Slicer(volume::Bone& bone);

  // The picture takes its size from `image`. True: all of it is as it is now; false: the servo was
  // at work in a brick, which is shown as it was.
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
  std::vector<std::int32_t> at_;  // (brick_count) place in kept_, or -1
  std::vector<Kept> kept_;
  bool all_now_ = true;
};

}  // namespace burr::render
