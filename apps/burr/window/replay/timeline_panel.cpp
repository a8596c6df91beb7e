#include "window/replay/timeline_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/word_names.h"
#include "window/parts/hud.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;

constexpr float kMargin = 10, kHigh = 164, kPad = 16;  // [points]

// the letter of the key that gives this command while milling
std::string letter_of(const tick::Command& command) {
  switch (command.kind) {
    case tick::CommandKind::undo:
      return "U";
    case tick::CommandKind::redo:
      return "Y";
    case tick::CommandKind::reset:
      return "R";
    case tick::CommandKind::burr_radius:
      return "[ ]";
    case tick::CommandKind::burr_kind:
      return "K";
    case tick::CommandKind::spindle_speed:
      return "rpm";
    case tick::CommandKind::tool_mode:
      return fmt::format("{:.0f}", std::clamp(command.value, 0.0, tick::kToolModes - 1.0) + 1);
    case tick::CommandKind::mirror_i:
    case tick::CommandKind::mirror_j:
    case tick::CommandKind::mirror_k:
    case tick::CommandKind::mirror_off:
      return "X";
    case tick::CommandKind::move_piece:
    case tick::CommandKind::lift_piece:
    case tick::CommandKind::leave_piece:
      return "M";
    case tick::CommandKind::take_splinter:
      return "6";
    default:
      return "F2";
  }
}

// draws the values of the moment, from the left
class Cells {
 public:
  Cells(const Ui& ui, float x, float y) : ui_(ui), u_(ui.unit()), x_(x), y_(y) {}
  void cell(float points, const char* heading, const std::string& value,
            const std::string& beside) {
    ui_.write(x_, y_, Letter::small, ink::kDim, heading);
    ui_.write(x_, y_ + 15 * u_, Letter::large, ink::kText, value);
    ui_.write(x_ + ui_.width_of(Letter::large, value) + 6 * u_, y_ + 24 * u_, Letter::small,
              ink::kDim, beside);
    x_ += points * u_;
  }

 private:
  const Ui& ui_;
  float u_, x_, y_;
};

bool button(Action action, ImVec2 p, ImVec2 size, float round, TimelineDone& done) {
  ImGui::SetCursorScreenPos(p);
  ImGui::PushID(static_cast<int>(action));
  const bool pressed = ImGui::InvisibleButton("##b", size);
  ImGui::PopID();
  done.places.push_back({action, p.x, p.y, size.x, size.y});
  ImGui::GetWindowDrawList()->AddRectFilled(
      p, {p.x + size.x, p.y + size.y}, ImGui::IsItemHovered() ? ink::kOver : ink::kButton, round);
  return pressed;
}

constexpr float kCurve = 62, kBar = 10;  // [points]
constexpr double kShownDistance = 5e-3;  // at the top of the curve of distances [m]

// Draws the force as a curve, strokes as bars below it, and commands as marks with the letter of
// their key. The clock may begin before the recording and end after it.
class Line {
 public:
  struct Place {
    float x, y, w;     // [pixel]
    float curve, bar;  // heights  [points]
    double peak;       // force at the top of the curve  [N]
  };
  Line(const Ui& ui, const TimelineMoment& moment, double whole, const Place& place)
      : ui_(ui),
        line_(*moment.line),
        facts_(moment.facts != nullptr && moment.facts->spares ? moment.facts : nullptr),
        from_(moment.from),
        whole_(whole),
        u_(ui.unit()),
        x_(place.x),
        y_(place.y),
        w_(place.w),
        peak_(place.peak),
        curve_(place.curve),
        bar_(place.bar) {}

  // x of a time of the recording, and of a time of the clock
  [[nodiscard]] float at(double t) const { return at_clock(t + from_); }
  [[nodiscard]] float at_clock(double t) const {
    return x_ + w_ * static_cast<float>(whole_ > 0 ? std::clamp(t / whole_, 0.0, 1.0) : 0.0);
  }
  [[nodiscard]] double clock_at(float px) const {
    return whole_ * std::clamp(static_cast<double>((px - x_) / w_), 0.0, 1.0);
  }
  [[nodiscard]] float top() const { return y_; }
  [[nodiscard]] float bottom() const { return y_ + curve_ * u_ + bar_ * u_; }

