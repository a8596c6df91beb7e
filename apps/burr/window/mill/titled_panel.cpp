#include "window/mill/titled_panel.h"

#include "window/mill/cross_button.h"
#include "window/mill/side_panel.h"

namespace burr::app {

bool begin_titled(Ui& ui, const char* name, float high, const std::string& title) {
  const float u = ui.unit(), x = kSideLeft * u, y = kSideTop * u, wide = kSideWide * u;
  ui.panel(name, x, y, wide, high);
  ImGui::GetWindowDrawList()->AddRectFilled({x, y}, {x + wide, y + high}, ink::rgb(20, 23, 27),
                                            8 * u);
  ui.write(x + 14 * u, y + 13 * u, Ui::Letter::strong, ink::kAccent, title);
  return draw_cross(ui, x + wide - 36 * u, y + 8 * u);
}

}  // namespace burr::app
