#include "window/timeline_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "window/hud.h"
#include "window/words.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;

constexpr float kMargin = 10, kHigh = 164, kPad = 16;  // [points]

// "1:04.2"
std::string clock_of(double t) {
  const double tenths = std::floor(10 * std::max(0.0, t) + 1e-6);
  return fmt::format("{}.{}", minutes(tenths / 10), static_cast<long>(tenths) % 10);
}

// the key that does it while milling
std::string letter_of(const record::Wish& wish) {
  switch (wish.kind) {
    case record::WishKind::undo:
      return "U";
    case record::WishKind::redo:
      return "Y";
    case record::WishKind::reset:
      return "R";
    case record::WishKind::burr_radius:
      return "[ ]";
    case record::WishKind::spindle_speed:
      return "rpm";
    case record::WishKind::tool_mode:
      return fmt::format("{:.0f}", std::clamp(wish.value, 0.0, sim::kToolModes - 1.0) + 1);
    case record::WishKind::mirror_i:
    case record::WishKind::mirror_j:
    case record::WishKind::mirror_k:
    case record::WishKind::mirror_off:
      return "X";
    default:
      return "F2";
  }
}

// numbers of the moment, from the left
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

bool button(const char* id, ImVec2 p, ImVec2 size, float round) {
  ImGui::SetCursorScreenPos(p);
  const bool pressed = ImGui::InvisibleButton(id, size);
  ImGui::GetWindowDrawList()->AddRectFilled(
      p, {p.x + size.x, p.y + size.y}, ImGui::IsItemHovered() ? ink::kOver : ink::kButton, round);
  return pressed;
}

// Force as a curve, strokes as bars below it, wishes as marks with the letter of their key.
class Line {
 public:
  Line(const Ui& ui, const record::Timeline& line, float x, float y, float w)
      : ui_(ui), line_(line), u_(ui.unit()), x_(x), y_(y), w_(w) {}

  [[nodiscard]] float at(double t) const {
    return x_ + w_ * static_cast<float>(line_.seconds > 0 ? std::clamp(t / line_.seconds, 0.0, 1.0)
                                                          : 0.0);
  }
  [[nodiscard]] double time_at(float px) const {
    return line_.seconds * std::clamp(static_cast<double>((px - x_) / w_), 0.0, 1.0);
  }
  [[nodiscard]] float top() const { return y_; }
  [[nodiscard]] float bottom() const { return y_ + kCurve * u_ + kBar * u_; }

