#include "window/parts/hud.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "burr/render/governor.h"
#include "shared/word_names.h"

namespace burr::app {
namespace {

// What the picture leaves out at this step of the governor.
Word picture_word(int step) {
  constexpr Word kWords[] = {Word::picture_whole, Word::picture_no_hollows, Word::picture_coarser,
                             Word::picture_fewer, Word::picture_fewest};
  static_assert(std::size(kWords) == render::FrameGovernor::kSteps);
  return kWords[std::clamp(step, 0, render::FrameGovernor::kSteps - 1)];
}

using Letter = Ui::Letter;

constexpr float kStrip = 58, kMargin = 10, kPad = 14;  // [points]
constexpr float kLeft = 104, kViewsBar = 160;  // left edge and width of views_bar.cpp [points]

// Draws the strip cell by cell, from the left.
class Strip {
 public:
  Strip(const Ui& ui, float x, float y) : ui_(ui), u_(ui.unit()), x_(x), y_(y) {}

  // a small heading above, a large value below, a few words beside the value
  void cell(float points, Word heading, const std::string& value, const std::string& beside = {},
            ImU32 beside_ink = ink::kDim) {
    title(word(heading));
    const float at = x_ + kPad * u_;
    ui_.write(at, y_ + 24 * u_, Letter::large, ink::kText, value);
    if (!beside.empty())
      ui_.write(at + ui_.width_of(Letter::large, value) + 6 * u_, y_ + 33 * u_, Letter::small,
                beside_ink, beside);
    next(points);
  }

  void title(const std::string& text) const {
    ui_.write(x_ + kPad * u_, y_ + 8 * u_, Letter::small, ink::kDim, text);
  }

  void next(float points) {
    x_ += points * u_;
    ImGui::GetWindowDrawList()->AddLine({x_, y_ + 12 * u_}, {x_, y_ + (kStrip - 12) * u_},
                                        ink::kLine, std::max(1.0F, u_));
  }

  [[nodiscard]] float x() const { return x_ + kPad * u_; }
  [[nodiscard]] float y() const { return y_; }
  [[nodiscard]] float unit() const { return u_; }

