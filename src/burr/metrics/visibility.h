// metrics/visibility.h - did the surgeon see what was cut: the share of the burr's head in sight of
// the eye, ten times a second.
//
//     v = clear points / 7     points: centre of the head, and +-0.8 r along three axes
//
// A point is clear if the straight line from it to the eye meets no bone (sigma >= 1/2, see
// solidity.h). What was removed in a tenth of a second counts with the v of its end.
//
// The last, shorter stretch of a recording counts like a tenth of a second. Ticks without a radius of
// the burr do not count, nor do those in which nobody knows where the eye was.
//
// The eye is a plain time series, from the views of a recording (eyes_of) or from whatever knows
// where the camera was; an eye holds until the next one. Frame: world. Units: SI. Thread: one. Memory: the bone, for visibility_of().
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/moment.h"
#include "burr/record/player.h"
#include "burr/record/view.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct EyeSample {
  double t = 0;  // from then on [s]; in order
  math::Vec3 eye =
      math::Vec3::Zero();  // its place; of two eyes, the middle [m]. Not finite: not known
  math::Vec3 forward = math::Vec3::Zero();  // unit, where it looks
  double magnification = 1;
};

// Those of a recording; a view that record::check() refuses leaves the eye unknown until the next one.
[[nodiscard]] std::vector<EyeSample> eyes_of(std::span<const record::View> views, double rate_hz);

struct Visibility {
  double volume = 0;      // removed while there was an eye [m^3]
  double seen_share = 0;  // of it, with v >= 0.5
  double mean = 0;        // of v, by volume
  struct Moment {
    double t = 0, v = 0, volume = 0;  // [s], -, [m^3]
    math::Vec3 at = math::Vec3::Zero();
  };
  std::vector<Moment> worst;  // at most 3: with v < 0.5 and the most volume, largest first
};

// v of a head at `centre`. eye: finite; otherwise 0.
[[nodiscard]] double share_in_sight(const volume::Bone& bone, const math::Vec3& centre,
                                    double radius, const math::Vec3& eye);

// Tenth by tenth of a second: for a live session, or for made-up ticks.
class VisibilityMaker {
 public:
  explicit VisibilityMaker(std::span<const EyeSample> eyes) : eyes_(eyes) {}
  // True: a tenth of a second is over; give look() the bone as it is now.
  [[nodiscard]] bool add(const Moment& now);
  // After the last tick. True: give look() the bone as it is at the end.
  [[nodiscard]] bool end() const { return volume_ > 0; }
  void look(const volume::Bone& bone);
  // Not assessable: no eye was recorded, or nothing was removed while eye and radius were known.
  [[nodiscard]] Assessed<Visibility> finish() const;

 private:
  std::span<const EyeSample> eyes_;
  std::size_t eye_ = 0;
  Moment last_;
  double volume_ = 0;            // since the last look [m^3]
  bool radius_missing_ = false;  // something was removed by a burr of unknown size
  double all_ = 0, seen_ = 0, sum_ = 0;
  std::vector<Visibility::Moment> worst_;
};

// Plays the recording with its bone. bone: as it was opened; it is left as at the end. Error: as of
// Player::bone_at(), or interrupted.
[[nodiscard]] Result<Assessed<Visibility>> visibility_of(record::Player& player, volume::Bone& bone,
                                                         std::span<const EyeSample> eyes,
                                                         Progress& progress);

// How often the magnification changed by more than a tenth, and how often the view was turned by
// more than 10 degrees, per minute.
struct ViewChanges {
  double magnification = 0, direction = 0;  // [1/min]
};
// seconds: of the recording. Not assessable: it is empty, or holds no view with an eye that is known.
[[nodiscard]] Assessed<ViewChanges> view_changes(std::span<const EyeSample> eyes, double seconds);

}  // namespace burr::metrics
