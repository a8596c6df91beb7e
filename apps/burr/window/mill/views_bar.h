// apps/burr/window/mill/views_bar.h - the buttons of the four views, and of the microscope's
// magnification.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include <optional>

#include "window/mill/work_views.h"
#include "window/ui/ui.h"

namespace burr::app {

struct ViewsBar {
  std::optional<ViewKind> view;  // was pressed
  int magnify = 0;               // -1, 1: was pressed
  int refocus = 0;               // -1 nearer, 1 farther: was pressed
};
// field: height of the microscope's picture; beyond: how far beyond its target it is sharp, nullopt
// without depth of field [m]
[[nodiscard]] ViewsBar draw_views_bar(Ui& ui, ViewKind kind, double field,
                                      const std::optional<double>& beyond);

}  // namespace burr::app