 private:
  const Ui& ui_;
  float u_, x_, y_;
};

// A bar; marks show the limits: the user's is a line with a roof, the device's is a line with a
// foot.
void force_cell(const Ui& ui, Strip& strip, const HudState& s) {
  const float u = ui.unit(), x = strip.x(), y = strip.y(), w = 200 * u;
  strip.title(word(Word::force));
  const double full = 1.12 * std::max({s.user_limit, s.device_limit, 0.1});
  const auto at = [&](double newton) {
    return x + w * static_cast<float>(std::clamp(newton / full, 0.0, 1.0));
  };
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float top = y + 29 * u, bottom = y + 41 * u;
  const double limit = std::min(s.user_limit, s.device_limit);
  const bool near = s.force > 0.8 * limit, over = s.force > 0.97 * limit;
  draw.AddRectFilled({x, top}, {x + w, bottom}, ink::kTrough, 3 * u);
  if (s.force > 0.005)
    draw.AddRectFilled({x, top}, {std::max(at(s.force), x + 2 * u), bottom},
                       over   ? ink::kBad
                       : near ? ink::kWarn
                              : ink::kAccent,
                       3 * u);
  const auto mark = [&](double newton, bool above, const char* name) {
    const float mx = std::round(at(newton));
    draw.AddRectFilled({mx - 1 * u, top - 4 * u}, {mx + 1 * u, bottom + 4 * u}, ink::kText);
    const float ty = above ? top - 6 * u : bottom + 6 * u, by = above ? -5 * u : 5 * u;
    draw.AddTriangleFilled({mx - 4 * u, ty + by}, {mx + 4 * u, ty + by}, {mx, ty}, ink::kText);
    ui.write(mx - 7 * u, above ? top - 19 * u : bottom + 1 * u, Letter::small, ink::kDim, name, 1);
  };
  mark(s.user_limit, true, word(Word::limit_user));
  mark(s.device_limit, false, word(Word::limit_device));
  const std::string value = fmt::format("{:.2f}", s.force);
  ui.write(x + w + 16 * u, y + 24 * u, Letter::large, over ? ink::kBad : ink::kText, value);
  ui.write(x + w + 22 * u + ui.width_of(Letter::large, value), y + 33 * u, Letter::small, ink::kDim,
           over ? "N !" : "N");
  strip.next(298);
}

// the depth of the press as a small gauge: the surface is at the top, a deeper press fills more
void press_cell(const Ui& ui, Strip& strip, const HudState& s) {
  const float u = ui.unit(), x = strip.x(), y = strip.y();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float share = static_cast<float>(std::clamp(s.press / s.press_most, 0.0, 1.0));
  const float gx = x + 104 * u, top = y + 13 * u, high = 32 * u;
  draw.AddRectFilled({gx, top}, {gx + 8 * u, top + high}, ink::kTrough, 2 * u);
  draw.AddRectFilled({gx, top}, {gx + 8 * u, top + share * high},
                     s.pressing ? ink::kAccent : ink::kDim, 2 * u);
  draw.AddLine({gx - 4 * u, top}, {gx + 12 * u, top}, ink::kText, 1.5F * u);
  ui.write(
      x, y + 8 * u, Letter::small, ink::kDim,
      fmt::format("{} - {}", word(Word::press), word(s.pressing ? Word::pressing : Word::lifted)));
  const std::string value = fmt::format("{:.1f}", 1e3 * s.press);
  ui.write(x, y + 24 * u, Letter::large, ink::kText, value);
  ui.write(x + ui.width_of(Letter::large, value) + 6 * u, y + 33 * u, Letter::small, ink::kDim,
           "mm");
  strip.next(138);
}

void tick_cell(const Ui& ui, Strip& strip, const HudState& s) {
  const float u = ui.unit(), x = strip.x() + 8 * u, y = strip.y() + 37 * u, r = 6 * u;
  strip.title(word(Word::ticks));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  // each state has a shape of its own, not only a colour
  Word says = Word::ticks_good;
  switch (s.ticks) {
    case TickHealth::good:
      draw.AddCircleFilled({x, y}, r, ink::kGood, 24);
      break;
    case TickHealth::busy:
      says = Word::ticks_busy;
      draw.AddTriangleFilled({x - 1.2F * r, y + r}, {x + 1.2F * r, y + r}, {x, y - 1.1F * r},
                             ink::kWarn);
      break;
    case TickHealth::lost:
      says = Word::ticks_lost;
      draw.AddRectFilled({x - r, y - r}, {x + r, y + r}, ink::kBad);
      break;
  }
  ui.write(x + 14 * u, strip.y() + 29 * u, Letter::body, ink::kText, word(says));
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (mouse.x > strip.x() - kPad * u && mouse.x < strip.x() + 96 * u && mouse.y > strip.y() &&
      mouse.y < strip.y() + kStrip * u)
    ImGui::SetTooltip("%s\n%s", say(Word::ticks_tail, s.p99_us, s.max_us, s.missed).c_str(),
                      word(picture_word(s.picture_step)));
}

// A round length, about a sixth of the picture's width [m].
double scale_length(const Ui& ui, const HudState& s) {
  const double wanted = s.pixel * static_cast<double>(ui.width()) / 6;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  return 5 * power <= wanted ? 5 * power : 2 * power <= wanted ? 2 * power : power;
}

// Between the bar of views and the scale bar, so that a line of text covers neither.
LineRoom line_room(const Ui& ui, const HudState& s) {
  const float u = ui.unit();
  constexpr float kBeside = 16, kLeast = 320;  // [points]
  LineRoom room{(kLeft + kViewsBar + kBeside) * u, ui.width() - kMargin * u - s.column};
  if (s.pixel > 0)
    room.right -= static_cast<float>(scale_length(ui, s) / s.pixel) + (6 + kBeside) * u;
  if (room.right - room.left < kLeast * u) room.right = room.left + kLeast * u;
  return room;
}

// a scale bar above the strip at the right
void scale_bar(const Ui& ui, const HudState& s) {
  const float u = ui.unit();
  if (!(s.pixel > 0)) return;
  const double length = scale_length(ui, s);
  const auto w = static_cast<float>(length / s.pixel);
  const float x1 = ui.width() - (kMargin + 6) * u - s.column, x0 = x1 - w;
  const float y = ui.height() - hud_height(ui) - 10 * u;
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  for (const auto& [by, c] : {std::pair{u, ink::rgb(0, 0, 0, 150)}, std::pair{0.0F, ink::kText}}) {
    draw.AddRectFilled({x0 + by, y + by}, {x1 + by, y + by + 2 * u}, c);
    draw.AddRectFilled({x0 + by, y + by - 5 * u}, {x0 + by + 1.5F * u, y + by}, c);
    draw.AddRectFilled({x1 + by - 1.5F * u, y + by - 5 * u}, {x1 + by, y + by}, c);
    const std::string text = length < 0.9995e-3 ? fmt::format("{:.1f} mm", 1e3 * length)
                                                : fmt::format("{:.0f} mm", 1e3 * length);
    const ImFont* font = ui.font(Letter::small);
    draw.AddText(font, font->FontSize,
                 {std::round((x0 + x1 - ui.width_of(Letter::small, text)) / 2 + by),
                  std::round(y - 19 * u + by)},
                 c, text.c_str());
  }
}

bool fits(const Ui& ui, const std::string& text, float wide) {
  return ui.width_of(Letter::small, text) < wide;
}

// The text, or as much of its beginning as fits, by whole letters, with dots.
std::string shortened(const Ui& ui, std::string text, float wide) {
  if (fits(ui, text, wide)) return text;
  const auto inside_letter = [&text] {
    return (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U;
  };
  while (!text.empty() && !fits(ui, text + "...", wide)) {
    while (text.size() > 1 && inside_letter()) text.pop_back();
    text.pop_back();
  }
  return text + "...";
}

// The text in full while the mouse is over the cell that begins here.
void tip_over(const Strip& strip, float wide, const std::string& text) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (mouse.x > strip.x() && mouse.x < strip.x() + wide && mouse.y > strip.y() &&
      mouse.y < strip.y() + kStrip * strip.unit())
    ImGui::SetTooltip("%s", text.c_str());
}

// "40 000"
std::string thousands(double value) {
  const auto whole = static_cast<long>(std::round(value));
  return whole < 1000 ? fmt::format("{}", whole)
                      : fmt::format("{} {:03}", whole / 1000, whole % 1000);
}

void speed_cell(Strip& strip, const HudState& s) {
  const std::string value = thousands(std::abs(s.speed) * 60 / (2 * std::numbers::pi));
  if (!s.motor) return strip.cell(176, Word::speed, "-", word(Word::by_hand));
  // a longer word leaves no room for the load
  if (!s.turns) return strip.cell(176, Word::speed, value, word(Word::per_minute));
  strip.cell(176, Word::speed, value, fmt::format("rpm  {}", say(Word::load, 100 * s.load)));
}

void tool_cell(const Ui& ui, Strip& strip, const HudState& s) {
  const std::string value = fmt::format("{:g}", std::round(1e5 * s.burr_diameter) / 100);
  if (s.tool.empty())
    return strip.cell(
        132, Word::burr, value,
        fmt::format("mm  {}", word(s.diamond && s.mode == tick::ToolMode::cut ? Word::diamond
                                                                              : name_of(s.mode))));
  constexpr float kRoom = 114;  // [points]
  strip.title(shortened(ui, s.tool, kRoom * strip.unit()));
  if (!fits(ui, s.tool, kRoom * strip.unit())) tip_over(strip, 132 * strip.unit(), s.tool);
  ui.write(strip.x(), strip.y() + 24 * strip.unit(), Letter::large, ink::kText, value);
  ui.write(strip.x() + ui.width_of(Letter::large, value) + 6 * strip.unit(),
           strip.y() + 33 * strip.unit(), Letter::small, ink::kDim,
           fmt::format("mm  {}", word(name_of(s.mode))));
  strip.next(132);
}

}  // namespace

bool line_above(Ui& ui, float& y, const std::string& text, bool warns, LineRoom room, bool stays) {
  if (text.empty()) return false;
  const float u = ui.unit(), mark = warns ? 26 * u : 0, close = stays ? 26 * u : 0;
  const float wide = std::max(200 * u, room.right - room.left), around = mark + close + 28 * u;
  const ImFont* font = ui.font(Letter::body);
  const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9F, wide - around, text.data(),
                                          text.data() + text.size());
  const float w = size.x + around, h = size.y + 17 * u;
  const float x = std::clamp((room.left + room.right - w) / 2, 10 * u,
                             std::max(10 * u, ui.width() - w - 10 * u));
  y -= h + 6 * u;
  bool clicked = false;
  if (stays) {
    ui.panel("##stays", x, y, w, h);
    ImGui::SetCursorScreenPos({x, y});
    clicked = ImGui::InvisibleButton("##away", {w, h});
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", word(Word::line_close));
  }
  ImDrawList& draw = stays ? *ImGui::GetWindowDrawList() : *ImGui::GetBackgroundDrawList();
  if (!stays) draw.AddRectFilled({x, y}, {x + w, y + h}, ink::kPanel, 8 * u);
  if (warns) {
    const float cx = x + 22 * u, cy = y + h / 2, r = 8 * u;
    draw.AddTriangleFilled({cx - r, cy + 0.8F * r}, {cx + r, cy + 0.8F * r}, {cx, cy - 0.9F * r},
                           ink::kWarn);
    draw.AddRectFilled({cx - 0.9F * u, cy - 3 * u}, {cx + 0.9F * u, cy + 2 * u}, ink::rgb(0, 0, 0));
    draw.AddRectFilled({cx - 0.9F * u, cy + 3.2F * u}, {cx + 0.9F * u, cy + 5 * u},
                       ink::rgb(0, 0, 0));
  }
  draw.AddText(font, font->FontSize,
               {std::round(x + 14 * u + mark), std::round(y + (h - size.y) / 2)}, ink::kText,
               text.data(), text.data() + text.size(), wide - around);
  if (stays) {
    const ImVec2 c = {x + w - 18 * u, y + h / 2};
    const float r = 4 * u;
    draw.AddLine({c.x - r, c.y - r}, {c.x + r, c.y + r}, ink::kDim, 1.6F * u);
    draw.AddLine({c.x - r, c.y + r}, {c.x + r, c.y - r}, ink::kDim, 1.6F * u);
    ImGui::End();
  }
  return clicked;
}

