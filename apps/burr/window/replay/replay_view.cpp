#include "window/replay/replay_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/sim/session_words.h"
#include "burr/tick/mirror_plane.h"
#include "burr/workshop/work_view.h"
#include "window/mill/mirror_mode.h"
#include "window/replay/difference.h"

namespace burr::app {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(150);  // before "..." is shown

}  // namespace

ReplayView::ReplayView(Recorded& recorded, bool software, const render::GovernorSettings& governor)
    : recorded_(recorded),
      colours_(recorded.scene.tissue_colours),
      slices_(*recorded.bone),
      plain_(*recorded.bone),
      live_(*recorded.bone, *recorded.worker, recorded.scene, software, governor),
      playback_(recorded) {
  scene().scale_bar = false;
  difference_colours_ = Difference::add_colours(scene().tissue_colours);
}

ReplayView::~ReplayView() {
  scene().tissue_colours = colours_;
  scene().look.opacity = 1;
  live_.look_plain();
}

void ReplayView::want(double t_s) {
  const double t = std::clamp(t_s, 0.0, line().seconds);
  if (t == wanted_) return;
  playback_.want(wanted_ = t);
  settled_ = 0;
}

// A mouse has no orientation: its tool is drawn as a hand would hold it, as while milling.
void ReplayView::lean_tool(bool left_handed) {
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - std::exchange(leaned_, now)).count();
  const auto& words = recorded_.player->info().words;
  const auto device = words.find("device");
  if (device == words.end() || device->second != "mouse") return;
  render::Burr& burr = scene().burr;
  burr.world_from_tool = held_.at(scene(), shown_.row.contact.proxy, left_handed, seconds);
}

void ReplayView::look(bool effects, bool playing, bool left_handed) {
  if (playback_.take(shown_)) {
    settled_ = 0;
    if (effects) live_.see(shown_.changes);
    if (shown_.trouble.empty()) {
      workshop::put_tool(scene(), shown_.row, true);
      const tool::Burr& burr = recorded_.settings.settings.servo.burr;
      scene().burr.shaft_radius = burr.shaft_radius;
      scene().burr.shaft_length = burr.shaft_length;
      if (playing && shown_.row.spindle_rad_s > 0)
        scene().burr.turn = std::remainder(scene().burr.turn + 0.7, 6.2832);
      force_ = shown_.row.contact.force.norm();
      removed_ = shown_.row.ledger.removed - shown_.row.ledger.undone;
    }
  }
  if (scene().burr.visible && shown_.row.tool.radius > 0) lean_tool(left_handed);
  trouble_ = !shown_.trouble.empty()      ? shown_.trouble
             : !recorded_.notices.empty() ? recorded_.notices.front()
                                          : std::string();
  show_mirror(scene(), recorded_.bone->grid(), tick::mirror_of(tool()));
  // the picture is complete when bone, surface and GPU have it; a short lag while playing does not
  // count
  const bool whole = !playback_.behind() && recorded_.worker->waiting() == 0;
  const auto now = std::chrono::steady_clock::now();
  settled_ = whole && shown_.t == wanted_ ? settled_ + 1 : 0;
  if (whole) in_time_ = now;
  behind_ = !whole && now - in_time_ > kPatience;
  live_.update();
}

void ReplayView::show_labels(bool shown) {
  scene().tissue_colours = shown ? colours_ : render::as_bone(colours_);
  difference_colours_ = Difference::add_colours(scene().tissue_colours);
}

tool::ToolState ReplayView::tool() const {
  // before the first moment is ready, and where ticks are damaged: the tool from the time line
  return shown_.row.tool.radius > 0 ? shown_.row.tool : line().tool_at(shown_.t);
}

}  // namespace burr::app