  void curve() const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float floor = y_ + curve_ * u_;
    draw.AddRectFilled({x_, y_}, {x_ + w_, floor}, ink::rgb(255, 255, 255, 14), 4 * u_);
    const float room = curve_ < kCurve ? 2 : 14;  // for the letters above
    const double full = std::max(0.5, 1.15 * peak_);
    for (float px = 0; px < w_; px += 1) {
      const double from = clock_at(x_ + px) - from_, to = clock_at(x_ + px + 0.999F) - from_;
      if (to < 0 || from > line_.seconds) continue;
      const double force = line_.force_in(std::max(0.0, from), to);
      if (force < 0.002 * full) continue;
      const float h = (curve_ - room) * u_ * static_cast<float>(std::min(1.0, force / full));
      draw.AddRectFilled({x_ + px, floor - h}, {x_ + px + 1, floor}, ink::kAccent);
    }
  }

  // What the curve is, where the mark of the moment does not lie over it. Returns its right end.
  float title(double now) const {
    const std::string text = fmt::format("{} (max {:.1f} N)", word(Word::force), line_.peak_force);
    const float wide = ui_.width_of(Letter::small, text), mark = at_clock(now), half = 9 * u_;
    const float usual = x_ + 6 * u_;
    const float left = mark < usual + wide + half ? std::max(usual, mark + half) : usual;
    ui_.write(left, y_ + 1 * u_, Letter::small, ink::kDim, text);
    return left + wide;
  }

  void strokes() const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float top = y_ + (curve_ + 3) * u_, floor = bottom();
    draw.AddRectFilled({x_, top}, {x_ + w_, floor}, ink::rgb(255, 255, 255, 14), 2 * u_);
    for (const record::Stroke& stroke : line_.strokes)
      draw.AddRectFilled({at(stroke.begin_s), top},
                         {std::max(at(stroke.end_s), at(stroke.begin_s) + 2 * u_), floor},
                         ink::kWarn, 2 * u_);
  }

  // from: letters are written right of it
  void events(float from) const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    float free = x_ - 1;  // a letter is drawn only where the one before leaves room
    for (const record::TimelineEvent& event : line_.events) {
      const float px = std::round(at(event.t_s));
      draw.AddRectFilled({px, y_ + 14 * u_}, {px + std::max(1.0F, u_), y_ + curve_ * u_},
                         ink::rgb(238, 240, 242, 150));
      const std::string letter = letter_of(event.command);
      const float wide = ui_.width_of(Letter::small, letter);
      const float left = std::min(px - wide / 2, x_ + w_ - wide);
      if (left < free || left < from + 6 * u_) continue;
      ui_.write(left, y_ + 1 * u_, Letter::small, ink::kText, letter);
      free = left + wide + 4 * u_;
    }
  }

  void all(double now) const {
    curve();
    strokes();
    events(title(now));
    distance();
  }

  // Draws the distance to what is to be spared as a line, the floor being 0, and marks violations.
  void distance() const {
    if (facts_ == nullptr) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float floor = y_ + curve_ * u_, high = (curve_ - 2) * u_;
    std::optional<float> before;  // none: too far to be shown
    for (float px = 0; px < w_; px += 1) {
      const double from = clock_at(x_ + px) - from_, to = clock_at(x_ + px + 0.999F) - from_;
      if (to < 0 || from > facts_->seconds) continue;
      const Facts::Part near = facts_->nearest_in(std::max(0.0, from), to);
      const auto share = static_cast<double>(near.distance) / kShownDistance;
      if (!(share < 1)) {
        before.reset();
        continue;
      }
      const float top = floor - high * static_cast<float>(std::max(0.0, share));
      const float last = before.value_or(top), thick = std::max(1.0F, 1.5F * u_);
      draw.AddRectFilled({x_ + px, std::min(last, top) - thick / 2},
                         {x_ + px + 1, std::max(last, top) + thick / 2}, ink::kGood);
      before = top;
    }
    for (const Violation& hurt : facts_->violations) {
      const float left = at(hurt.from), right = std::max(at(hurt.until), left + 2 * u_);
      draw.AddRectFilled({left, floor - 6 * u_}, {right, floor}, ink::kBad);
      const float middle = (left + right) / 2;
      draw.AddTriangleFilled({middle - 5 * u_, floor - 6 * u_}, {middle + 5 * u_, floor - 6 * u_},
                             {middle, floor - 14 * u_}, ink::kBad);
    }
    const std::string nearest = say(Word::replay_nearest, 1e3 * kShownDistance);
    const float wide = ui_.width_of(Letter::small, nearest) + 8 * u_;
    draw.AddRectFilled({x_ + w_ - wide, y_}, {x_ + w_, y_ + ui_.height_of(Letter::small) + 2 * u_},
                       ink::kPanel, 3 * u_);
    ui_.write(x_ + w_ - 4 * u_, y_ + 1 * u_, Letter::small, ink::kGood, nearest, 1);
  }

  // labels at round times below, as many as fit
  void scale() const {
    if (!(whole_ > 0)) return;
    double step = 0.5;
    for (const double longer :
         {1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0, 36'000.0})
      if (static_cast<double>(w_) * step / whole_ < static_cast<double>(74 * u_)) step = longer;
    if (whole_ / step > 1000) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (double t = 0; t <= whole_; t += step) {
      const float px = at_clock(t);
      draw.AddRectFilled({px, bottom()}, {px + std::max(1.0F, u_), bottom() + 4 * u_}, ink::kDim);
      const std::string text = step < 1 ? clock_of(t) : minutes(t);
      const float wide = ui_.width_of(Letter::small, text);
      ui_.write(std::clamp(px - wide / 2, x_, x_ + w_ - wide), bottom() + 4 * u_, Letter::small,
                ink::kDim, text);
    }
  }

  // Darkens what a film leaves out, and brackets what it shows. Nothing if it shows all.
  void film(double from, double until, float floor) const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float top = y_ - 2 * u_, left = at_clock(from), right = at_clock(until);
    const auto bracket = [&](float px, float way) {
      const float wide = std::max(2.0F, 2 * u_);
      draw.AddRectFilled({px - wide / 2, top}, {px + wide / 2, floor}, ink::kGood);
      for (const float y : {top, floor - wide})
        draw.AddRectFilled({std::min(px, px + 7 * way * u_), y},
                           {std::max(px, px + 7 * way * u_), y + wide}, ink::kGood);
    };
    constexpr ImU32 kOut = ink::rgb(0, 0, 0, 130);
    if (from > 0) {
      draw.AddRectFilled({x_, top}, {left, floor}, kOut);
      bracket(left, 1);
    }
    if (until < whole_) {
      draw.AddRectFilled({right, top}, {x_ + w_, floor}, kOut);
      bracket(right, -1);
    }
  }

  // the mark of the present moment, from the top down to `floor`
  void head(double t, float floor) const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float px = std::round(at_clock(t)), half = std::max(1.0F, 1.0F * u_);
    draw.AddRectFilled({px - half - u_, y_ - 2 * u_}, {px + half + u_, floor + 2 * u_},
                       ink::rgb(0, 0, 0, 160));
    draw.AddRectFilled({px - half, y_ - 2 * u_}, {px + half, floor + 2 * u_}, ink::kText);
    draw.AddTriangleFilled({px - 6 * u_, y_ - 8 * u_}, {px + 6 * u_, y_ - 8 * u_},
                           {px, y_ + 1 * u_}, ink::kText);
  }

  // describes what is under the mouse
  void show_tooltip(double clock) const {
    const double t = clock - from_;
    if (t < 0 || t > line_.seconds) return;
    std::string text = fmt::format("{}   {:.2f} N", clock_of(t),
                                   line_.force_in(t, t + whole_ / static_cast<double>(w_)));
    const double near = 4 * static_cast<double>(u_) / static_cast<double>(w_) * whole_;
    if (facts_ != nullptr) {
      const Facts::Part part = facts_->nearest_in(t, t + whole_ / static_cast<double>(w_));
      if (part.distance < Facts::kFar)
        text += say(Word::replay_distance, 1e3 * static_cast<double>(part.distance),
                    anatomy(facts_->name_of(part)));
      for (const Violation& hurt : facts_->violations)
        if (t > hurt.from - near && t < hurt.until + near)
          text += say(Word::replay_violation, anatomy(hurt.name), 1e3 * hurt.deepest,
                      clock_of(hurt.from));
    }
    for (const record::Stroke& stroke : line_.strokes)
      if (t > stroke.begin_s - near && t < stroke.end_s + near) {
        text += say(Word::replay_stroke, clock_of(stroke.begin_s), clock_of(stroke.end_s));
        break;
      }
    int more = 0;
    for (const record::TimelineEvent& event : line_.events) {
      if (std::abs(event.t_s - t) > near) continue;
      if (++more > 6) continue;
      text += fmt::format("\n{}  {}", letter_of(event.command), command_text(event));
    }
    if (more > 6) text += fmt::format("\n+ {}", more - 6);
    ImGui::SetTooltip("%s", text.c_str());
  }

 private:
  const Ui& ui_;
  const record::Timeline& line_;
  const Facts* facts_;  // nullptr: no distances
  double from_, whole_;
  float u_, x_, y_, w_;
  double peak_;
  float curve_, bar_;
};

}  // namespace

