// workshop/recorded_bone.h - the bone of a recording, and what the session took from it.
//
//     auto player = record::Player::open("s.mcap");
//     auto bone = workshop::bone_of(**player, {}, progress);         // as it was before the first tick
//     auto lost = workshop::removed_by_tissue(**player, progress);   // what the session took away
//
// Nothing is printed. Thread: a player on one thread at a time. Errors: one sentence that names the file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/record/player.h"
#include "burr/record/timeline.h"
#include "burr/scenario/recipe.h"
#include "burr/sim/session_words.h"
#include "burr/volume/bone.h"

namespace burr::volume {
struct Greys;
}

namespace burr::workshop {

// The bone as it was before the first tick: from inside the file, from its formula, or from the
// user's own scan. given: the source and the tables, which only the user has. If its source is
// empty, the scan is searched for in BURR_VOLUME_PATH, beside the recording, and in the list of the
// scans of this computer (record/scan_list.h).
[[nodiscard]] Result<std::unique_ptr<volume::Bone>> bone_of(const record::Player& player,
                                                            const scenario::BoneRecipe& given,
                                                            Progress& progress);

// The grey values of the scan, for slices, read again from given.source. nullptr: it is not a grey
// scan, not the scan of this recording, or cannot be read.
[[nodiscard]] std::shared_ptr<const volume::Greys> greys_of(const record::Player& player,
                                                            const scenario::BoneRecipe& given,
                                                            Progress& progress);

// All that is needed to show a recording. player.bone_at(t, *bone) sets the bone to any moment.
struct Watched {
  std::unique_ptr<volume::Bone> bone;  // as it was before the first tick
  sim::Recorded settings;
  record::Timeline timeline;
};
[[nodiscard]] Result<Watched> watch(record::Player& player, const scenario::BoneRecipe& given,
                                    Progress& progress);

// One tissue whose volume has changed.
struct TissueLoss {
  std::string name;
  double removed = 0;  // negative: volume was added  [m^3]
  bool spare = false;  // must not be cut
};
// Tissues whose volume differs by more than 0.01 mm^3, largest loss first.
[[nodiscard]] std::vector<TissueLoss> losses(const volume::Bone& before, const volume::Bone& now);
// The same for a whole recording; bone_of() finds its bone.
[[nodiscard]] Result<std::vector<TissueLoss>> removed_by_tissue(
    record::Player& player, Progress& progress, const scenario::BoneRecipe& given = {});

}  // namespace burr::workshop
