// apps/burr/window/parts/autosave.h - records the running session so that it is kept in the list of sessions.
//
// A session that is continued goes on in its own recording. Thread: main. Errors: sentences; an error
// never ends a session.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "burr/base/result.h"
#include "burr/render/picture.h"
#include "shared/recorded_session.h"
#include "shared/user_settings.h"
#include "shared/window_session.h"
#include "window/parts/film_job.h"
#include "window/parts/kept_sessions.h"

namespace burr::app {

class Autosave {
 public:
  // options: as the user gave them. goes_on: the session that this one continues; nullptr: it is a
  // new one. Where its recording cannot go on, a new one with the bone inside begins, and apart() says
  // why. sealer: of a new session; nullptr: nobody. After an error the session goes on; trouble() returns the error.
  Autosave(const std::filesystem::path& state, WindowSession& ready, const WorkOptions& options,
           const Settings& settings, const KeptSession* goes_on = nullptr,
           std::shared_ptr<record::Sealer> sealer = nullptr);
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
  // The recording holds a part of the session only: the one that goes on in it began in another.
  [[nodiscard]] bool is_part() const { return embeds_; }
  [[nodiscard]] const std::string& apart() const { return apart_; }
  // Before finish(): what the list shows, and what the session goes on with.
  void take_picture(const render::Image& small);
  void suction_is(bool on) { kept_.suction = on; }

 private:
  void describe(const WorkOptions& options);
  [[nodiscard]] Status begin(const std::filesystem::path& folder, const KeptSession* goes_on);
  [[nodiscard]] Status record();
  WindowSession& ready_;
  sim::Session& session_;
  KeptSession kept_;
  Recording recording_;
  bool recording_now_ = false, is_kept_ = false;
  bool embeds_ = false, goes_on_ = false;
  std::string trouble_, apart_;
};

}  // namespace burr::app
