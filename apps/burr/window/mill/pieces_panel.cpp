#include "window/mill/pieces_panel.h"

#include <algorithm>

#include "shared/word_names.h"
#include "window/mill/side_panel.h"
#include "window/mill/titled_panel.h"

namespace burr::app {
namespace {

constexpr float kTop = 48, kRow = 34;  // [points]
constexpr std::size_t kMostRows = 8;

// Three fields in a row; true: one of them has a new value.
bool fields(const Ui& ui, const char* id, float x, float y, Word title, const char* format,
            std::array<double, 3>& values) {
  const float u = ui.unit();
  ui.write(x, y + 6 * u, Ui::Letter::small, ink::kText, word(title));
  bool typed = false;
  ImGui::PushID(id);
  for (std::size_t n = 0; n < values.size(); ++n) {
    ImGui::PushID(static_cast<int>(n));
    ImGui::SetCursorScreenPos({x + (104 + 76 * static_cast<float>(n)) * u, y});
    ImGui::SetNextItemWidth(70 * u);
    double value = values[n];
    ImGui::InputDouble("##value", &value, 0, 0, format);
    if (ImGui::IsItemDeactivatedAfterEdit()) {
      values[n] = value;
      typed = true;
    }
    ImGui::PopID();
  }
  ImGui::PopID();
  return typed;
}

}  // namespace

PiecesPressed draw_pieces(Ui& ui, const PiecesState& state) {
  PiecesPressed pressed;
  const float u = ui.unit(), x = kSideLeft * u, y = kSideTop * u, wide = kSideWide * u;
  const std::size_t rows = std::clamp<std::size_t>(state.rows.size(), 1, kMostRows);
  const float foot = !state.taken ? 12 : state.carries ? 284 : 230;
  const float high = (kTop + kRow * static_cast<float>(rows) + foot) * u;
  pressed.close = begin_titled(ui, "##pieces", high, word(Word::pieces));
  float at = y + kTop * u;
  if (state.rows.empty())
    ui.write(x + 14 * u, at + 6 * u, Ui::Letter::small, ink::kDim,
             word(state.looking ? Word::pieces_looking : Word::pieces_none));
  for (std::size_t n = 0; n < std::min(state.rows.size(), kMostRows); ++n, at += kRow * u) {
    const PiecesState::Row& row = state.rows[n];
    const bool taken = state.taken == n;
    std::string text = say(Word::piece_row, n + 1, row.mm3);
    if (row.moved_mm > 0.005 || row.turned_deg > 0.05)
      text += "  " + say(Word::piece_moved, row.moved_mm, row.turned_deg);
    ui.write(x + 14 * u, at + 8 * u, taken ? Ui::Letter::strong : Ui::Letter::small, ink::kText,
             text);
    if (state.taken || state.putting) continue;
    ImGui::PushID(static_cast<int>(n));
    ImGui::SetCursorScreenPos({x + wide - 84 * u, at + 2 * u});
    if (ImGui::Button(word(Word::piece_take), {70 * u, 28 * u})) pressed.take = n;
    ImGui::PopID();
  }
  if (state.taken) {
    at += 4 * u;
    pressed.mm = state.mm;
    pressed.degrees = state.degrees;
    pressed.typed = fields(ui, "by", x + 14 * u, at, Word::piece_by, "%.1f", pressed.mm);
    pressed.typed =
        fields(ui, "turn", x + 14 * u, at + 34 * u, Word::piece_turn, "%.1f", pressed.degrees) ||
        pressed.typed;
    at += 74 * u;
    ImGui::SetCursorScreenPos({x + 14 * u, at});
    ImGui::PushTextWrapPos(wide - 14 * u);
    ImGui::PushFont(ui.font(Ui::Letter::small));
    if (!state.plan.empty()) ImGui::TextUnformatted(state.plan.c_str());
    ImGui::SetCursorPosX(14 * u);
    ImGui::PushStyleColor(ImGuiCol_Text, ink::kDim);
    ImGui::TextUnformatted(word(Word::piece_keys));
    if (state.carries) {
      ImGui::SetCursorPosX(14 * u);
      ImGui::TextUnformatted(word(Word::piece_hand));
    }
    ImGui::SetCursorPosX(14 * u);
    ImGui::TextUnformatted(word(state.felt ? Word::piece_felt : Word::piece_not_felt));
    ImGui::PopStyleColor();
    ImGui::PopFont();
    ImGui::PopTextWrapPos();
    ImGui::SetCursorScreenPos({x + 14 * u, y + high - 42 * u});
    pressed.put_down = ImGui::Button(word(Word::piece_put_down), {156 * u, 30 * u});
    ImGui::SameLine();
    pressed.leave = ImGui::Button(word(Word::piece_leave), {156 * u, 30 * u});
  }
  ImGui::End();
  return pressed;
}

}  // namespace burr::app
