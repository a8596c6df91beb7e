// metrics/way.h - time and way: descriptive figures, never a mark.
//
//     path        sum of |dp| on the smoothed way at 100 Hz; `free` of it without contact
//     cutting     time in which volume was removed; `free` time without contact
//     hesitation  pauses of more than 2 s without cutting, all within 5 mm of bone; a tick without a
//                 radius ends one
//
// Units: SI. Thread: one. Memory: fixed.
#pragma once

#include <cstddef>

#include "burr/metrics/measured.h"
#include "burr/metrics/moment.h"
#include "burr/metrics/track.h"
#include "burr/volume/distance_to.h"

namespace burr::metrics {

struct Hesitation {
  std::size_t count = 0;
  double seconds = 0;  // of all
};

struct Times {
  double total = 0;    // [s]
  double cutting = 0;  // [s]
  double free = 0;     // [s]
  // Not assessable: the distance to bone is not measured, or the burr's radius is not recorded.
  Assessed<Hesitation> hesitation = NotAssessable{"not measured"};
  double irrigated = 0;  // cutting with coolant on [s]
  // of the volume removed with a contact: the share cut with the burr's pole, which hardly cuts:
  // sine of the angle between shaft and contact normal below 0.3
  double volume = 0, pole_volume = 0;  // [m^3]
};

class TimesMaker {
 public:
  // bone: distance to all that is bone; nullptr: hesitation is not measured
  explicit TimesMaker(const volume::DistanceTo* bone) : bone_(bone) {}
  void add(const Moment& now);
  [[nodiscard]] Times finish();

 private:
  void end_pause();
  const volume::DistanceTo* bone_;
  Times times_;
  Hesitation hesitation_;
  double pause_ = 0;     // [s]
  bool radius_ = false;  // some moment had one
};

struct Paths {
  double all = 0, free = 0;  // [m]
};
[[nodiscard]] Paths paths_of(const Track& track);

}  // namespace burr::metrics
