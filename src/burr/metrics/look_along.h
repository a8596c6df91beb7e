// metrics/look_along.h - one pass over a recording for a measure that looks at the bone now and then.
//
// maker.add(moment) returns whether it wants to look; maker.look(bone) then gets the bone of that
// moment. Thread: any, one at a time. Error: of the recording, or Trouble::interrupted.
#pragma once

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/metrics/moment.h"
#include "burr/record/player.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

template <class Maker>
[[nodiscard]] Status look_along(record::Player& player, volume::Bone& bone, Maker& maker,
                                const char* doing, Progress& progress) {
  MomentReader reader(player);
  Moment now;
  while (reader.next(now)) {
    if (!maker.add(now)) continue;
    if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
    progress.report(static_cast<double>(now.tick) / static_cast<double>(player.end_tick()), doing);
    if (const Status shown = player.bone_at(now.t, bone); !shown) return shown;
    maker.look(bone);
  }
  return fine();
}

}  // namespace burr::metrics
