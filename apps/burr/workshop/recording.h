// apps/burr/workshop/recording.h - what mill, run, replay and export share about recordings: making one, and
// finding its bone again.
#pragma once

#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/scenario/case.h"
#include "burr/sim/session.h"
#include "burr/volume/greys.h"
#include "workshop/open_volume.h"
#include "workshop/spared_distance.h"

namespace burr::app {

// A session being written down. Make it before the first tick, finish() after the last.
//
// A disk that refuses does not stop the session: it is said on stderr at once, the session goes on
// without recording, and finish() says it again, for the exit code.
class Recording {
 public:
  // motion: in our words, "pocket" or "hand path". embed: the bone goes into the file. spared: what
  // a case says must not be cut; none: what the table of tissues marks. work_case: goes into the
  // file, so that a score can be worked out from it.
  // Error: only what the user can put right before anything has begun (a folder that does not
  // exist, a name that another burr is recording to).
  Status start(sim::Session& session, const std::string& file, const scenario::Recipe& volume,
               const importing::ImportSummary& import, const std::string& motion, bool embed,
               const std::optional<Tissues>& spared = {},
               const std::optional<scenario::Case>& work_case = {});
  // The Error says what is missing.
  [[nodiscard]] Status finish(sim::Session& session);

  // "" while all is well, or the trouble in a few words for a window; any thread.
  [[nodiscard]] std::string trouble() const;
  // After finish(): the file, whether it is whole, how much of the session it holds.
  [[nodiscard]] nlohmann::json account() const;
  [[nodiscard]] record::RecordingAccount written() const;

 private:
  void tell(const Error& problem);

  std::string file_;
  std::unique_ptr<record::Recorder> recorder_;
  double rate_hz_ = 0;
  mutable std::mutex mutex_;  // the recorder's thread tells, main asks
  std::optional<Error> trouble_;
};

// The bone a recording began with: from inside the file, by formula, or from the user's own scan
// (search: given.source, BURR_VOLUME_PATH, beside the recording). given: what the user said on the
// command line; empty path: search.
[[nodiscard]] Result<std::unique_ptr<volume::Bone>> bone_of(const record::Player& player,
                                                            const scenario::Recipe& given,
                                                            Progress& progress);

// What the scan measured, for slices, read again from given.source. nullptr: no grey scan, not the
// one the recording was made from, or it cannot be read.
[[nodiscard]] std::shared_ptr<const volume::Greys> scan_greys_of(const record::Player& player,
                                                                 const scenario::Recipe& given,
                                                                 Progress& progress);

}  // namespace burr::app