void draw_mirror_sign(const Ui& ui, const std::string& words, float column) {
  if (words.empty()) return;
  const float u = ui.unit(), h = 32 * u, text = ui.width_of(Letter::body, words);
  const float w = text + 56 * u, x = (ui.width() - column - w) / 2, y = kMargin * u;
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  draw.AddRectFilled({x, y}, {x + w, y + h}, ink::kPanel, 8 * u);
  draw.AddRect({x, y}, {x + w, y + h}, ink::kAccent, 8 * u, 0, 1.5F * u);
  const float cx = x + 24 * u, cy = y + h / 2, r = 8 * u;
  for (const float side : {-1.0F, 1.0F})
    draw.AddTriangle({cx + 0.3F * side * r, cy - 0.7F * r}, {cx + 0.3F * side * r, cy + 0.7F * r},
                     {cx + 1.1F * side * r, cy + 0.7F * r}, ink::kText, 1.4F * u);
  for (const float at : {-0.9F, -0.2F, 0.5F})
    draw.AddLine({cx, cy + at * r}, {cx, cy + (at + 0.4F) * r}, ink::kText, 1.4F * u);
  const ImFont* font = ui.font(Letter::body);
  draw.AddText(font, font->FontSize,
               {std::round(x + 42 * u), std::round(y + (h - font->FontSize) / 2)}, ink::kText,
               words.c_str());
}

