#include "window/mill/rack_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "shared/word_names.h"
#include "window/mill/side_panel.h"
#include "window/mill/titled_panel.h"
#include "window/parts/hud.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;

constexpr int kAcross = 3;
constexpr float kTileWide = 110, kTileHigh = 112, kPicture = 72, kTop = 44, kGrip = 40;  // [points]

// At most two lines of the name, broken at a space.
void write_name(const Ui& ui, float middle, float y, float wide, const std::string& name,
                ImU32 shade) {
  std::string first = name, second;
  while (ui.width_of(Letter::small, first) > wide) {
    const std::size_t space = first.rfind(' ');
    if (space == std::string::npos || space == 0) break;
    second = first.substr(space + 1) + (second.empty() ? "" : " " + second);
    first.resize(space);
  }
  ui.write(middle, y, Letter::small, shade, first, 0.5F);
  if (!second.empty())
    ui.write(middle, y + ui.height_of(Letter::small), Letter::small, shade, second, 0.5F);
}

bool draw_tile(const Ui& ui, const RackTile& tile, ImVec2 p) {
  const float u = ui.unit();
  const ImVec2 q = {p.x + kTileWide * u, p.y + kTileHigh * u};
  ImGui::SetCursorScreenPos(p);
  const bool pressed = ImGui::InvisibleButton("##tile", {kTileWide * u, kTileHigh * u});
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  if (ImGui::IsItemHovered()) {
    draw.AddRectFilled(p, q, ink::kOver, 6 * u);
    ImGui::SetTooltip("%s\n%s", tile.name.c_str(), tile.about.c_str());
  }
  const ImVec2 a = {p.x + 4 * u, p.y + 4 * u}, b = {q.x - 4 * u, p.y + 4 * u + kPicture * u};
  if (tile.picture != 0)
    draw.AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(tile.picture)),
                         a, b, {0, 0}, {1, 1}, IM_COL32_WHITE, 4 * u);
  else
    draw.AddRectFilled(a, b, ink::kTrough, 4 * u);
  if (tile.chosen) {  // a frame, so that not only colour shows the choice
    draw.AddRectFilled({p.x, b.y}, q, ink::rgb(86, 180, 233, 40), 6 * u);
    draw.AddRect(p, q, ink::kAccent, 6 * u, 0, 2 * u);
  }
  draw.PushClipRect(p, q, true);
  write_name(ui, p.x + kTileWide * u / 2, b.y + 3 * u, (kTileWide - 8) * u, tile.name,
             tile.chosen ? ink::kText : ink::kDim);
  draw.PopClipRect();
  return pressed;
}

// "Lean  45 deg  - +" : two buttons after a text. Returns -1, 0 or 1.
int steps_of(const Ui& ui, const char* id, float x, float y, const std::string& text) {
  const float u = ui.unit(), side = 26 * u;
  int by = 0;
  ui.write(x, y + 6 * u, Letter::small, ink::kText, text);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  for (const int way : {-1, 1}) {
    const float at = x + (way < 0 ? 106 : 136) * u;
    ImGui::SetCursorScreenPos({at, y});
    ImGui::PushID(id);
    ImGui::PushID(way);
    if (ImGui::InvisibleButton("##step", {side, side})) by = way;
    draw.AddRectFilled({at, y}, {at + side, y + side},
                       ImGui::IsItemHovered() ? ink::kOver : ink::kButton, 5 * u);
    ImGui::PopID();
    ImGui::PopID();
    const ImVec2 c = {at + side / 2, y + side / 2};
    draw.AddLine({c.x - 5 * u, c.y}, {c.x + 5 * u, c.y}, ink::kText, 1.6F * u);
    if (way > 0) draw.AddLine({c.x, c.y - 5 * u}, {c.x, c.y + 5 * u}, ink::kText, 1.6F * u);
  }
  return by;
}

}  // namespace

RackPressed draw_rack(Ui& ui, const std::vector<RackTile>& tiles,
                      const std::optional<RackGrip>& grip) {
  RackPressed pressed;
  const float u = ui.unit(), x = kSideLeft * u, y = kSideTop * u, wide = kSideWide * u;
  const auto rows =
      static_cast<float>((tiles.size() + kAcross - 1) / static_cast<std::size_t>(kAcross));
  const float foot = grip ? kGrip * u : 10 * u, room = ui.height() - hud_height(ui) - y - 8 * u;
  const float grid = std::min(rows * kTileHigh * u, room - kTop * u - foot);
  const float high = kTop * u + grid + foot;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
  pressed.close = begin_titled(ui, "##rack", high, word(Word::rack));
  ImGui::SetCursorScreenPos({x + 10 * u, y + kTop * u});
  ImGui::BeginChild("##tiles", {wide - 14 * u, grid});
  const ImVec2 first = ImGui::GetCursorScreenPos();
  for (std::size_t n = 0; n < tiles.size(); ++n) {
    ImGui::PushID(static_cast<int>(n));
    const auto column = static_cast<float>(n % kAcross), row = static_cast<float>(n / kAcross);
    if (draw_tile(ui, tiles[n],
                  {first.x + column * (kTileWide + 3) * u, first.y + row * kTileHigh * u}))
      pressed.tile = n;
    ImGui::PopID();
  }
  ImGui::EndChild();
  if (grip) {
    const float at = y + high - 33 * u;
    pressed.lean = steps_of(ui, "lean", x + 14 * u, at, say(Word::rack_lean, grip->lean_deg));
    pressed.roll = steps_of(ui, "roll", x + 190 * u, at, say(Word::rack_roll, grip->roll_deg));
  }
  ImGui::End();
  ImGui::PopStyleVar();
  return pressed;
}

}  // namespace burr::app
