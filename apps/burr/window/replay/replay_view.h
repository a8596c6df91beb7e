// apps/burr/window/replay/replay_view.h - one recording as it is watched: its bone and tool at the moment asked
// for, and the numbers of that moment. One fills the window, two share it.
//
//     ReplayView side(recorded, software);
//     each frame:   side.want(t);
//                   side.look(effects, playing);      // into recorded.scene
//                   ... draw recorded.scene ...
//                   side.drawn(took_s, redrawn);
//
// Thread: main; the bone is made what it was on a thread of its own (playback.h).
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "burr/tool/state.h"
#include "burr/workshop/live_surface.h"
#include "window/replay/playback.h"

namespace burr::app {

class ReplayView {
 public:
  // It outlives the side; its scene looks as before when the side is gone.
  ReplayView(Recorded& recorded, bool software);
  ~ReplayView();
  ReplayView(const ReplayView&) = delete;
  ReplayView& operator=(const ReplayView&) = delete;

  // The moment to be shown, of its own clock; before its start or after its end: those.
  void want(double t_s);
  // What has come since goes into the scene. effects: what milling leaves is seen. playing: the
  // burr turns.
  void look(bool effects, bool playing);
  void drawn(double took_s, double redrawn) { live_.drawn(took_s, redrawn); }
  void show_labels(bool shown);

  [[nodiscard]] render::Scene& scene() { return recorded_.scene; }
  [[nodiscard]] const Recorded& recorded() const { return recorded_; }
  [[nodiscard]] const record::Timeline& line() const { return recorded_.timeline; }
  [[nodiscard]] double wanted() const { return wanted_; }    // [s]
  [[nodiscard]] double shown() const { return shown_.t; }    // that the scene is of  [s]
  [[nodiscard]] bool behind() const { return behind_; }      // for so long that it must be told
  [[nodiscard]] double force() const { return force_; }      // [N]
  [[nodiscard]] double removed() const { return removed_; }  // [m^3]
  [[nodiscard]] double speed() const { return shown_.row.spindle_rad_s; }
  [[nodiscard]] tool::ToolState tool() const;                            // in the hand then
  [[nodiscard]] const std::string& trouble() const { return trouble_; }  // "": none

 private:
  Recorded& recorded_;
  std::vector<render::Colour> colours_;
  workshop::LiveSurface live_;
  Playback::Shown shown_;
  double wanted_ = -1, force_ = 0, removed_ = 0;
  bool behind_ = false;
  std::string trouble_;
  std::chrono::steady_clock::time_point in_time_ = std::chrono::steady_clock::now();
  Playback playback_;  // last: its thread ends before the rest
};

}  // namespace burr::app