Word name_of(tick::ToolMode mode) {
  switch (mode) {
    case tick::ToolMode::cut:
      break;
    case tick::ToolMode::add:
      return Word::add;
    case tick::ToolMode::touch:
      return Word::touch;
    case tick::ToolMode::restore:
      return Word::back;
    case tick::ToolMode::smooth:
      return Word::smooth;
  }
  return Word::cut;
}

float hud_height(const Ui& ui) { return (kStrip + kMargin) * ui.unit(); }

std::string minutes(double seconds) {
  const auto whole = static_cast<long>(std::max(0.0, seconds));
  if (whole >= 3600)
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string clock_of(double seconds) {
  const double tenths = std::floor(10 * std::max(0.0, seconds) + 1e-6);
  return fmt::format("{}.{}", minutes(tenths / 10), static_cast<long>(tenths) % 10);
}

bool draw_hud(Ui& ui, const HudState& s) {
  const float u = ui.unit();
  const bool near = s.spares;
  const float w =
      (298 + 138 + 176 + 132 + 124 + 76 + (s.device ? 112.0F : 0.0F) + (near ? 160.0F : 0.0F)) * u;
  const float x = std::max(kMargin * u, (ui.width() - w) / 2), y = ui.height() - hud_height(ui);
  ui.panel("##strip", x, y, w, kStrip * u);
  Strip strip(ui, x, y);
  force_cell(ui, strip, s);
  press_cell(ui, strip, s);
  speed_cell(strip, s);
  tool_cell(ui, strip, s);
  strip.cell(124, Word::removed, fmt::format("{:.1f}", 1e9 * s.removed), "mm³");
  if (near && !s.nearest) {
    strip.cell(160, Word::nearest_far, "> 20", "mm");
  } else if (near) {
    // the whole sentence if it fits, otherwise the name alone
    const std::string name = s.nearest->name.substr(0, s.nearest->name.find(" ("));
    const std::string whole = say(Word::nearest, name);
    constexpr float kRoom = 142;  // [points]
    strip.title(fits(ui, whole, kRoom * u) ? whole : shortened(ui, name, kRoom * u));
    if (!fits(ui, name, kRoom * u)) tip_over(strip, 160 * u, whole);
    const double mm = 1e3 * s.nearest->distance;
    const std::string value = fmt::format("{:.1f}", mm);
    const ImU32 shade = mm < 1 ? ink::kBad : mm < 2 ? ink::kWarn : ink::kText;
    ui.write(strip.x(), strip.y() + 24 * u, Letter::large, shade, value);
    ui.write(strip.x() + ui.width_of(Letter::large, value) + 6 * u, strip.y() + 33 * u,
             Letter::small, shade,
             mm < 1   ? "mm  !!"
             : mm < 2 ? "mm  !"
                      : "mm");
    strip.next(160);
  }
  strip.cell(76, Word::time, minutes(s.seconds));
  if (s.device) tick_cell(ui, strip, s);
  ImGui::End();

  scale_bar(ui, s);
  draw_mirror_sign(ui, s.mirror, s.column);
  float above = y;
  const LineRoom room = line_room(ui, s);
  const bool away = line_above(ui, above, s.note, false, room, s.note_stays);
  static_cast<void>(line_above(ui, above, s.warning, true, room));
  return away;
}

}  // namespace burr::app
