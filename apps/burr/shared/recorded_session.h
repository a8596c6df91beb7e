// apps/burr/shared/recorded_session.h - a session recorded by a command: what the library's recorder
// reports goes to stderr, into JSON and into the exit code.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>

#include "burr/base/result.h"
#include "burr/importing/import.h"
#include "burr/record/diary.h"
#include "burr/record/earlier_part.h"
#include "burr/record/identity.h"
#include "burr/record/recorder.h"
#include "burr/scenario/case.h"
#include "burr/sim/session.h"
#include "burr/workshop/spared.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"
#include "shared/user_settings.h"

namespace burr::app {

// Records a session. Call start() before the first tick and finish() after the last.
//
// A disk error does not stop the session. It is reported on stderr at once, the session goes on
// without recording, and finish() returns the error again, for the exit code.
class Recording {
 public:
  // Call it before start(): where the place of the scan is remembered; empty: nowhere.
  void remember_scan_in(std::string list) { scan_list_ = std::move(list); }
  // Call it before start(): mode, learner and attempt of this session.
  void belongs_to(record::Identity identity) { identity_ = std::move(identity); }
  // Call it before start(): the recording that this one goes on with, in the same file.
  void goes_on_with(std::shared_ptr<const record::EarlierPart> part) { earlier_ = std::move(part); }
  // Call it before start(): who seals the recording; nullptr: nobody.
  void sealed_by(std::shared_ptr<record::Sealer> sealer) { sealer_ = std::move(sealer); }
  // motion: burr's own name, "pocket" or "hand path". embed: writes the bone into the file. spared:
  // tissues that the case forbids to cut; none: those that the table of tissues marks. work_case:
  // written into the file, so that a score can be computed from it.
  // Error: only for what the user can correct before the session begins (the folder does not exist,
  // or another burr is recording to this name).
  Status start(sim::Session& session, const std::string& file, const scenario::BoneRecipe& volume,
               const importing::ImportSummary& import, const std::string& motion, bool embed,
               const std::optional<workshop::Tissues>& spared = {},
               const std::optional<scenario::Case>& work_case = {});
  // The Error says what is missing.
  // stopped: the session was ended before its time; the recording says so.
  [[nodiscard]] Status finish(sim::Session& session, bool stopped = interrupted());

  // Takes what the user sees and does; nullptr before start() and where nothing is recorded. If
  // nobody ends it, finish() does: the time was up, or the session was stopped.
  [[nodiscard]] record::Diary* diary() { return diary_ ? &*diary_ : nullptr; }

  // "" while there is no error, otherwise the error in a few words, for a window; any thread.
  [[nodiscard]] std::string trouble() const;
  // After finish(): the file, whether it is complete, how much of the session it contains.
  [[nodiscard]] nlohmann::json account() const;
  [[nodiscard]] record::RecordingStats written() const;

 private:
  void tell(const Error& problem);

  std::string file_, scan_list_;
  bool stopped_ = false, ending_ = false;
  record::Identity identity_;
  std::shared_ptr<const record::EarlierPart> earlier_;
  std::shared_ptr<record::Sealer> sealer_;
  std::unique_ptr<record::Recorder> recorder_;
  std::optional<record::Diary> diary_;
  double rate_hz_ = 0;
  mutable std::mutex mutex_;  // trouble_ is set by the recorder's thread, read by main
  std::optional<Error> trouble_;
};

// The list for remember_scan_in(), by the user's settings. With `remember_scans = false` there is
// none, and an older one is deleted.
[[nodiscard]] std::string scan_list_by(const Settings& settings,
                                       const std::filesystem::path& state);
// The same with the user's settings file and state folder.
[[nodiscard]] std::string users_scan_list();

}  // namespace burr::app
