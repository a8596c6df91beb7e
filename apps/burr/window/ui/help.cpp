#include "window/ui/help.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "shared/word_names.h"
#include "window/ui/printed_keys.h"

namespace burr::app {
namespace {

using Rows = std::vector<std::pair<std::string, Word>>;

void block(const Ui& ui, float x, float& y, Word title, const Rows& rows) {
  const float u = ui.unit();
  ui.write(x, y, Ui::Letter::strong, ink::kAccent, word(title));
  y += 25 * u;
  for (const auto& [keys, what] : rows) {
    ui.write(x, y, Ui::Letter::strong, ink::kText, keys);
    ui.write(x + 168 * u, y, Ui::Letter::body, ink::kDim, word(what));
    y += 22 * u;
  }
  y += 14 * u;
}

// The second page: what gamepad, pedal and SpaceMouse do.
void pad_rows(const Ui& ui, float x, float y) {
  block(ui, x, y, Word::help_pad,
        {{word(Word::key_sticks), Word::pad_sticks},
         {word(Word::key_right_trigger), Word::pad_trigger},
         {word(Word::key_left_trigger), Word::pad_slow},
         {"B", Word::pad_lift},
         {"X  Y", Word::pad_undo},
         {word(Word::key_shoulders), Word::pad_shoulders},
         {word(Word::key_cross), Word::pad_cross},
         {word(Word::key_clicks), Word::pad_clicks},
         {"Start  Back", Word::pad_menu},
         {word(Word::key_pedal), Word::pedal_does},
         {"SpaceMouse", Word::cap_does},
         {word(Word::key_real), Word::real_does}});
}

}  // namespace

bool draw_help(Ui& ui, const std::vector<HelpRow>& rows, bool& pads) {
  const float u = ui.unit(), w = 920 * u, h = 636 * u;
  const float x = (ui.width() - w) / 2, y = std::max(6 * u, (ui.height() - h) / 2 - 20 * u);
  ui.page("##help", x, y, w, h);
  ui.write(x + 28 * u, y + 22 * u, Ui::Letter::large, ink::kText, word(Word::help_title));
  ImGui::SetCursorScreenPos({x + w - 390 * u, y + 20 * u});
  if (ImGui::Button(word(pads ? Word::help_title : Word::help_pad), {276 * u, 0})) pads = !pads;
  ImGui::SetCursorScreenPos({x + w - 100 * u, y + 20 * u});
  const bool close = ImGui::Button("OK  [F1]", {76 * u, 0});
  if (pads) {
    pad_rows(ui, x + 28 * u, y + 70 * u);
    ImGui::End();
    return !close;
  }
  float left = y + 70 * u, right = left;
  const auto show = [&](float at, float& below, HelpBlock which, Word title) {
    Rows of_block;
    for (const HelpRow& row : rows)
      if (row.block == which) of_block.emplace_back(row.keys, row.does);
    block(ui, at, below, title, of_block);
  };
  show(x + 28 * u, left, HelpBlock::hand, Word::help_hand);
  show(x + 28 * u, left, HelpBlock::view, Word::help_view);
  show(x + 480 * u, right, HelpBlock::tools, Word::help_tools);
  show(x + 480 * u, right, HelpBlock::program, Word::help_program);
  ui.write(x + 28 * u, y + h - 64 * u, Ui::Letter::body, ink::kDim, word(Word::help_ghost));
  ImGui::End();
  return !close;
}

bool draw_replay_help(Ui& ui) {
  const float u = ui.unit(), w = 920 * u, h = 420 * u;
  const float x = (ui.width() - w) / 2, y = std::max(6 * u, (ui.height() - h) / 2 - 60 * u);
  ui.page("##replayhelp", x, y, w, h);
  ui.write(x + 28 * u, y + 22 * u, Ui::Letter::large, ink::kText, word(Word::replay_help_title));
  float left = y + 70 * u, right = left;
  block(ui, x + 28 * u, left, Word::time,
        {{word(Word::key_space), Word::replay_help_play},
         {word(Word::replay_drag), Word::replay_help_drag},
         {"←  →", Word::replay_help_step},
         {word(Word::key_shift_arrows), Word::replay_help_small},
         {word(Word::key_ctrl_arrows), Word::replay_help_stroke},
         {"Home  End", Word::replay_help_ends},
         {",  .", Word::replay_help_pace},
         {"B", Word::replay_help_beside},
         {bracket_keys(), Word::replay_help_shift},
         {"C", Word::replay_help_compare}});
  block(ui, x + 480 * u, right, Word::help_view,
        {{fmt::format("{}, ↑  ↓", word(Word::key_left)), Word::help_turn},
         {word(Word::key_middle), Word::help_shift},
         {word(Word::key_wheel), Word::help_zoom},
         {"F", Word::help_first_view},
         {"L", Word::help_labels},
         {"T", Word::help_see_through},
         {"V", Word::replay_help_slices},
         {"Tab", Word::help_hide},
         {"P", Word::help_picture},
         {"E", Word::film_help},
         {"I  O", Word::film_marks},
         {"Esc  Q", Word::help_quit}});
  ImGui::SetCursorScreenPos({x + w - 100 * u, y + 20 * u});
  const bool close = ImGui::Button("OK  [F1]", {76 * u, 0});
  ImGui::End();
  return !close;
}

}  // namespace burr::app
