// apps/burr/window/start/sessions.h - sessions at the window, kept by themselves so that one can go on.
//
//     state/sessions/session_20261122_193145.mcap  the recording, docs/recording.md
//     state/sessions/session_20261122_193145.json  its recipe, and whether it ended well
//     state/recent.toml                            scans opened lately
//
// The .json names the user's own file, since the bone comes from there; it lies in the user's own
// folder and can be read by nobody else. No name of a scan is shown unless settings say so.
// Thread: main; continue_session() any. Errors: sentences; trouble with what is kept never ends a
// session.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "commands/recording.h"
#include "commands/work.h"
#include "window/mill/make_ready.h"
#include "window/replay/film_job.h"
#include "window/shell/settings.h"

namespace burr::app {

struct KeptSession {
  std::filesystem::path file;  // the recording
  std::string title;           // one line that names no patient
  std::string when;            // "2026-11-22 19:31"
  WorkOptions options;         // as given at its start; volume.source as the user said it
  double seconds = 0, removed_mm3 = 0;
  bool clean = false;  // it ended as the user requested
  bool keep = false;   // never thrown away
  std::uintmax_t bytes = 0;
};

// Newest first, those that ended unexpectedly before all others; without those going on now.
[[nodiscard]] std::vector<KeptSession> kept_sessions(const std::filesystem::path& state);

// Throws the oldest away until no more than the settings allow are left.
void throw_old_away(const std::filesystem::path& state, const Settings& settings);

// The bone as that session left it, ready to be milled on. From the formula, the user's scan, or
// the recording itself.
[[nodiscard]] Result<Ready> continue_session(const KeptSession& kept, Progress& progress);

// A session being kept.
class Autosave {
 public:
  // options: as the user gave them. embed: the bone is none that a file or formula gives.
  // Trouble is told by trouble(), and the session goes on.
  Autosave(const std::filesystem::path& state, Ready& ready, const WorkOptions& options,
           bool embed);
  // After the servo stands.
  void finish();
  // What a film of it is made of, as it is now; none: it could not be kept.
  [[nodiscard]] std::optional<FilmSource> film_source() const;
  [[nodiscard]] bool keep();  // not to be thrown away; false: there is nothing
  [[nodiscard]] std::string trouble() const;
  [[nodiscard]] const std::filesystem::path& file() const { return kept_.file; }

 private:
  Status write_account() const;
  sim::Session& session_;
  KeptSession kept_;
  Recording recording_;
  bool recording_now_ = false;
  std::string trouble_;
};

// Scans and case files opened lately, newest first.
struct Recent {
  std::string path, title, when;
};
[[nodiscard]] std::vector<Recent> recent(const std::filesystem::path& state);
void remember(const std::filesystem::path& state, const std::string& path,
              const std::string& title);

}  // namespace burr::app
