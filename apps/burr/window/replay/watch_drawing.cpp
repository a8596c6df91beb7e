#include "window/replay/watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "shared/word_names.h"
#include "window/parts/export_page.h"
#include "window/parts/hud.h"
#include "window/parts/measuring.h"
#include "window/parts/mirror_mode.h"
#include "window/replay/comparison.h"
#include "window/replay/replay_bar.h"
#include "window/replay/replay_view.h"
#include "window/replay/split_view.h"
#include "window/replay/timeline_panel.h"
#include "window/ui/file_dialog.h"
#include "window/ui/help.h"

namespace burr::app {

namespace {

TimelineMoment moment_of(const ReplayView& side, double from) {
  return {.line = &side.line(),
          .from = from,
          .known = side.known(),
          .force = side.force(),
          .removed = side.removed(),
          .speed = side.speed(),
          .burr_diameter = 2 * side.tool_of_values().radius,
          .mode = side.tool_of_values().mode};
}

}  // namespace

// Writes the title of each half.
void Watch::titles() const {
  const Ui& ui = desk_.ui();
  const float u = ui.unit(), middle = std::floor(ui.width() / 2);
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  draw.AddRectFilled({middle - std::max(1.0F, u), 0}, {middle + std::max(1.0F, u), ui.height()},
                     ink::rgb(0, 0, 0));
  const auto title = [&](const ReplayView& side, float x) {
    const std::string& text = side.recorded().title;
    const float w = std::min(ui.width_of(Ui::Letter::strong, text) + 24 * u, middle - 24 * u);
    const float h = ui.height_of(Ui::Letter::strong) + 12 * u;
    const std::string name = fmt::format("##title{}", x > 0 ? 2 : 1);
    desk_.ui().panel(name.c_str(), x + 12 * u, 12 * u, w, h);
    ui.write(x + 24 * u, 18 * u, Ui::Letter::strong, ink::kText, text);
    ImGui::End();
  };
  title(*first_, 0);
  title(*second_, middle);
}

// Draws a ring round the place that is looked at.
void Watch::ring() const {
  if (!options_.place || second_) return;
  constexpr double kRadius = 1.5e-3;  // [m]
  const Ui& ui = desk_.ui();
  const render::Camera& camera = scene_.camera;
  const auto middle = on_picture(camera, *options_.place, ui.width(), ui.height());
  const auto edge =
      on_picture(camera, *options_.place + kRadius * camera.right(), ui.width(), ui.height());
  if (!middle || !edge) return;  // behind the eye
  const float u = ui.unit();
  const float r = std::max(std::hypot(edge->x - middle->x, edge->y - middle->y), 8 * u);
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  draw.AddCircle({middle->x + u, middle->y + u}, r, ink::rgb(0, 0, 0, 150), 48, 2 * u);
  draw.AddCircle(*middle, r, ink::kWarn, 48, 2 * u);
}

// Between the two bones, where it covers neither place of work. Slices lie there too: then it begins
// right of those of the left bone.
void Watch::draw_table(const Facts* left) {
  if (!comparison_ || compare_ == Compare::none) return;
  Ui& ui = desk_.ui();
  const float u = ui.unit(), middle = std::floor(ui.width() / 2), w = Comparison::kWide * u;
  now_.table = {Action::compare, now_.slices == 0 ? middle - w / 2 : middle + 8 * u, 56 * u, w,
                ui.height() / 2};
  if (comparison_->draw(ui, now_.table.x, now_.table.y, left, compare_ == Compare::colours))
    compare_ = compare_ == Compare::colours ? Compare::table : Compare::colours;
}

void Watch::panels() {
  Ui& ui = desk_.ui();
  if (dialog_.open()) return dialog_.draw(ui);
  ring();
  if (!panels_ && !page_open()) {  // only what the user must know to see them again
    float bottom = ui.height() - 10 * ui.unit();
    static_cast<void>(line_above(ui, bottom, note_, false, {0, ui.width()}));
    return;
  }
  if (panels_) {
    TimelineState s;
    s.first = moment_of(*first_, 0);
    s.first.facts = facts_ ? facts_->facts() : nullptr;
    if (second_) s.second = moment_of(*second_, now_.shift);
    if (comparison_) s.second.facts = comparison_->right();
    s.seconds = seconds();
    s.t = now_.t;
    s.playing = now_.playing;
    s.behind = now_.behind;
    s.pace = now_.pace;
    s.film_from = now_.film_from;
    s.film_until = now_.film_until;
    if (const edit::Mirror now = tick::mirror_of(first_->tool()); now.on() && !second_)
      draw_mirror_sign(ui, mirror_words(recorded_.bone->grid(), now), 0);
    s.note = note_.empty() ? export_->progress() : note_;
    s.note_stays = note_stays_ && !note_.empty();
    if (s.note.empty()) s.note = options_.note;
    now_.line = s.note;
    s.warning = !trouble_.empty()                      ? trouble_
                : first_->trouble().empty() && second_ ? second_->trouble()
                                                       : first_->trouble();
    if (second_) titles();
    draw_table(s.first.facts);
    if (!scene_.insets.empty() && !second_)
      s.column = ui.width() - static_cast<float>(scene_.insets.front().x);
    if (now_.slices != 0) {
      first_->slices().write_names(scene_, ui);
      if (second_) second_->slices().write_names(second_->scene(), ui, std::floor(ui.width() / 2));
    }
    const TimelineDone done = draw_timeline(ui, s);
    now_.buttons = done.places;
    constexpr float kStrip = 184;  // [points]
    const auto pressed = draw_replay_bar(ui,
                                         {.beside = second_.has_value(),
                                          .compares = comparison_ && compare_ != Compare::none,
                                          .slices = now_.slices != 0,
                                          .see_through = scene_.look.opacity < 1,
                                          .labels = labels_},
                                         ui.height() - kStrip * ui.unit(), now_.buttons);
    scrubbing_ = done.scrubbed.has_value();
    if (done.scrubbed) go(*done.scrubbed);
    if (done.play) play(!now_.playing);
    if (done.pace != 0) change_pace(done.pace);
    if (done.film_from) film_here(true);
    if (done.film_until) film_here(false);
    if (done.note_away) note({});
    pressed_ = pressed;
  }
  if (help_) help_ = draw_replay_help(ui);
  if (export_->shown()) export_->draw();
}

}  // namespace burr::app
