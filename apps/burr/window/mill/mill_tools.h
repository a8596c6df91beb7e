// apps/burr/window/mill/mill_tools.h - what is in the hand on the page for milling: the drill and its
// burr, the rack of tools, how the mouse holds a tool, the mirror, the suction beside the burr, and
// the tool of the other hand. Draws them, and sees what they do to the picture.
//
// Commands go to the servo; each says in the notes what it did. Thread: main; draw_panel() between
// Ui::begin() and Ui::draw(). Frame: world. Units: SI.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "burr/mouse/grip.h"
#include "burr/render/held_tool.h"
#include "burr/sim/piece_mover.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/tool_looks.h"
#include "window/mill/drill.h"
#include "window/mill/mill_case.h"
#include "window/mill/mill_site.h"
#include "window/mill/suction_tube.h"
#include "window/mill/tool_rack.h"
#include "window/mill/worn_headset.h"
#include "window/parts/mirror_mode.h"

namespace burr::app {

class MillTools {
 public:
  using Nearest = MillCase::Nearest;
  MillTools(const MillSite& site, MillCase& work_case, const WornHeadset& headset);

  // ---- what the user does
  // Sends nothing by itself: its calls return what is to be noted.
  [[nodiscard]] Drill& drill() { return drill_; }
  [[nodiscard]] const Drill& drill() const { return drill_; }
  void take(int place);  // ToolRack::kCutting, kDiamond, or a number of the session's list
  void suit(const scenario::Step& step);  // takes what suits a step of the case
  // The next tool of the rack; after the last comes the round burr, because a pedal has one button.
  void next(int by);
  void roll(double steps);
  void lean(double steps);
  void lean_on();  // one step farther; after the last comes the first
  void toggle_mirror();
  void mirror_at_tip();
  void mirror_next_plane();
  // The tube beside the burr. It takes away water, dust and blood from the picture, and splinters
  // from the bone (piece_carrier.h).
  void toggle_suction();

  // ---- in each picture
  void look();      // what became of a request; the mirror; the nearest structure to spare
  void show_row();  // draws the tool of a new row
  // moves: the axes of the other hand follow the view
  void wet(workshop::LiveSurface& live, bool begun, bool moves);
  void
  draw_pictures();  // of the rack: before the picture of the window, which no other may interrupt
  void draw_panel(Ui& ui);

  // ---- what is so now
  [[nodiscard]] const Nearest& nearest() const { return nearest_; }  // from the cutting parts
  [[nodiscard]] const ToolRack& rack() const { return rack_; }
  [[nodiscard]] const mouse::Grip& grip() const { return grip_; }
  [[nodiscard]] edit::Mirror mirror() const { return mirror_.now(); }
  [[nodiscard]] bool sucks() const { return suction_; }
  // The tube of the other hand, or the one beside the tool: it takes splinters where it takes water.
  [[nodiscard]] std::optional<sim::PieceMover::Suction> splinter_suction() const;

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kSuctionBeside = 3e-3;  // its reach beyond the burr [m]

  [[nodiscard]] bool holds_by_mouse() const;
  [[nodiscard]] Nearest nearest_spared();
  // From the middle of the tool to where the tube beside it draws in [m]
  [[nodiscard]] double suction_reach() const {
    return (grip_.burr() ? scene_.burr.radius : grip_.reach()) + kSuctionBeside;
  }
  void note_mirror();
  void see_cuts(workshop::LiveSurface& live);
  void suck(workshop::LiveSurface& live);

  Desk& desk_;
  sim::Session& session_;
  render::Scene& scene_;
  const mouse::Hands& hands_;
  const WindowOptions& options_;
  const tick::TickRow& row_;
  MillNotes& notes_;
  MillOver& over_;
  MillCase& case_;
  const WornHeadset& headset_;
  Drill drill_;
  ToolRack rack_;
  mouse::Grip grip_;
  MirrorMode mirror_;
  std::vector<math::Vec3> places_;  // on the cutting parts of the tool `placed_` [m]
  int placed_ = -1;
  Nearest nearest_;
  workshop::ToolLooks looks_;  // of tools other than the round burr
  render::HeldTool held_;      // how a tool without an orientation of its own is drawn
  Clock::time_point held_at_{};
  int renewed_ = 0;  // the window, so far: its textures are new
  bool suction_;
  Clock::time_point sucked_{};
  SuctionTube tube_;
};

}  // namespace burr::app
