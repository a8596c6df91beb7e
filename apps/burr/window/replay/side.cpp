#include "window/replay/side.h"

#include <algorithm>
#include <cmath>

#include "burr/sim/session_words.h"
#include "commands/command.h"
#include "window/mill/mirror_mode.h"
#include "workshop/still.h"

namespace burr::app {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(150);  // before "..." is shown

}  // namespace

Side::Side(Recorded& recorded, bool software)
    : recorded_(recorded),
      colours_(recorded.scene.tissue_colours),
      live_(*recorded.bone, *recorded.worker, recorded.scene, software),
      playback_(recorded) {
  scene().scale_bar = false;
}

Side::~Side() {
  scene().tissue_colours = colours_;
  scene().look.opacity = 1;
  live_.look_plain();
}

void Side::want(double t_s) {
  const double t = std::clamp(t_s, 0.0, line().seconds);
  if (t == wanted_) return;
  playback_.want(wanted_ = t);
}

void Side::look(bool effects, bool playing) {
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

void Side::show_labels(bool shown) {
  scene().tissue_colours = shown ? colours_ : render::as_bone(colours_);
}

double Side::burr_radius() const {
  // as wished: whether the servo had room for it stands nowhere in a recording
  const double first = recorded_.settings.settings.servo.burr.radius;
  const double wished = line().wished(tick::WishKind::burr_radius, shown_.t).value_or(first);
  return wished > 0 && wished <= 0.5 * tool::kLargestDiameter + 1e-12 ? wished : first;
}

bool Side::diamond() const {
  const auto first = static_cast<double>(recorded_.settings.settings.servo.burr.kind);
  return line().wished(tick::WishKind::burr_kind, shown_.t).value_or(first) > 0;
}

tick::ToolMode Side::mode() const {
  const double wished = line()
                            .wished(tick::WishKind::tool_mode, shown_.t)
                            .value_or(static_cast<double>(recorded_.settings.settings.servo.mode));
  return wished >= 0 && wished < tick::kToolModes
             ? static_cast<tick::ToolMode>(static_cast<int>(wished))
             : tick::ToolMode::cut;
}

edit::Mirror Side::mirror() const {
  const math::Ijk& size = recorded_.bone->grid().size;
  edit::Mirror now;
  for (const record::TimelineEvent& event : line().events) {
    if (event.t_s > shown_.t) break;
    now = tick::mirror_of(event.wish, size).value_or(now);
  }
  return now;
}

}  // namespace burr::app