std::string command_text(const record::TimelineEvent& event) {
  const tick::Command& command = event.command;
  switch (command.kind) {
    case tick::CommandKind::undo:
      return word(Word::undone);
    case tick::CommandKind::redo:
      return word(Word::redone);
    case tick::CommandKind::reset:
      return word(Word::back_to_start);
    case tick::CommandKind::burr_radius:
      return event.refused ? word(Word::no_room)
                           : say(Word::burr_now, std::round(2e5 * command.value) / 100);
    case tick::CommandKind::spindle_speed:
      return say(Word::speed_now, command.value * 60 / (2 * std::numbers::pi));
    case tick::CommandKind::burr_kind:
      return word(command.value > 0 ? Word::now_diamond : Word::now_fluted);
    case tick::CommandKind::tool_mode:
      return word(command.value == 1   ? Word::now_add
                  : command.value == 2 ? Word::now_touch
                  : command.value == 3 ? Word::now_back
                  : command.value == 4 ? Word::now_smooth
                                       : Word::now_cut);
    case tick::CommandKind::mirror_i:
    case tick::CommandKind::mirror_j:
    case tick::CommandKind::mirror_k:
      return word(Word::mirror);
    case tick::CommandKind::mirror_off:
      return word(Word::mirror_off);
    case tick::CommandKind::user_force:
      return say(Word::replay_limit, command.value);
    case tick::CommandKind::move_piece:
      return word(Word::piece_lies);
    case tick::CommandKind::lift_piece:
      return word(Word::piece_take);
    case tick::CommandKind::leave_piece:
      return word(Word::piece_leave);
    case tick::CommandKind::take_splinter:
      return word(Word::replay_splinter);
    default:
      return word(Word::replay_setting);
  }
}

