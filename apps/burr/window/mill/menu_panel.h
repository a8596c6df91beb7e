// apps/burr/window/mill/menu_panel.h - a list of what has a key but no button of its own, so that the
// mouse reaches it. There are two: views, and everything else.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "window/ui/ui.h"

namespace burr::app {

enum class Menu { views, all, rack, pieces };

struct MenuItem {
  std::string name, key;
};

struct MenuPressed {
  std::optional<std::size_t> item;
  bool close = false;
};
// Beside the buttons at the left, over whatever is there.
[[nodiscard]] MenuPressed draw_menu(Ui& ui, const std::string& title,
                                    const std::vector<MenuItem>& items);

}  // namespace burr::app
