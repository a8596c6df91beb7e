#include "window/mill/cross_button.h"

#include "shared/word_names.h"

namespace burr::app {

bool draw_cross(const Ui& ui, float x, float y) {
  const float u = ui.unit(), side = 28 * u;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImGui::SetCursorScreenPos({x, y});
  const bool pressed = ImGui::InvisibleButton("##close", {side, side});
  if (ImGui::IsItemHovered()) {
    draw.AddRectFilled({x, y}, {x + side, y + side}, ink::kOver, 5 * u);
    ImGui::SetTooltip("%s", word(Word::leaf_close));
  }
  const ImVec2 c = {x + side / 2, y + side / 2};
  draw.AddLine({c.x - 5 * u, c.y - 5 * u}, {c.x + 5 * u, c.y + 5 * u}, ink::kText, 1.5F * u);
  draw.AddLine({c.x - 5 * u, c.y + 5 * u}, {c.x + 5 * u, c.y - 5 * u}, ink::kText, 1.5F * u);
  return pressed;
}

}  // namespace burr::app
