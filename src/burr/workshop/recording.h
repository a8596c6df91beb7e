// workshop/recording.h - a session becomes a recording. The way back: recorded_bone.h.
//
//     auto recorder = workshop::record(session, "s.mcap", about, on_trouble);   // before the first tick
//     session.run(20, progress);
//     session.set_recorder(nullptr);
//     auto account = (*recorder)->finish();
//
// Nothing is printed; a disk error is handed to on_trouble. Thread: see record/recorder.h. Errors: one
// sentence that names the file.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "burr/base/result.h"
#include "burr/record/earlier_part.h"
#include "burr/record/identity.h"
#include "burr/record/recorder.h"
#include "burr/scenario/case.h"
#include "burr/scenario/recipe.h"
#include "burr/sim/session.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/spared.h"

namespace burr::workshop {

// What goes into a recording and is not known to the session itself.
struct About {
  scenario::BoneRecipe recipe;    // its paths are not written into the file
  std::string format;             // of the source: importing::ImportSummary::format
  std::string motion;             // "pocket", "hand path", or the name of a device
  bool embed = false;             // the bone goes into the file
  std::optional<Tissues> spared;  // none: those marked in the table of tissues
  std::optional<scenario::Case> work_case;
  // Mode, learner and attempt. The hashes are filled in by record().
  record::Identity identity = {};
  // where the place of the scan is remembered, for example record::scan_list(); empty: nowhere
  std::string scan_list = {};
  // The recording that this one goes on with, in the same file (record/earlier_part.h); none: a new
  // one.
  std::shared_ptr<const record::EarlierPart> earlier = {};
  // Who seals the recording (record/sealer.h); none: nobody.
  std::shared_ptr<record::Sealer> sealer = {};
};
// For a session that was made from `prepared`, with the tissues that its case spares. bone: that of
// the session.
[[nodiscard]] About about(const PreparedBone& prepared, const volume::Bone& bone,
                          const std::string& motion);

// Records the session from its next tick on. on_trouble: called at most once, on the recorder's
// thread.
[[nodiscard]] Result<std::unique_ptr<record::Recorder>> record(
    sim::Session& session, const std::string& file, const About& about,
    std::function<void(const Error&)> on_trouble = {});

}  // namespace burr::workshop
