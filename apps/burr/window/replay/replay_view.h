// apps/burr/window/replay/replay_view.h - one recording as it is shown: bone and tool at the
// requested moment, and the values of that moment. One fills the window, or two share it.
//
//     ReplayView side(recorded, software, governor);
//     each frame:   side.want(t);
//                   side.look(effects, playing, left_handed);      // into recorded.scene
//                   ... draw recorded.scene ...
//                   side.drawn(took_s, redrawn);
//
// Thread: main; the bone is restored on a thread of its own (playback.h).
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "burr/render/held_tool.h"
#include "burr/tool/state.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/piece_look.h"
#include "burr/workshop/second_tool.h"
#include "burr/workshop/tool_looks.h"
#include "window/parts/slices.h"
#include "window/replay/playback.h"

namespace burr::app {

class ReplayView {
 public:
  // `recorded` must outlive this object. The destructor restores the look of its scene.
  ReplayView(Recorded& recorded, bool software, const render::GovernorSettings& governor);
  ~ReplayView();
  ReplayView(const ReplayView&) = delete;
  ReplayView& operator=(const ReplayView&) = delete;

  // Requests a moment, on the recording's own clock; limited to its start and end.
  void want(double t_s);
  // Puts what is ready into the scene. effects: show the traces of milling. playing: the burr
  // turns. left_handed: how a mouse's tool is drawn.
  void look(bool effects, bool playing, bool left_handed);
  void drawn(double took_s, double redrawn) { live_.drawn(took_s, redrawn); }
  void show_labels(bool shown);
  void look_plain() {
    live_.look_plain();
  }  // without the traces of milling, until there are new ones

  // Slices of this bone, and a slicer without colours for others; nothing is drawn until they are used.
  [[nodiscard]] Slices& slices() { return slices_; }
  [[nodiscard]] render::Slicer& plain_slicer() { return plain_; }
  // The scene's tissue_colours end with those of difference.h; false: too many tissues.
  [[nodiscard]] bool has_difference_colours() const { return difference_colours_; }
  // Bone and surface are those of the moment given to want(), and nobody changes them before the
  // next want().
  [[nodiscard]] bool settled() const { return settled_ > kSettled; }
  [[nodiscard]] math::Vec3 place() const { return shown_.row.contact.proxy; }  // of the burr

  [[nodiscard]] render::Scene& scene() { return recorded_.scene; }
  [[nodiscard]] const Recorded& recorded() const { return recorded_; }
  [[nodiscard]] const record::Timeline& line() const { return recorded_.timeline; }
  [[nodiscard]] double wanted() const { return wanted_; }  // [s]
  [[nodiscard]] double shown() const { return shown_.t; }  // moment that the scene shows  [s]
  [[nodiscard]] bool behind() const { return behind_; }    // so long that the user should see it
  // The values below are those of the requested moment, or, while playing, of one just before it.
  [[nodiscard]] bool known() const { return known_; }
  [[nodiscard]] double force() const { return values_.row.contact.force.norm(); }  // [N]
  [[nodiscard]] double removed() const {
    return values_.row.ledger.removed - values_.row.ledger.undone;
  }  // [m^3]
  [[nodiscard]] double speed() const { return values_.row.spindle_rad_s; }
  [[nodiscard]] tool::ToolState tool_of_values() const;
  [[nodiscard]] tool::ToolState tool() const;                            // in the hand then
  [[nodiscard]] const std::string& trouble() const { return trouble_; }  // "": none

 private:
  void lean_tool(bool left_handed);

  static constexpr int kSettled = 3;  // pictures without anything new

  Recorded& recorded_;
  std::vector<render::Colour> colours_;
  bool difference_colours_ = false;
  Slices slices_;         // with its watcher before the thread that writes the bone
  render::Slicer plain_;  // the same
  int settled_ = 0;
  workshop::LiveSurface live_;
  Playback::Shown shown_;
  Playback::Early values_;
  double wanted_ = -1,
         jump_ = -1;  // jump_: the moment that was jumped to; below 0: it is there [s]
  bool behind_ = false, known_ = false;
  std::string trouble_;
  workshop::ToolLooks looks_;  // of the tools of the rack
  render::HeldTool held_;
  workshop::SecondTool second_;  // of the other hand
  workshop::PieceLook piece_;    // of bone that is out of the bone
  std::chrono::steady_clock::time_point leaned_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point in_time_ = std::chrono::steady_clock::now();
  Playback playback_;  // last: its thread ends before the other members
};

}  // namespace burr::app
