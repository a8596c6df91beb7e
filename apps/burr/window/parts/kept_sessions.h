// apps/burr/window/parts/kept_sessions.h - sessions in the window, kept automatically so that the user
// can continue one.
//
//     state/sessions/session_20261122_193145.mcap  the recording, docs/use/recording.md
//     state/sessions/session_20261122_193145.json  its recipe, and whether it ended well
//     state/sessions/session_20261122_193145.html  its full report, if the user asked for it
//     state/recent.toml                            scans opened lately
//
// The .json contains the path of the user's own file, because the bone comes from there. It lies in
// the user's own folder and only the user can read it. Names of scans are shown only if the
// settings allow it. Thread: main; continue_session() any. Errors: sentences; an error with kept
// files never ends a session.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "shared/recorded_session.h"
#include "shared/user_settings.h"
#include "shared/window_session.h"
#include "shared/work.h"
#include "window/parts/film_job.h"

namespace burr::app {

struct KeptSession {
  std::filesystem::path file;           // the recording
  std::string title;                    // one line that names no patient
  std::string when;                     // "2026-11-22 19:31"
  WorkOptions options;                  // as given at its start; volume.source as the user typed it
  double seconds = 0, removed_mm3 = 0;  // with those of the sessions that it continued
  Earlier earlier;                      // of these alone
  bool clean = false;                   // it ended because the user ended it
  bool keep = false;                    // never deleted automatically
  std::string rubric;                   // of its case, as rubric_of() gives it
  bool marks = false;  // its case has a rubric, and its mode lets the user see the marks
  std::uintmax_t bytes = 0;
};

// Newest first, but sessions that ended unexpectedly before all others. Sessions still running are
// left out.
[[nodiscard]] std::vector<KeptSession> kept_sessions(const std::filesystem::path& state);

// Deletes the oldest sessions until the number and size that the settings allow are kept.
void throw_old_away(const std::filesystem::path& state, const Settings& settings);

// The bone as that session left it, ready to be milled further. It comes from the formula, the
// user's scan, or the recording itself.
[[nodiscard]] Result<WindowSession> continue_session(const KeptSession& kept, Progress& progress);

// Records the running session so that it is kept.
class Autosave {
 public:
  // options: as the user gave them. embed: the bone is stored in the recording, because no file or
  // formula gives it. After an error the session goes on; trouble() returns the error.
  Autosave(const std::filesystem::path& state, WindowSession& ready, const WorkOptions& options,
           bool embed, const Settings& settings);
  // Call it after the servo has stopped. Error: what was done is not kept, or not all of it.
  [[nodiscard]] Status finish();
  // Of the recording that is kept; empty: there is none.
  [[nodiscard]] std::string kept_file() const {
    return trouble_.empty() && is_kept_ ? kept_.file.string() : std::string();
  }
  // The source for a film of the session so far; none: it could not be recorded.
  [[nodiscard]] std::optional<FilmSource> film_source() const;
  // Of the recording; nullptr: there is none.
  [[nodiscard]] record::Diary* diary() { return recording_now_ ? recording_.diary() : nullptr; }
  [[nodiscard]] bool keep();  // marks it as never to be deleted; false: there is nothing to keep
  [[nodiscard]] std::string trouble() const;
  [[nodiscard]] const std::filesystem::path& file() const { return kept_.file; }

 private:
  Status write_account() const;
  sim::Session& session_;
  KeptSession kept_;
  Recording recording_;
  bool recording_now_ = false, is_kept_ = false;
  std::string trouble_;
};

// Scans, case files and recordings that were opened recently, newest first.
struct Recent {
  std::string path, title, when;
};
[[nodiscard]] std::vector<Recent> recent(const std::filesystem::path& state);
void remember(const std::filesystem::path& state, const std::string& path,
              const std::string& title);

}  // namespace burr::app
