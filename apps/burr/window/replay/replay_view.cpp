#include "window/replay/replay_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/sim/session_words.h"
#include "burr/tick/mirror_plane.h"
#include "burr/workshop/second_tool.h"
#include "burr/workshop/work_view.h"
#include "shared/front_words.h"
#include "window/parts/mirror_mode.h"
#include "window/replay/difference.h"

namespace burr::app {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(150);  // before "..." is shown
// While playing, values may be so much older than the moment: at eight times the speed two pictures.
constexpr double kLag = 0.3;   // [s]
constexpr double kJump = 0.5;  // a longer way forward is a jump; every way back is one [s]

// Whether what is known of moment t may stand for the requested one.
bool in_time(double t, double wanted, bool playing) {
  return playing ? t <= wanted && t >= wanted - kLag : t == wanted;
}

}  // namespace

ReplayView::ReplayView(Recorded& recorded, bool software, const render::GovernorSettings& governor)
    : recorded_(recorded),
      colours_(recorded.scene.tissue_colours),
      slices_(*recorded.bone),
      plain_(*recorded.bone),
      live_(*recorded.bone, *recorded.worker, recorded.scene, software, governor),
      looks_(recorded.player->info().tools),
      playback_(recorded) {
  scene().scale_bar = false;
  difference_colours_ = Difference::add_colours(scene().tissue_colours);
}

ReplayView::~ReplayView() {
  piece_.take_away(scene());
  scene().tissue_colours = colours_;
  scene().look.opacity = 1;
  live_.look_plain();
}

void ReplayView::want(double t_s) {
  const double t = std::clamp(t_s, 0.0, line().seconds);
  if (t == wanted_) return;
  if (t < wanted_ || t > wanted_ + kJump) jump_ = t;
  playback_.want(wanted_ = t);
  settled_ = 0;
}

// A mouse has no orientation: its burr is drawn as a hand would hold it, as while milling. Of any other tool the direction
// matters to what it cuts.
void ReplayView::lean_tool(bool left_handed) {
  if (shown_.row.tool.number >= 0) return;
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
      looks_.put(scene(), shown_.row.tool.number);
      second_.put(scene(), shown_.second ? &*shown_.second : nullptr,
                  record::tool_of(recorded_.player->info().second));
      const tool::Burr& burr = recorded_.settings.settings.servo.burr;
      scene().burr.shaft_radius = burr.shaft_radius;
      scene().burr.shaft_length = burr.shaft_length;
      if (playing && shown_.row.spindle_rad_s > 0)
        scene().burr.turn = std::remainder(scene().burr.turn + 0.7, 6.2832);
    }
  }
  Playback::Early early;
  if (playback_.take_early(early)) values_ = early;
  known_ = in_time(values_.t, wanted_, playing);
  // in every picture: the colours of the scene may be others than in the last one
  piece_.put(scene(), shown_.piece.mesh, shown_.piece.by, recorded_.bone->tissues().tissues.size());
  if (scene().burr.visible && shown_.row.tool.radius > 0) lean_tool(left_handed);
  trouble_ = !shown_.trouble.empty()      ? shown_.trouble
             : !recorded_.notices.empty() ? in_options(recorded_.notices.front())
                                          : std::string();
  show_mirror(scene(), recorded_.bone->grid(), tick::mirror_of(tool()));
  // the picture is complete when bone, surface and GPU have it; a short lag while playing does not
  // count
  const bool whole = !playback_.behind() && recorded_.worker->waiting() == 0;
  const auto now = std::chrono::steady_clock::now();
  settled_ = whole && shown_.t == wanted_ ? settled_ + 1 : 0;
  if (whole) in_time_ = now;
  // after a jump the user sees at once that the picture is another moment's
  if (settled_ >= kSettled || (playing && shown_.t >= jump_ && in_time(shown_.t, wanted_, true)))
    jump_ = -1;
  behind_ = jump_ >= 0 || (!whole && now - in_time_ > kPatience);
  live_.update();
}

void ReplayView::show_labels(bool shown) {
  scene().tissue_colours = shown ? colours_ : render::as_bone(colours_);
  difference_colours_ = Difference::add_colours(scene().tissue_colours);
}

tool::ToolState ReplayView::tool_of_values() const {
  return known_ && values_.row.tool.radius > 0 ? values_.row.tool : line().tool_at(wanted_);
}

tool::ToolState ReplayView::tool() const {
  // before the first moment is ready, and where ticks are damaged: the tool from the time line
  return shown_.row.tool.radius > 0 ? shown_.row.tool : line().tool_at(shown_.t);
}

}  // namespace burr::app
