// workshop/spared_distance.h - the distance from the burr to the tissues that must not be cut, for
// the window and the sound.
//
// Thread: main. Memory: see volume/distance_to.h; none if there is nothing to spare.
#pragma once

#include <optional>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/volume/distance_to.h"
#include "burr/workshop/sound_tracker.h"
#include "burr/workshop/spared.h"

namespace burr::workshop {

class SparedDistance {
 public:
  SparedDistance() = default;  // nothing to spare
  // Call it before the first cut. Error: only Trouble::interrupted.
  [[nodiscard]] static Result<SparedDistance> make(const volume::Bone& bone, const Tissues& spared,
                                                   Progress& progress);

  // The distance from a point  [m]; empty: there is nothing to spare. Valid while this object
  // lives.
  [[nodiscard]] SoundTracker::ToSpare distances() const;
  [[nodiscard]] bool empty() const { return distance_.empty(); }
  struct Near {
    std::string name;     // of the tissue
    double distance = 0;  // from the point to it; 0 inside  [m]
  };
  // nullopt: nothing to spare, or nothing within the range of volume/distance_to.h.
  [[nodiscard]] std::optional<Near> nearest(const math::Vec3& p) const;

 private:
  volume::DistanceTo distance_;
  volume::TissueTable table_;
};

}  // namespace burr::workshop
