#include "window/rate/rate_panel.h"

#include <fmt/format.h>

#include <algorithm>

#include "shared/word_names.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;

constexpr std::array<Word, 3> kNames = {Word::report_verdict_met, Word::report_verdict_unmet,
                                        Word::rate_cannot};
constexpr std::array<Word, 3> kAnchors = {Word::rate_anchor_met, Word::rate_anchor_unmet,
                                          Word::rate_anchor_cannot};

void written(const Ui& ui, Letter letter, ImU32 shade, const std::string& text) {
  if (text.empty()) return;
  ImGui::PushFont(ui.font(letter));
  ImGui::PushStyleColor(ImGuiCol_Text, shade);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

// A button that stays down; its frame shows it, so that not only a colour does.
bool choice(const char* text, bool chosen, float wide, float u) {
  if (chosen) {
    ImGui::PushStyleColor(ImGuiCol_Button, ink::rgb(86, 180, 233, 90));
    ImGui::PushStyleColor(ImGuiCol_Border, ink::kAccent);
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 1.5F * u);
  }
  const bool pressed = ImGui::Button(text, {wide, 0});
  if (chosen) {
    ImGui::PopStyleVar();
    ImGui::PopStyleColor(2);
  }
  return pressed;
}

// One item: its sentence, three marks, and why. The one that the keys mark has a bar at its left.
void item_row(const Ui& ui, RateShown& shown, std::size_t n) {
  const float u = ui.unit();
  RateItem& item = shown.items[n];
  const bool here = n == shown.at;
  ImGui::PushID(item.id.c_str());
  const ImVec2 top = ImGui::GetCursorScreenPos();
  ImGui::Indent(12 * u);
  written(ui, Letter::body, ink::kText, fmt::format("{}. {}", n + 1, item.text));
  const float wide = (ImGui::GetContentRegionAvail().x - 12 * u) / 3;
  for (std::size_t k = 0; k < kRateMarks.size(); ++k) {
    if (k > 0) ImGui::SameLine(0, 6 * u);
    if (choice(word(kNames[k]), item.mark == kRateMarks[k], wide, u)) {
      item.mark = item.mark == kRateMarks[k] ? "" : kRateMarks[k];
      shown.at = n;
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", word(kAnchors[k]));
  }
  if (here || !item.reason.empty()) {
    if (here && shown.to_reason) focus_next();
    static_cast<void>(text_field("##why", word(Word::rate_why), item.reason,
                                 ImGui::GetContentRegionAvail().x - 2 * u));
    if (ImGui::IsItemActivated()) shown.at = n;
  }
  ImGui::Unindent(12 * u);
  const float bottom = ImGui::GetCursorScreenPos().y - 4 * u;
  if (here) {
    ImGui::GetWindowDrawList()->AddRectFilled(top, {top.x + 4 * u, bottom}, ink::kAccent, 2 * u);
    if (shown.scroll) ImGui::SetScrollHereY(0.6F);
  }
  ImGui::Dummy({1, 6 * u});
  ImGui::PopID();
}

// Who marks, in the middle of the window.
RatePressed draw_who(Ui& ui, RateShown& shown) {
  RatePressed pressed;
  const float u = ui.unit(), w = 620 * u, h = 250 * u;
  ui.page("##ratewho", (ui.width() - w) / 2, (ui.height() - h) / 2, w, h);
  written(ui, Letter::large, ink::kText, word(Word::rate_title));
  written(ui, Letter::body, ink::kDim, word(Word::rate_how));
  ImGui::Dummy({1, 8 * u});
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(word(Word::rate_you));
  ImGui::SameLine();
  if (ImGui::IsWindowAppearing()) focus_next();
  const bool entered = text_field("##rater", word(Word::rate_name), shown.rater, 300 * u);
  ImGui::Dummy({1, 4 * u});
  pressed.begin =
      ImGui::Button(
          fmt::format("{}  [{}]", word(Word::rate_begin), word(Word::key_enter)).c_str()) ||
      entered;
  ImGui::SameLine();
  pressed.leave = ImGui::Button(fmt::format("{}  [Esc]", word(Word::rate_leave)).c_str());
  written(ui, Letter::body, ink::kWarn, shown.note);
  ImGui::End();
  return pressed;
}

// The buttons of the ten views, in two rows below the bone.
int draw_views(Ui& ui, const RateShown& shown, float wide) {
  if (shown.views.empty()) return -1;
  const float u = ui.unit(), h = 112 * u, x = 12 * u, w = wide - 24 * u;
  int pressed = -1;
  ui.panel("##rateviews", x, ui.height() - h - 12 * u, w, h);
  const float one = (w - 24 * u - 4 * 6 * u) / 5;
  for (std::size_t n = 0; n < shown.views.size(); ++n) {
    if (n % 5 != 0) ImGui::SameLine(0, 6 * u);
    const std::string name = fmt::format("{}  {}##view{}", (n + 1) % 10, shown.views[n], n);
    if (choice(name.c_str(), n == shown.view, one, u)) pressed = static_cast<int>(n);
  }
  written(ui, Letter::small, ink::kDim,
          say(Word::rate_wide, shown.wide_mm) + "   " + word(Word::rate_keys));
  ImGui::End();
  return pressed;
}

}  // namespace

