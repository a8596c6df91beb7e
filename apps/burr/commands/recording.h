// apps/burr/commands/recording.h - a session recorded by a command: what the library's recorder
// reports goes to stderr, into JSON and into the exit code.
#pragma once

#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "burr/base/result.h"
#include "burr/importing/import.h"
#include "burr/record/recorder.h"
#include "burr/scenario/case.h"
#include "burr/sim/session.h"
#include "burr/workshop/spared.h"

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
               const std::optional<workshop::Tissues>& spared = {},
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

}  // namespace burr::app
