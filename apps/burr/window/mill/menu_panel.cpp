#include "window/mill/menu_panel.h"

#include "window/mill/side_panel.h"
#include "window/shell/words.h"

namespace burr::app {

using Letter = Ui::Letter;

MenuPressed draw_menu(Ui& ui, const std::string& title, const std::vector<MenuItem>& items) {
  constexpr float kRow = 27, kTop = 44;  // [points]
  MenuPressed pressed;
  const float u = ui.unit(), x = kSideLeft * u, y = kSideTop * u, wide = kSideWide * u;
  const float high = (kTop + kRow * static_cast<float>(items.size()) + 10) * u;
  ui.panel("##menu", x, y, wide, high);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled({x, y}, {x + wide, y + high}, ink::rgb(20, 23, 27), 8 * u);
  ui.write(x + 14 * u, y + 13 * u, Letter::strong, ink::kAccent, title);
  const float cross = x + wide - 36 * u;
  ImGui::SetCursorScreenPos({cross, y + 8 * u});
  pressed.close = ImGui::InvisibleButton("##close", {28 * u, 28 * u});
  if (ImGui::IsItemHovered()) {
    draw.AddRectFilled({cross, y + 8 * u}, {cross + 28 * u, y + 36 * u}, ink::kOver, 5 * u);
    ImGui::SetTooltip("%s", word(Word::leaf_close));
  }
  const ImVec2 c = {cross + 14 * u, y + 22 * u};
  draw.AddLine({c.x - 5 * u, c.y - 5 * u}, {c.x + 5 * u, c.y + 5 * u}, ink::kText, 1.5F * u);
  draw.AddLine({c.x - 5 * u, c.y + 5 * u}, {c.x + 5 * u, c.y - 5 * u}, ink::kText, 1.5F * u);
  for (std::size_t n = 0; n < items.size(); ++n) {
    const float at = y + (kTop + kRow * static_cast<float>(n)) * u;
    ImGui::PushID(static_cast<int>(n));
    ImGui::SetCursorScreenPos({x + 6 * u, at});
    if (ImGui::InvisibleButton("##item", {wide - 12 * u, kRow * u})) pressed.item = n;
    if (ImGui::IsItemHovered())
      draw.AddRectFilled({x + 6 * u, at}, {x + wide - 6 * u, at + kRow * u}, ink::kOver, 5 * u);
    ImGui::PopID();
    const float end = x + wide - 16 * u - ui.width_of(Letter::small, items[n].key);
    draw.PushClipRect({x, at}, {end - 6 * u, at + kRow * u}, true);
    ui.write(x + 16 * u, at + 5 * u, Letter::body, ink::kText, items[n].name);
    draw.PopClipRect();
    ui.write(end, at + 7 * u, Letter::small, ink::kDim, items[n].key);
  }
  ImGui::End();
  return pressed;
}

}  // namespace burr::app