  void curve() const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float floor = y_ + kCurve * u_;
    draw.AddRectFilled({x_, y_}, {x_ + w_, floor}, ink::rgb(255, 255, 255, 14), 4 * u_);
    const double full = std::max(0.5, 1.15 * line_.peak_force);
    for (float px = 0; px < w_; px += 1) {
      const double force = line_.force_in(time_at(x_ + px), time_at(x_ + px + 0.999F));
      if (force < 0.002 * full) continue;
      const float h = (kCurve - 14) * u_ * static_cast<float>(std::min(1.0, force / full));
      draw.AddRectFilled({x_ + px, floor - h}, {x_ + px + 1, floor}, ink::kAccent);
    }
    ui_.write(x_ + 6 * u_, y_ + 1 * u_, Letter::small, ink::kDim,
              fmt::format("{} (max {:.1f} N)", word(Word::force), line_.peak_force));
  }

  void strokes() const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float top = y_ + (kCurve + 3) * u_, floor = bottom();
    draw.AddRectFilled({x_, top}, {x_ + w_, floor}, ink::rgb(255, 255, 255, 14), 2 * u_);
    for (const record::Stroke& stroke : line_.strokes)
      draw.AddRectFilled({at(stroke.begin_s), top},
                         {std::max(at(stroke.end_s), at(stroke.begin_s) + 2 * u_), floor},
                         ink::kWarn, 2 * u_);
  }

  void events() const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    float free = x_ - 1;  // a letter only where the one before leaves room
    for (const record::TimelineEvent& event : line_.events) {
      const float px = std::round(at(event.t_s));
      draw.AddRectFilled({px, y_ + 14 * u_}, {px + std::max(1.0F, u_), y_ + kCurve * u_},
                         ink::rgb(238, 240, 242, 150));
      const std::string letter = letter_of(event.wish);
      const float wide = ui_.width_of(Letter::small, letter);
      const float left = std::min(px - wide / 2, x_ + w_ - wide);
      if (left < free || left < x_ + 120 * u_) continue;
      ui_.write(left, y_ + 1 * u_, Letter::small, ink::kText, letter);
      free = left + wide + 4 * u_;
    }
  }

  // round times below, as many as there is room for
  void scale() const {
    if (!(line_.seconds > 0)) return;
    double step = 0.5;
    for (const double longer :
         {1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0, 36'000.0})
      if (static_cast<double>(w_) * step / line_.seconds < static_cast<double>(74 * u_))
        step = longer;
    if (line_.seconds / step > 1000) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (double t = 0; t <= line_.seconds; t += step) {
      const float px = at(t);
      draw.AddRectFilled({px, bottom()}, {px + std::max(1.0F, u_), bottom() + 4 * u_}, ink::kDim);
      const std::string text = step < 1 ? clock_of(t) : minutes(t);
      const float wide = ui_.width_of(Letter::small, text);
      ui_.write(std::clamp(px - wide / 2, x_, x_ + w_ - wide), bottom() + 4 * u_, Letter::small,
                ink::kDim, text);
    }
  }

  void head(double t) const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float px = std::round(at(t)), half = std::max(1.0F, 1.0F * u_);
    draw.AddRectFilled({px - half - u_, y_ - 2 * u_}, {px + half + u_, bottom() + 2 * u_},
                       ink::rgb(0, 0, 0, 160));
    draw.AddRectFilled({px - half, y_ - 2 * u_}, {px + half, bottom() + 2 * u_}, ink::kText);
    draw.AddTriangleFilled({px - 6 * u_, y_ - 8 * u_}, {px + 6 * u_, y_ - 8 * u_},
                           {px, y_ + 1 * u_}, ink::kText);
  }

  // what is under the mouse, in words
  void told(double t) const {
    std::string text = fmt::format("{}   {:.2f} N", clock_of(t),
                                   line_.force_in(t, t + line_.seconds / static_cast<double>(w_)));
    const double near = 4 * static_cast<double>(u_) / static_cast<double>(w_) * line_.seconds;
    for (const record::Stroke& stroke : line_.strokes)
      if (t > stroke.begin_s - near && t < stroke.end_s + near) {
        text += say(Word::replay_stroke, clock_of(stroke.begin_s), clock_of(stroke.end_s));
        break;
      }
    int more = 0;
    for (const record::TimelineEvent& event : line_.events) {
      if (std::abs(event.t_s - t) > near) continue;
      if (++more > 6) continue;
      text += fmt::format("\n{}  {}", letter_of(event.wish), told_wish(event.wish));
    }
    if (more > 6) text += fmt::format("\n+ {}", more - 6);
    ImGui::SetTooltip("%s", text.c_str());
  }

 private:
  static constexpr float kCurve = 62, kBar = 10;  // [points]
  const Ui& ui_;
  const record::Timeline& line_;
  float u_, x_, y_, w_;
};

}  // namespace