RatePressed draw_rate(Ui& ui, RateShown& shown) {
  if (shown.asks_who) return draw_who(ui, shown);
  RatePressed pressed;
  const float u = ui.unit(), w = kRatePanel * u, x = ui.width() - w;
  pressed.view = draw_views(ui, shown, x);
  ui.panel("##rate", x, 0, w, ui.height());
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {6 * u, 5 * u});
  ImGui::SetCursorScreenPos({x + 14 * u, 12 * u});
  ImGui::BeginChild("##rateinside", {w - 28 * u, ui.height() - 24 * u});
  written(ui, Letter::large, ink::kText, shown.heading);
  std::string left = say(Word::rate_left, shown.left);
  if (shown.elsewhere > 0) left += ". " + say(Word::rate_elsewhere, shown.elsewhere);
  written(ui, Letter::small, ink::kDim, left);
  for (std::size_t k = 0; k < kNames.size(); ++k)
    written(ui, Letter::small, ink::kDim,
            fmt::format("{}: {}", word(kNames[k]), word(kAnchors[k])));
  ImGui::Dummy({1, 2 * u});
  const float foot = 80 * u;
  ImGui::BeginChild("##rateitems", {0, ImGui::GetContentRegionAvail().y - foot});
  if (!shown.trouble.empty())
    written(ui, Letter::body, ink::kWarn, say(Word::rate_not_shown, shown.trouble));
  if (shown.making) {
    written(ui, Letter::body, ink::kText, word(Word::rate_making));
    ImGui::ProgressBar(static_cast<float>(std::clamp(shown.progress, 0.0, 1.0)), {-1, 8 * u}, "");
  }
  for (std::size_t n = 0; n < shown.items.size(); ++n) item_row(ui, shown, n);
  ImGui::EndChild();
  written(ui, Letter::small, ink::kWarn, shown.note.empty() ? " " : shown.note);
  const bool product = !shown.items.empty();
  ImGui::BeginDisabled(!product || shown.making || !shown.trouble.empty());
  pressed.keep = ImGui::Button(
      fmt::format("{}  [{}]", word(Word::rate_keep), word(Word::key_ctrl_enter)).c_str());
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(!product);
  pressed.later = ImGui::Button(word(Word::rate_later));
  ImGui::EndDisabled();
  ImGui::SameLine();
  pressed.leave = ImGui::Button(fmt::format("{}  [Esc]", word(Word::rate_leave)).c_str());
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::End();
  shown.to_reason = shown.scroll = false;
  return pressed;
}

}  // namespace burr::app
