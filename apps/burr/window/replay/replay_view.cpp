#include "window/replay/replay_view.h"

#include <algorithm>
#include <cmath>

#include "burr/sim/session_words.h"
#include "commands/command.h"
#include "window/mill/mirror_mode.h"
#include "workshop/work_view.h"

namespace burr::app {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(150);  // before "..." is shown

}  // namespace

ReplayView::ReplayView(Recorded& recorded, bool software)
    : recorded_(recorded),
      colours_(recorded.scene.tissue_colours),
      live_(*recorded.bone, *recorded.worker, recorded.scene, software),
      playback_(recorded) {
  scene().scale_bar = false;
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
}

void ReplayView::look(bool effects, bool playing) {
  if (playback_.take(shown_)) {
    if (effects) live_.see(shown_.told);
    if (shown_.trouble.empty()) {
      put_tool(scene(), shown_.row, burr_radius(), true);
      scene().burr.diamond = diamond();
      const tool::Burr& burr = recorded_.settings.settings.servo.burr;
      scene().burr.shaft_radius = burr.shaft_radius;
      scene().burr.shaft_length = burr.shaft_length;
      if (playing && shown_.row.spindle_rad_s > 0)
        scene().burr.turn = std::remainder(scene().burr.turn + 0.7, 6.2832);
      force_ = shown_.row.contact.force.norm();
      removed_ = shown_.row.ledger.removed;
    }
  }
  trouble_ = !shown_.trouble.empty()      ? shown_.trouble
             : !recorded_.notices.empty() ? recorded_.notices.front()
                                          : std::string();
  show_mirror(scene(), recorded_.bone->grid(), mirror());
  // the picture is whole when bone, surface and GPU have it; while it plays a little lag is none
  const bool whole = !playback_.behind() && recorded_.worker->waiting() == 0;
  const auto now = std::chrono::steady_clock::now();
  if (whole) in_time_ = now;
  behind_ = !whole && now - in_time_ > kPatience;
  live_.update();
}

void ReplayView::show_labels(bool shown) {
  scene().tissue_colours = shown ? colours_ : render::as_bone(colours_);
}

double ReplayView::burr_radius() const {
  // as requested: whether the servo had room for it stands nowhere in a recording
  const double first = recorded_.settings.settings.servo.burr.radius;
  const double requested =
      line().requested(tick::CommandKind::burr_radius, shown_.t).value_or(first);
  return requested > 0 && requested <= 0.5 * tool::kLargestDiameter + 1e-12 ? requested : first;
}

bool ReplayView::diamond() const {
  const auto first = static_cast<double>(recorded_.settings.settings.servo.burr.kind);
  return line().requested(tick::CommandKind::burr_kind, shown_.t).value_or(first) > 0;
}

tick::ToolMode ReplayView::mode() const {
  const double requested =
      line()
          .requested(tick::CommandKind::tool_mode, shown_.t)
          .value_or(static_cast<double>(recorded_.settings.settings.servo.mode));
  return requested >= 0 && requested < tick::kToolModes
             ? static_cast<tick::ToolMode>(static_cast<int>(requested))
             : tick::ToolMode::cut;
}

edit::Mirror ReplayView::mirror() const {
  const math::Ijk& size = recorded_.bone->grid().size;
  edit::Mirror now;
  for (const record::TimelineEvent& event : line().events) {
    if (event.t_s > shown_.t) break;
    now = tick::mirror_of(event.command, size).value_or(now);
  }
  return now;
}

}  // namespace burr::app
