// metrics/heat.h - how warm the cutting made each tissue: the heat grid of a session (thermal/heating.h),
// run again from the recorded cutting power.
//
//     peak      highest temperature of a cell that holds some of the tissue [deg C]
//     CEM43     its largest heat dose, minutes at 43 deg C (thermal/dose.h)
//
// A row of 10 ms carries the energy that went into the bone in it, at the place of the contact. Heat of a
// burr that rubs without cutting is not in a recording, so it is missing here. The constants of heat are
// published ranges: for comparison, never for a mark. Frame: world. Units: SI, and as named. Thread: one.
// Memory: of thermal/heat_grid.h. Cost: two passes over the ticks, the bone's changes, and the grid.
#pragma once

#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/math/aabb.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/moment.h"
#include "burr/record/player.h"
#include "burr/thermal/heating.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct Heat {
  struct OfTissue {
    std::string name;
    double peak_c = 0;     // [deg C]
    double cem43_min = 0;  // [min]
  };
  std::vector<OfTissue> tissues;  // those in the box around the work, in the bone's order
  thermal::HeatLedger ledger;
};

class HeatMaker {
 public:
  // bone: the one that the work cuts, as it is at the first moment. work: the box of the work, which
  // reaches 10 mm beyond it [m].
  HeatMaker(volume::Bone& bone, const math::Aabb& work, const thermal::HeatSettings& settings);
  // The bone must be as it is at that moment, to a tenth of a second.
  void add(const Moment& now);
  // Not assessable: no power went into the bone.
  [[nodiscard]] Assessed<Heat> finish();

 private:
  const volume::Bone& bone_;
  thermal::Heating heating_;
  thermal::HeatRow row_;
  double spent_ = 0;      // [J]
  double last_row_ = -1;  // [s]
};

// bone: as it was opened; it is left as at the end. Error: as of Player::bone_at(), or interrupted.
[[nodiscard]] Result<Assessed<Heat>> heat_of(record::Player& player, volume::Bone& bone,
                                             const thermal::HeatSettings& settings,
                                             Progress& progress);

}  // namespace burr::metrics
