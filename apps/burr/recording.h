// apps/burr/recording.h - what mill, run, replay and export share about recordings: making one, and
// finding its bone again.
#pragma once

#include <memory>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/sim/session.h"
#include "volume_options.h"

namespace burr::app {

// A session being written down. Make it before the first tick, finish() after the last.
class Recording {
 public:
  // motion: in our words, "pocket" or "hand path". embed: the bone goes into the file.
  Status start(sim::Session& session, const std::string& file, const VolumeOptions& volume,
               const io::ImportSummary& import, const std::string& motion, bool embed);
  // What was written; the Error says what is missing.
  [[nodiscard]] Result<record::RecordingAccount> finish(sim::Session& session);

 private:
  std::unique_ptr<record::Recorder> recorder_;
};

// The bone a recording began with: from inside the file, by formula, or from the user's own scan
// (search: given.path, BURR_VOLUME_PATH, beside the recording). given: what the user said on the
// command line; empty path: search.
[[nodiscard]] Result<std::unique_ptr<volume::Bone>> bone_of(const record::Player& player,
                                                            const VolumeOptions& given,
                                                            Progress& progress);

}  // namespace burr::app
