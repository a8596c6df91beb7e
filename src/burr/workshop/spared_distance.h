// workshop/spared_distance.h - how near the burr is to what must not be cut, for the eye and the ear.
//
// Thread: main. Memory: volume/distance_to.h; where there is nothing to spare, none.
#pragma once

#include <optional>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/volume/distance_to.h"
#include "burr/workshop/hearing.h"
#include "burr/workshop/spared.h"

namespace burr::workshop {

class SparedDistance {
 public:
  SparedDistance() = default;  // nothing is near
  // Before the first cut. Error: only Trouble::interrupted.
  [[nodiscard]] static Result<SparedDistance> make(const volume::Bone& bone, const Tissues& spared,
                                                   Progress& progress);

  // From a point [m]; empty: there is nothing to spare. Good as long as this lives.
  [[nodiscard]] Hearing::ToSpare distances() const;
  [[nodiscard]] bool empty() const { return distance_.empty(); }
  struct Near {
    std::string name;     // of the tissue
    double distance = 0;  // of the point from it; 0 inside [m]
  };
  // Nothing within reach, or nothing to spare: none.
  [[nodiscard]] std::optional<Near> nearest(const math::Vec3& p) const;

 private:
  volume::DistanceTo distance_;
  volume::TissueTable table_;
};

}  // namespace burr::workshop