namespace {

// Two buttons: the film begins, ends at this moment.
void draw_film_buttons(const Ui& ui, float x, float y, TimelineDone& done) {
  const float u = ui.unit();
  ui.write(x + 37 * u, y - 15 * u, Letter::small, ink::kDim, word(Word::export_film), 0.5F);
  for (int n = 0; n < 2; ++n) {
    const ImVec2 at = {x + 40 * static_cast<float>(n) * u, y};
    const bool pressed =
        button(n == 0 ? Action::film_from : Action::film_until, at, {34 * u, 26 * u}, 6 * u, done);
    (n == 0 ? done.film_from : done.film_until) = pressed;
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s  ( %s )", word(n == 0 ? Word::film_from : Word::film_until),
                        n == 0 ? "I" : "O");
    ui.write(at.x + 17 * u, at.y + 4 * u, Letter::strong, ink::kText, n == 0 ? "[" : "]", 0.5F);
  }
}

}  // namespace

TimelineDone draw_timeline(Ui& ui, const TimelineState& s) {
  TimelineDone done;
  const float u = ui.unit(), w = ui.width() - 2 * kMargin * u;
  const float x = kMargin * u, y = ui.height() - (kHigh + kMargin) * u;
  ui.panel("##replay", x, y, w, kHigh * u);
  ImDrawList& draw = *ImGui::GetWindowDrawList();

  // button: play or pause
  const ImVec2 p = {x + kPad * u, y + 12 * u};
  done.play = button(Action::play, p, {44 * u, 38 * u}, 6 * u, done);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("%s  ( %s )", word(s.playing ? Word::replay_pause : Word::replay_play),
                      word(Word::key_space));
  const ImVec2 c = {p.x + 22 * u, p.y + 19 * u};
  if (s.playing) {
    for (const float side : {-7.0F, 2.0F})
      draw.AddRectFilled({c.x + side * u, c.y - 9 * u}, {c.x + (side + 5) * u, c.y + 9 * u},
                         ink::kText);
  } else {
    draw.AddTriangleFilled({c.x - 6 * u, c.y - 10 * u}, {c.x - 6 * u, c.y + 10 * u},
                           {c.x + 10 * u, c.y}, ink::kText);
  }

  Cells cells(ui, x + 78 * u, y + 10 * u);
  cells.cell(196, word(Word::time), clock_of(s.t),
             fmt::format("/ {}{}", clock_of(s.seconds), s.behind ? "   …" : ""));
  const bool two = s.second.line != nullptr;
  // Dots, while those of this moment are not known; of two recordings the left one's, then the right
  // one's.
  const auto numbers = [&](const auto& number) {
    const auto one = [&](const TimelineMoment& m) {
      return m.known ? number(m) : std::string("…");
    };
    return two ? fmt::format("{} | {}", one(s.first), one(s.second)) : one(s.first);
  };
  cells.cell(two ? 170 : 112, word(Word::force),
             numbers([](const TimelineMoment& m) { return fmt::format("{:.2f}", m.force); }), "N");
  cells.cell(two ? 230 : 136, word(Word::removed), numbers([](const TimelineMoment& m) {
               return fmt::format("{:.1f}", 1e9 * m.removed);
             }),
             "mm³");
  cells.cell(two ? 150 : 140, word(Word::burr), numbers([](const TimelineMoment& m) {
               return fmt::format("{:g}", std::round(1e5 * m.burr_diameter) / 100);
             }),
             two ? "mm" : fmt::format("mm  {}", word(name_of(s.first.mode))));
  cells.cell(150, word(Word::speed), numbers([](const TimelineMoment& m) {
               return fmt::format("{:.0f}", std::abs(m.speed) * 60 / (2 * std::numbers::pi));
             }),
             "rpm");

  // buttons: slower, the speed, faster
  const float right = x + w - kPad * u;
  const std::string pace = fmt::format("{:g} x", s.pace);
  ui.write(right - 75 * u, y + 10 * u, Letter::small, ink::kDim, word(Word::replay_pace), 0.5F);
  const char* const sign[] = {"-", "+"};
  for (int n = 0; n < 2; ++n) {
    const ImVec2 at = {right - (n == 0 ? 150 : 34) * u, y + 25 * u};
    if (button(n == 0 ? Action::slower : Action::faster, at, {34 * u, 26 * u}, 6 * u, done))
      done.pace = n == 0 ? -1 : 1;
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s  ( %s )", word(n == 0 ? Word::slower : Word::faster),
                        n == 0 ? "," : ".");
    ui.write(at.x + 17 * u, at.y + 4 * u, Letter::strong, ink::kText, sign[n], 0.5F);
  }
  ui.write(right - 75 * u, y + 28 * u, Letter::strong, ink::kText, pace, 0.5F);

  draw_film_buttons(ui, right - 244 * u, y + 25 * u, done);

  // both curves use the same scale
  const double peak = std::max(s.first.line->peak_force, two ? s.second.line->peak_force : 0.0);
  const Line::Place place = {x + kPad * u,         y + 64 * u,        w - 2 * kPad * u,
                             two ? 29.0F : kCurve, two ? 5.0F : kBar, peak};
  const Line line(ui, s.first, s.seconds, place);
  std::optional<Line> second;
  if (two) {
    Line::Place below = place;
    below.y = line.bottom() + 4 * u;
    second.emplace(ui, s.second, s.seconds, below);
  }
  const Line& lowest = second ? *second : line;
  ImGui::SetCursorScreenPos({x + kPad * u, line.top() - 6 * u});
  ImGui::InvisibleButton("##line", {w - 2 * kPad * u, lowest.bottom() - line.top() + 24 * u});
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (ImGui::IsItemActive()) done.scrubbed = line.clock_at(mouse.x);
  const bool over = ImGui::IsItemHovered();
  line.all(s.t);
  if (second) second->all(s.t);
  lowest.scale();
  line.film(s.film_from, s.film_until, line.bottom());
  line.head(s.t, lowest.bottom());
  if (over || done.scrubbed)
    (second && mouse.y > second->top() ? *second : line).show_tooltip(line.clock_at(mouse.x));
  ImGui::End();

  float above = y;
  const LineRoom room{104 * u, ui.width() - kMargin * u - s.column};  // beside the buttons
  done.note_away = line_above(ui, above, s.note, false, room, s.note_stays);
  static_cast<void>(line_above(ui, above, s.warning, true, room));
  return done;
}

}  // namespace burr::app
