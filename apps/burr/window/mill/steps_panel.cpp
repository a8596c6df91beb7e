#include "window/mill/steps_panel.h"

#include <algorithm>
#include <cfloat>
#include <string>
#include <vector>

#include "burr/guidance/suits.h"
#include "shared/word_names.h"
#include "window/mill/side_panel.h"
#include "window/mill/step_light.h"
#include "window/parts/hud.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;
using guidance::MarkKind;

constexpr float kWide = kSideWide, kPadding = 14, kRow = 22, kButtons = 34, kSign = 18;  // [points]

struct Paragraph {
  Letter letter;
  ImU32 colour;
  std::string text;
};

// The title of a step, or its id if the case gives none.
const std::string& title_of(const scenario::Step& step) {
  const std::string& title = step.title.in(spoken().code);
  return title.empty() ? step.id : title;
}

std::vector<Paragraph> paragraphs(const guidance::Steps& steps, const StepsState& state) {
  const scenario::Step* now = steps.now();
  if (now == nullptr) return {{Letter::strong, ink::kGood, word(Word::steps_all_done)}};
  std::vector<Paragraph> all = {
      {Letter::small, ink::kDim, say(Word::steps_count, *steps.current() + 1, steps.size())},
      {Letter::strong, ink::kAccent, title_of(*now)},
      {Letter::body, ink::kText, now->say.in(spoken().code)}};
  if (const std::string tool = guidance::suits(*now); !tool.empty())
    all.push_back({Letter::body, ink::kDim, say(Word::steps_tool, tool)});
  if (state.press)
    all.push_back({Letter::body, ink::kDim, say(Word::steps_press, 1e3 * *state.press)});
  if (!now->spare.empty())
    all.push_back({Letter::body, ink::kWarn, say(Word::task_spare, anatomy_list(now->spare))});
  return all;
}

// The kinds of marks that are shown, for a legend.
std::vector<MarkKind> kinds_of(const guidance::StepMarks* lit) {
  std::vector<MarkKind> kinds;
  for (const MarkKind kind :
       {MarkKind::target, MarkKind::plane, MarkKind::spare, MarkKind::place}) {
    const bool tissue = lit != nullptr && ((kind == MarkKind::target && !lit->target.empty()) ||
                                           (kind == MarkKind::spare && !lit->spare.empty()));
    if (lit != nullptr && (tissue || lit->has(kind))) kinds.push_back(kind);
  }
  return kinds;
}

// Which rows are shown where not all fit: the current one in their middle.
std::size_t first_row(const guidance::Steps& steps, std::size_t shown) {
  const std::size_t current = steps.current().value_or(0);
  const std::size_t half = shown / 2;
  return std::min(current > half ? current - half : 0, steps.size() - shown);
}

// A mark before a step: done is a tick, the current one a filled arrow, any other a ring.
void mark(ImDrawList& draw, ImVec2 at, float u, bool done, bool current) {
  if (done) {
    draw.AddLine({at.x - 5 * u, at.y}, {at.x - 1 * u, at.y + 4 * u}, ink::kGood, 2 * u);
    draw.AddLine({at.x - 1 * u, at.y + 4 * u}, {at.x + 6 * u, at.y - 5 * u}, ink::kGood, 2 * u);
  } else if (current) {
    draw.AddTriangleFilled({at.x - 4 * u, at.y - 5 * u}, {at.x - 4 * u, at.y + 5 * u},
                           {at.x + 6 * u, at.y}, ink::kAccent);
  } else {
    draw.AddCircle(at, 4 * u, ink::kDim, 16, 1.4F * u);
  }
}

