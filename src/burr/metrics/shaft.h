// metrics/shaft.h - did the shaft of the tool rest on bone.
//
// Felt: the session's own touch said so, tick by tick (`--touch shaft`, or a tool of the rack; flag 18 of
// docs/understand/touch_tools.md). A contact ends when the shaft has been free for a tick.
//
// Drawn: in every other session the shaft is a picture that goes through bone. ten times a second 64
// points on it (8 places along it, 8 around each, up to 26 mm from the head, where the handpiece
// begins) are looked up in the bone as it was then:
//
//     in bone: any of them has a field of at least 1/2
//
// It begins two radii behind the middle of the head; what lies nearer is the neck. The surface is
// right to a fraction of a voxel; a point that goes in beside a place is seen from the depth of a
// sixteenth of the shaft's circle on. Frame: world. Units: SI. Thread: one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/moment.h"
#include "burr/record/player.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

inline constexpr const char* kShaftNotFelt =
    "the shaft did not touch in this session (the method of touch \"shaft\" lets it)";

struct ShaftRest {
  std::size_t contacts = 0;
  double seconds = 0;        // it rested on bone
  double largest_twist = 0;  // torque of the contact about the tip that the hand did not get [N m]
  double largest_at = 0;     // [s]
};

class ShaftRestMaker {
 public:
  void add(const Moment& now);
  // Not assessable: in no tick a tool was in the hand whose shaft can touch.
  [[nodiscard]] Assessed<ShaftRest> finish() const;

 private:
  ShaftRest found_;
  bool rested_ = false, felt_ = false;
};

// The straight part of a drawn shaft.
struct DrawnShaft {
  double radius = 1.2e-3, length = 60e-3;  // from the middle of the head [m]
};
[[nodiscard]] bool shaft_in_bone(const volume::Bone& bone, const math::Vec3& centre,
                                 const math::Vec3& axis, double head, const DrawnShaft& shaft);

struct ShaftInBone {
  double seconds = 0;     // in bone
  double looked = 0;      // of all [s]
  double first_at = 0;    // [s]
  std::size_t times = 0;  // looks with the shaft in bone
};

class ShaftInBoneMaker {
 public:
  explicit ShaftInBoneMaker(const DrawnShaft& shaft) : shaft_(shaft) {}
  // True: a tenth of a second is over; give look() the bone as it is now.
  [[nodiscard]] bool add(const Moment& now);
  void look(const volume::Bone& bone);
  // Not assessable: nothing was looked at while the burr's radius was known.
  [[nodiscard]] Assessed<ShaftInBone> finish() const;

 private:
  DrawnShaft shaft_;
  Moment last_;
  double since_ = 0;  // the last look [s]
  ShaftInBone found_;
};

// Plays the recording with its bone: as it was opened; it is left as at the end. Not assessable: the
// recording does not say how thick the shaft is. Error: as of Player::bone_at(), or interrupted.
[[nodiscard]] Result<Assessed<ShaftInBone>> shaft_of(record::Player& player, volume::Bone& bone,
                                                     Progress& progress);

}  // namespace burr::metrics