std::string told_wish(const record::Wish& wish) {
  switch (wish.kind) {
    case record::WishKind::undo:
      return word(Word::undone);
    case record::WishKind::redo:
      return word(Word::redone);
    case record::WishKind::reset:
      return word(Word::back_to_start);
    case record::WishKind::burr_radius:
      return say(Word::burr_now, std::round(2e5 * wish.value) / 100);
    case record::WishKind::spindle_speed:
      return say(Word::speed_now, wish.value * 60 / (2 * std::numbers::pi));
    case record::WishKind::tool_mode:
      return word(wish.value == 1   ? Word::now_add
                  : wish.value == 2 ? Word::now_touch
                  : wish.value == 3 ? Word::now_back
                  : wish.value == 4 ? Word::now_smooth
                                    : Word::now_cut);
    case record::WishKind::mirror_i:
    case record::WishKind::mirror_j:
    case record::WishKind::mirror_k:
      return word(Word::mirror);
    case record::WishKind::mirror_off:
      return word(Word::mirror_off);
    case record::WishKind::user_force:
      return say(Word::replay_limit, wish.value);
    default:
      return word(Word::replay_setting);
  }
}

TimelineDone draw_timeline(Ui& ui, const TimelineState& s) {
  TimelineDone done;
  const float u = ui.unit(), w = ui.width() - 2 * kMargin * u;
  const float x = kMargin * u, y = ui.height() - (kHigh + kMargin) * u;
  ui.panel("##replay", x, y, w, kHigh * u);
  ImDrawList& draw = *ImGui::GetWindowDrawList();

  // play, or pause
  const ImVec2 p = {x + kPad * u, y + 12 * u};
  done.play = button("##play", p, {44 * u, 38 * u}, 6 * u);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("%s  [%s]", word(s.playing ? Word::replay_pause : Word::replay_play),
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
             fmt::format("/ {}{}", clock_of(s.line->seconds), s.behind ? "   …" : ""));
  cells.cell(112, word(Word::force), fmt::format("{:.2f}", s.force), "N");
  cells.cell(136, word(Word::removed), fmt::format("{:.1f}", 1e9 * s.removed), "mm³");
  cells.cell(140, word(Word::burr), fmt::format("{:g}", std::round(1e5 * s.burr_diameter) / 100),
             fmt::format("mm  {}", word(name_of(s.mode))));
  cells.cell(150, word(Word::speed),
             fmt::format("{:.0f}", std::abs(s.speed) * 60 / (2 * std::numbers::pi)), "rpm");

  // slower, pace, faster
  const float right = x + w - kPad * u;
  const std::string pace = fmt::format("{:g} x", s.pace);
  ui.write(right - 75 * u, y + 10 * u, Letter::small, ink::kDim, word(Word::replay_pace), 0.5F);
  const char* const sign[] = {"-", "+"};
  for (int n = 0; n < 2; ++n) {
    const ImVec2 at = {right - (n == 0 ? 150 : 34) * u, y + 25 * u};
    if (button(n == 0 ? "##slower" : "##faster", at, {34 * u, 26 * u}, 6 * u))
      done.pace = n == 0 ? -1 : 1;
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s  [%s]", word(n == 0 ? Word::slower : Word::faster), n == 0 ? "," : ".");
    ui.write(at.x + 17 * u, at.y + 4 * u, Letter::strong, ink::kText, sign[n], 0.5F);
  }
  ui.write(right - 75 * u, y + 28 * u, Letter::strong, ink::kText, pace, 0.5F);

  const Line line(ui, *s.line, x + kPad * u, y + 64 * u, w - 2 * kPad * u);
  ImGui::SetCursorScreenPos({x + kPad * u, line.top() - 6 * u});
  ImGui::InvisibleButton("##line", {w - 2 * kPad * u, line.bottom() - line.top() + 24 * u});
  const float mouse = ImGui::GetIO().MousePos.x;
  if (ImGui::IsItemActive()) done.scrubbed = line.time_at(mouse);
  const bool over = ImGui::IsItemHovered();
  line.curve();
  line.strokes();
  line.events();
  line.scale();
  line.head(s.t);
  if (over || done.scrubbed) line.told(line.time_at(mouse));
  ImGui::End();

  float above = y;
  line_above(ui, above, s.note, false);
  line_above(ui, above, s.warning, true);
  return done;
}

}  // namespace burr::app
