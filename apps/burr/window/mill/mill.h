// apps/burr/window/mill/mill.h - the page for milling as one object: in each picture it connects the
// user, the session and the bone.
//
// It owns the parts (mill_parts.h says which, and who knows whom), what a key and a button do
// (mill_actions.h), what the window reports (mill_input.h), and the link to the instructor
// (mill_station.h). Its own work is the loop of pictures (window.cpp), and what stands over a picture
// (mill_status.cpp): the figures, the two texts, the panels. Only these two files include this header.
//
// Thread: main. Frame: world. Units: SI.
#pragma once

#include <chrono>
#include <string>

#include "burr/record/diary.h"
#include "burr/surface/worker.h"
#include "burr/workshop/live_surface.h"
#include "window/mill/mill_actions.h"
#include "window/mill/mill_input.h"
#include "window/mill/mill_parts.h"
#include "window/mill/mill_site.h"
#include "window/mill/mill_station.h"
#include "window/mill/tick_watch.h"

namespace burr::app {

class Mill {
 public:
  Mill(Desk& desk, sim::Session& session, const mouse::Hands& hands, surface::Worker& worker,
       render::Scene& scene, const WindowOptions& options);
  Mill(const Mill&) = delete;  // its parts refer to it
  Mill& operator=(const Mill&) = delete;

  Result<Closed> run();

 private:
  using Clock = std::chrono::steady_clock;

  // ---- window.cpp
  void begin();  // call it when the live surface is complete
  Status frame(workshop::LiveSurface& live);
  void look_at_session();
  void look_at_case();  // from the first tick on
  Status show(workshop::LiveSurface& live);
  void end(workshop::LiveSurface& live);
  void stop_at_injury();
  void keep_fault_of(const device::Device& hand, const tick::FaultReport& fault);
  [[nodiscard]] record::Sight sight() const;

  // ---- mill_status.cpp
  void note_troubles();
  void update_status();
  [[nodiscard]] HudState hud() const;
  [[nodiscard]] ToolbarState bar_state() const;
  void panels();
  void draw_figures();
  void draw_menu_panel();
  void pages();
  [[nodiscard]] Word becomes_of_it() const;
  void keep_device_preferences();
  void leave_picture();

  Desk& desk_;
  sim::Session& session_;
  surface::Worker& worker_;
  render::Scene& scene_;
  mouse::Hands hands_;
  WindowOptions options_;
  tick::TickRow row_;  // the newest
  TickWatch ticks_;
  MillNotes notes_;
  MillOver over_;
  MillSite site_;
  MillParts parts_;
  MillActions actions_;
  MillInput input_;
  MillStation station_;
  bool time_over_ = false;
  int picture_step_ = 0;              // of the governor
  Clock::time_point window_drawn_{};  // while a headset is worn
};

// As flag_words(), in the user's language, without the flags that the page shows in other ways.
[[nodiscard]] std::string flag_texts(std::uint32_t flags);

}  // namespace burr::app
