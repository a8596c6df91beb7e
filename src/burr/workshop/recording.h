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
// Nothing is printed; a trouble of the disk comes to on_trouble. Thread: as record/recorder.h says;
// a player on one thread at a time. Errors: one sentence that names the file.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
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

// What a recording says of its session beside what the session knows itself.
struct About {
  scenario::Recipe recipe;        // with its paths; they do not go into the file
  std::string format;             // of the source: importing::ImportSummary::format
  std::string motion;             // in our words: "pocket", "hand path", a device's name
  bool embed = false;             // the bone goes into the file
  std::optional<Tissues> spared;  // none: what the table of tissues marks
  std::optional<scenario::Case> work_case;
};
// Of a session that prepare() began; with the tissues that its case spares. bone: the session's.
[[nodiscard]] About about(const Prepared& prepared, const volume::Bone& bone,
                          const std::string& motion);

// The session is recorded from its next tick on. on_trouble: called at most once, on a thread of
// the recorder.
[[nodiscard]] Result<std::unique_ptr<record::Recorder>> record(
    sim::Session& session, const std::string& file, const About& about,
    std::function<void(const Error&)> on_trouble = {});

// The bone a recording began with: from inside the file, by formula, or from the user's own scan
// (search: given.source, BURR_VOLUME_PATH, beside the recording). given: what only the user has, the
// source and tables; empty source: search.
[[nodiscard]] Result<std::unique_ptr<volume::Bone>> bone_of(const record::Player& player,
                                                            const scenario::Recipe& given,
                                                            Progress& progress);

// What the scan measured, for slices, read again from given.source. nullptr: no grey scan, not the
// one the recording was made from, or it cannot be read.
[[nodiscard]] std::shared_ptr<const volume::Greys> greys_of(const record::Player& player,
                                                            const scenario::Recipe& given,
                                                            Progress& progress);

// All that is needed to look at a recording: bone_at() of the player shows `bone` at any moment.
struct Watched {
  std::unique_ptr<volume::Bone> bone;  // as it was before the first tick
  sim::Recorded settings;
  record::Timeline timeline;
};
[[nodiscard]] Result<Watched> watch(record::Player& player, const scenario::Recipe& given,
                                    Progress& progress);

// One tissue that lost (or, negative, gained) volume.
struct TissueLoss {
  std::string name;
  double removed = 0;  // [m^3]
  bool spare = false;  // must not be cut
};
// Tissues whose volume differs by more than a hundredth of a mm^3, most lost first.
[[nodiscard]] std::vector<TissueLoss> losses(const volume::Bone& before, const volume::Bone& now);
// The same of a whole recording; its bone is looked for as bone_of() does.
[[nodiscard]] Result<std::vector<TissueLoss>> removed_by_tissue(record::Player& player,
                                                                Progress& progress,
                                                                const scenario::Recipe& given = {});

}  // namespace burr::workshop