// The rows of the list; the one that was pressed.
std::optional<std::size_t> rows(Ui& ui, const guidance::Steps& steps, float x, float y,
                                std::size_t shown) {
  const float u = ui.unit(), wide = (kWide - 2 * kPadding) * u;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  std::optional<std::size_t> pressed;
  const std::size_t first = first_row(steps, shown);
  for (std::size_t n = first; n < first + shown; ++n, y += kRow * u) {
    const bool current = steps.current() == n;
    ImGui::PushID(static_cast<int>(n));
    ImGui::SetCursorScreenPos({x, y});
    if (ImGui::InvisibleButton("##step", {wide, kRow * u}) && !current) pressed = n;
    if (ImGui::IsItemHovered() && !current) {
      draw.AddRectFilled({x, y}, {x + wide, y + kRow * u}, ink::kOver, 4 * u);
      ImGui::SetTooltip("%s", word(steps.is_done(n) ? Word::steps_reopen : Word::steps_choose));
    }
    ImGui::PopID();
    mark(draw, {x + 8 * u, y + kRow * u / 2}, u, steps.is_done(n), current);
    draw.PushClipRect({x, y}, {x + wide, y + kRow * u}, true);
    ui.write(x + 22 * u, y + 3 * u, Letter::body, current ? ink::kText : ink::kDim,
             title_of(steps[n]));
    draw.PopClipRect();
  }
  return pressed;
}

}  // namespace

StepsPressed draw_steps(Ui& ui, const guidance::Steps& steps, const StepsState& state) {
  StepsPressed pressed;
  const float u = ui.unit(), inside = (kWide - 2 * kPadding) * u, gap = 6 * u;
  const float x = kSideLeft * u, y = kSideLeafTop * u,
              room = ui.height() - hud_height(ui) - y - kSideFoot * u;
  const std::vector<Paragraph> texts = paragraphs(steps, state);
  const auto height_of = [&](const Paragraph& one) {
    const ImFont* font = ui.font(one.letter);
    return font->CalcTextSizeA(font->FontSize, FLT_MAX, inside, one.text.c_str()).y;
  };
  const bool works = steps.now() != nullptr;
  float high = 2 * kPadding * u + (works ? kButtons * u : 0);
  for (const Paragraph& one : texts) high += height_of(one) + gap;
  const std::vector<MarkKind> signs = kinds_of(state.lit);
  high += static_cast<float>(signs.size()) * kSign * u;
  const auto fit = static_cast<std::size_t>(std::max(1.0F, (room - high) / (kRow * u)));
  const std::size_t shown = std::min(fit, steps.size());
  high = std::min(room, high + static_cast<float>(shown) * kRow * u);

  ui.panel("##steps", x, y, kWide * u, high);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  float at = y + kPadding * u;
  for (const Paragraph& one : texts) {
    const ImFont* font = ui.font(one.letter);
    draw.AddText(font, font->FontSize, {x + kPadding * u, at}, one.colour, one.text.c_str(),
                 nullptr, inside);
    at += height_of(one) + gap;
  }
  if (works) {
    ImGui::SetCursorScreenPos({x + kPadding * u, at});
    pressed.done = ImGui::Button(say(Word::steps_done, "J").c_str());
    ImGui::SameLine(0, 8 * u);
    if (state.offers_light)
      pressed.light = ImGui::Button(
          say(state.lit != nullptr ? Word::steps_unlight : Word::steps_light, "A").c_str());
    at += kButtons * u;
    for (const MarkKind kind : signs) {
      draw_sign(draw, {x + (kPadding + 8) * u, at + kSign * u / 2}, 5 * u, u, kind, ink_of(kind));
      ui.write(x + (kPadding + 22) * u, at, Letter::small, ink_of(kind), word(legend_of(kind)));
      at += kSign * u;
    }
  }
  pressed.row = rows(ui, steps, x + kPadding * u, at, shown);
  ImGui::End();
  return pressed;
}

bool draw_done_button(Ui& ui, float column) {
  const float u = ui.unit(), wide = 150 * u, high = 46 * u;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * u, 8 * u});
  ui.panel("##iamdone", ui.width() - column - wide - 10 * u, 10 * u, wide, high);
  const bool pressed = ImGui::Button(word(Word::done_button), {wide - 16 * u, high - 16 * u});
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("%s  ( %s )", word(Word::done_button), word(Word::key_ctrl_enter));
  ImGui::End();
  ImGui::PopStyleVar();
  return pressed;
}

}  // namespace burr::app
