// workshop/recording.h - a session becomes a recording, and a recording becomes a bone again.
//
//     auto recorder = workshop::record(session, "s.mcap", about, on_trouble);   // before the first tick
//     session.run(20, progress);
//     session.set_recorder(nullptr);
//     auto account = (*recorder)->finish();
//
//     auto player = record::Player::open("s.mcap");
//     auto bone = workshop::bone_of(**player, {}, progress);         // as it was before the first tick
//     auto lost = workshop::removed_by_tissue(**player, progress);   // what the session took away
//
// Nothing is printed; a disk error is handed to on_trouble. Thread: see record/recorder.h; use a
// player on one thread at a time. Errors: one sentence that names the file.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/record/identity.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/record/timeline.h"
#include "burr/scenario/case.h"
#include "burr/scenario/recipe.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/volume/greys.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/spared.h"

namespace burr::workshop {

// What goes into a recording and is not known to the session itself.
struct About {
  scenario::Recipe recipe;        // its paths are not written into the file
  std::string format;             // of the source: importing::ImportSummary::format
  std::string motion;             // "pocket", "hand path", or the name of a device
  bool embed = false;             // the bone goes into the file
  std::optional<Tissues> spared;  // none: those marked in the table of tissues
  std::optional<scenario::Case> work_case;
  // Mode, learner and attempt. The hashes are filled in by record().
  record::Identity identity = {};
  // where the place of the scan is remembered, for example record::scan_list(); empty: nowhere
  std::string scan_list = {};
};
// For a session that was made from `prepared`, with the tissues that its case spares. bone: that of
// the session.
[[nodiscard]] About about(const Prepared& prepared, const volume::Bone& bone,
                          const std::string& motion);

// Records the session from its next tick on. on_trouble: called at most once, on the recorder's
// thread.
[[nodiscard]] Result<std::unique_ptr<record::Recorder>> record(
    sim::Session& session, const std::string& file, const About& about,
    std::function<void(const Error&)> on_trouble = {});

// The bone as it was before the first tick: from inside the file, from its formula, or from the
// user's own scan. given: the source and the tables, which only the user has. If its source is
// empty, the scan is searched for in BURR_VOLUME_PATH, beside the recording, and in the list of the
// scans of this computer (record/scan_list.h).
[[nodiscard]] Result<std::unique_ptr<volume::Bone>> bone_of(const record::Player& player,
                                                            const scenario::Recipe& given,
                                                            Progress& progress);

// The grey values of the scan, for slices, read again from given.source. nullptr: it is not a grey
// scan, not the scan of this recording, or cannot be read.
[[nodiscard]] std::shared_ptr<const volume::Greys> greys_of(const record::Player& player,
                                                            const scenario::Recipe& given,
                                                            Progress& progress);

// All that is needed to show a recording. player.bone_at(t, *bone) sets the bone to any moment.
struct Watched {
  std::unique_ptr<volume::Bone> bone;  // as it was before the first tick
  sim::Recorded settings;
  record::Timeline timeline;
};
[[nodiscard]] Result<Watched> watch(record::Player& player, const scenario::Recipe& given,
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
[[nodiscard]] Result<std::vector<TissueLoss>> removed_by_tissue(record::Player& player,
                                                                Progress& progress,
                                                                const scenario::Recipe& given = {});

}  // namespace burr::workshop
