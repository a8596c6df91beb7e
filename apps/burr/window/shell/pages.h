// apps/burr/window/shell/pages.h - the order of pages: start, loading, milling, and back.
//
// Thread: main.
#pragma once

#include <functional>
#include <string>

#include "shared/window_session.h"
#include "shared/work.h"
#include "window/mill/window_options.h"
#include "window/replay/replay_page.h"
#include "window/ui/desk.h"

namespace burr::app {

struct KeptSession;

struct PagesOptions {
  double seconds = 0;           // closes after this time on one page; 0: never
  std::string folder = {};      // where the key P saves pictures
  std::string screenshot = {};  // PNG of the last picture of the window
  bool sound = true;
  // only hand, suction, publish_as and identity of it are used; without a hand, that of the settings is
  // taken
  WorkOptions led = {};
  bool mode_given = false;  // that of `led` counts; otherwise the one chosen last
};

// Runs until the user leaves. An error with one bone is shown on the start page, and burr goes on.
[[nodiscard]] Status run_pages(Desk& desk, const PagesOptions& options);

// Opens a case or a scan; for use as the work of a Loading.
[[nodiscard]] Result<WindowSession> open_ready(WorkOptions options, Progress& progress);

// Of its case, in the user's language; without a case as ready.title.
[[nodiscard]] std::string title_of(const WindowSession& ready);

// Opens a recording while the loading page is shown, then shows the page that plays it. given: what
// the user said about its volume. Error: one sentence; Trouble::interrupted if the user cancelled.
[[nodiscard]] Result<Closed> watch_file(Desk& desk, const std::string& file,
                                        const scenario::BoneRecipe& given,
                                        const WatchOptions& options);

// Runs one session, with the loudspeaker (if `window` wants sound) and the distances to structures.
[[nodiscard]] Result<Closed> mill_with_sound(Desk& desk, WindowSession& ready,
                                             const WindowOptions& window);

// Runs one session and keeps its recording if the settings say so. If the user declares the work on a
// case done, the learner's own marks and those of the machine follow; the result is then
// Closed::page, Closed::again or Closed::window. goes_on: the session that this one continues, in the
// same recording; nullptr: it is a new one.
[[nodiscard]] Result<Closed> mill_and_keep(Desk& desk, WindowSession& ready,
                                           const WorkOptions& options, const KeptSession* goes_on,
                                           const WindowOptions& window);

// The number of the learner's next attempt, where attempts are counted.
inline void next_attempt(record::Identity& identity) {
  if (identity.attempt > 0) ++identity.attempt;
}

// After a session that was declared done, before its recording is closed: the learner's own marks go
// into it. false: the user closed the window.
[[nodiscard]] Result<bool> ask_own_marks(Desk& desk, const WindowSession& ready,
                                         record::Diary& diary, const WindowOptions& window);

}  // namespace burr::app
