// apps/burr/window/mill/mill_site.h - what the parts of the page for milling work on: the window, the
// session, the bone in its picture, the hands, the newest row, and what lies over the bone.
//
// Plain references; the page owns what they name and outlives its parts. A part keeps only those that it needs. Thread: main.
#pragma once

#include <optional>

#include "burr/mouse/mouse_hand.h"
#include "burr/render/scene.h"
#include "burr/sim/session.h"
#include "burr/tick/rows.h"
#include "window/mill/menu_panel.h"
#include "window/mill/mill_notes.h"
#include "window/mill/over_pages.h"
#include "window/mill/window_options.h"
#include "window/ui/desk.h"

namespace burr::app {

// What lies over the bone.
struct MillOver {
  std::optional<OverPages> pages = {};  // while the session runs
  std::optional<Menu> menu = {};        // which one is open
  bool panels = true;                   // are shown

  [[nodiscard]] bool page() const { return pages && pages->open(); }
};

struct MillSite {
  Desk& desk;
  sim::Session& session;
  render::Scene& scene;
  mouse::Hands& hands;
  const WindowOptions& options;
  const tick::TickRow& row;  // the newest: another at each picture
  MillNotes& notes;
  MillOver& over;
};

}  // namespace burr::app
