// apps/burr/window/shell/pages.h - from page to page: start, loading, milling, and back.
//
// Thread: main.
#pragma once

#include <functional>
#include <string>

#include "commands/work.h"
#include "window/mill/make_ready.h"
#include "window/mill/window_options.h"
#include "window/replay/replay_page.h"
#include "window/shell/desk.h"

namespace burr::app {

struct PagesOptions {
  double seconds = 0;           // closes by itself after so long on one page; 0: never
  std::string folder = {};      // where P leaves pictures
  std::string screenshot = {};  // of the window as it was last
  bool sound = true;
  // of it only what leads: hand, suction, told_as; without a hand the settings say
  WorkOptions led = {};
};

// Until the user has had enough. Trouble with one bone is told on the start page, and one goes on.
[[nodiscard]] Status run_pages(Desk& desk, const PagesOptions& options);

// A case or a scan with the loading page; as a Loading wants it.
[[nodiscard]] Result<Ready> open_ready(WorkOptions options, Progress& progress);

// A recording with the loading page, and the page it is watched on. given: what the user said of
// its volume. Error: one sentence; Trouble::interrupted if the user cancelled.
[[nodiscard]] Result<Left> watch_file(Desk& desk, const std::string& file,
                                      const scenario::Recipe& given, const WatchOptions& options);

// One session with its loudspeaker and what is near, if `window` wants to hear it.
[[nodiscard]] Result<Left> mill_with_sound(Desk& desk, Ready& ready, const WindowOptions& window);

// One session that keeps itself where the settings say so.
[[nodiscard]] Result<Left> mill_and_keep(Desk& desk, Ready& ready, const WorkOptions& options,
                                         bool embed, const WindowOptions& window);

}  // namespace burr::app
