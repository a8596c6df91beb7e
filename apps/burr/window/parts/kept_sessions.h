// apps/burr/window/parts/kept_sessions.h - sessions in the window, kept automatically so that the user
// can continue one.
//
//     state/sessions/session_20261122_193145.mcap  the recording, docs/use/recording.md
//     state/sessions/session_20261122_193145.json  its recipe, and whether it ended well
//     state/sessions/session_20261122_193145.ppm   a small picture of its bone
//     state/sessions/session_20261122_193145.html  its full report, if the user asked for it
//     state/recent.toml                            scans opened lately
//
// The .json contains the path of the user's own file, because the bone comes from there. It lies in
// the user's own folder and only the user can read it. A session that is continued stays one: its
// recording grows, and so do its time and volume. How a session is kept while it runs: autosave.h. Names of scans are shown only if the
// settings allow it. Thread: main; continue_session() any. Errors: sentences; an error with kept
// files never ends a session.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/scenario/lesson.h"
#include "shared/user_settings.h"
#include "shared/window_session.h"
#include "shared/work.h"

namespace burr::app {

struct KeptSession {
  std::filesystem::path file;           // the recording
  std::string title;                    // one line that names no patient
  scenario::Texts titles;               // of its case, by language; empty: `title`
  std::string name;                     // that the user gave it; empty: none
  std::string when;                     // "2026-11-22 19:31": when it was worked on last
  WorkOptions options;                  // as given at its start; volume.source as the user typed it
  double seconds = 0, removed_mm3 = 0;  // with those of the sessions that it continued
  Earlier earlier;                      // of those that are recordings of their own
  bool suction = false;                 // beside the burr, at its end
  bool has_account = true;              // it can be given a name
  bool clean = false;                   // it ended because the user ended it
  bool keep = false;                    // never deleted automatically
  std::string rubric;                   // of its case, as rubric_of() gives it
  bool marks = false;  // its case has a rubric, and its mode lets the user see the marks
  std::uintmax_t bytes = 0;
};

// Newest first, but sessions that ended unexpectedly before all others. Sessions still running are
// left out.
[[nodiscard]] std::vector<KeptSession> kept_sessions(const std::filesystem::path& state);

// What the list shows: the name that the user gave it, or the title in the user's language.
[[nodiscard]] std::string shown_title(const KeptSession& kept);
// A line of at most kLongestName letters; empty: the title is shown again.
inline constexpr std::size_t kLongestName = 60;
[[nodiscard]] Status name_session(KeptSession& kept, const std::string& name);
// Its small picture; the file may not be there.
[[nodiscard]] std::filesystem::path picture_of(const std::filesystem::path& recording);

// Deletes the oldest sessions until the number and size that the settings allow are kept; never
// `needed`, a recording.
void throw_old_away(const std::filesystem::path& state, const Settings& settings,
                    const std::filesystem::path& needed = {});
// Deletes one with all that belongs to it.
void remove_session(const std::filesystem::path& recording);

// What the list knows of a session, beside its recording.
[[nodiscard]] Status write_account(const KeptSession& kept);
// "2026-11-22 19:31", and the same for a name of a file: "session_20261122_193145".
[[nodiscard]] std::string time_now();
[[nodiscard]] std::string name_now();
// Creates a folder that only its owner can read.
[[nodiscard]] Status make_own_folder(const std::filesystem::path& folder);

// The bone as that session left it, ready to be milled further, with all that the session was: mode,
// learner, steps, water, suction, tool and declaration. The bone comes from the formula, the user's
// scan, or the recording itself. Where the recording cannot go on, `left.part` is nullptr.
[[nodiscard]] Result<WindowSession> continue_session(const KeptSession& kept, Progress& progress);

// Scans, case files and recordings that were opened recently, newest first.
struct Recent {
  std::string path, title, when;
  scenario::Texts titles = {};  // of a case, by language; empty: `title`
};
[[nodiscard]] std::vector<Recent> recent(const std::filesystem::path& state);
void remember(const std::filesystem::path& state, const std::string& path, const std::string& title,
              const scenario::Texts& titles = {});

}  // namespace burr::app
