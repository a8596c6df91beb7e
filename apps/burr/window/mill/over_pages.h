// apps/burr/window/mill/over_pages.h - the pages that open over the bone, one at a time: help,
// settings, export, and the questions whether the work is done and whether to leave it.
//
// Thread: main; draw() between Ui::begin() and Ui::draw().
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "burr/render/scene.h"
#include "burr/sim/session.h"
#include "shared/word_names.h"
#include "window/mill/window_options.h"
#include "window/parts/export_page.h"
#include "window/ui/help.h"
#include "window/ui/settings_page.h"

namespace burr::app {

class OverPages {
 public:
  // The rows of the help page; left_handed: the mouse buttons are exchanged.
  using HelpRows = std::vector<HelpRow> (*)(bool left_handed);
  // Make it before the session starts, like ExportPage.
  OverPages(Desk& desk, sim::Session& session, const render::Scene& scene,
            const WindowOptions& options, HelpRows help_rows);

  [[nodiscard]] bool open() const {
    return help_ || settings_ || asks_done_ || asks_leave_ || export_.shown();
  }
  void close();
  void toggle_help(bool pads);  // pads: the page about gamepad, pedal and SpaceMouse first
  void toggle_settings();
  void toggle_export();
  void ask_done() { close(), asks_done_ = true; }
  [[nodiscard]] bool asks_done() const { return asks_done_; }
  void ask_leave() { close(), asks_leave_ = true; }
  [[nodiscard]] bool asks_leave() const { return asks_leave_; }

  [[nodiscard]] ExportPage& exporting() { return export_; }
  [[nodiscard]] const ExportPage& exporting() const { return export_; }

  // What the user changed on the settings page; it is already in desk.settings and
  // device->preferences.
  struct Changed {
    bool settings = false, force_limit = false, device = false;
    bool done = false;   // the user is done
    bool leave = false;  // and leaves
  };
  // device: the haptic device that moves the burr; nullptr: none. open_steps: of the case. leaving:
  // what becomes of the session that is left.
  [[nodiscard]] Changed draw(DeviceLeaf* device, std::size_t open_steps, Word leaving);

 private:
  Changed draw_settings_page(DeviceLeaf* device);
  bool draw_done(std::size_t open_steps);  // true: yes
  bool draw_leave(Word told);              // true: yes

  Desk& desk_;
  HelpRows help_rows_;
  bool help_, help_pads_ = false, settings_ = false, settings_pads_ = false, asks_done_ = false,
              asks_leave_ = false;
  ExportPage export_;
};

}  // namespace burr::app
