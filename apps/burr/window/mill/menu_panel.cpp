#include "window/mill/menu_panel.h"

#include "shared/word_names.h"
#include "window/mill/side_panel.h"
#include "window/mill/titled_panel.h"

namespace burr::app {

using Letter = Ui::Letter;

MenuPressed draw_menu(Ui& ui, const std::string& title, const std::vector<MenuItem>& items) {
  constexpr float kRow = 27, kTop = 44;  // [points]
  MenuPressed pressed;
  const float u = ui.unit(), x = kSideLeft * u, y = kSideTop * u, wide = kSideWide * u;
  const float high = (kTop + kRow * static_cast<float>(items.size()) + 10) * u;
  pressed.close = begin_titled(ui, "##menu", high, title);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
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
