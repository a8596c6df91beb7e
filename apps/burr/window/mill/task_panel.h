// apps/burr/window/mill/task_panel.h - the task of the case, beside the tools: title, description,
// targets, and what must not be cut.
//
// It is drawn behind everything else and does not react to the mouse. Thread: main, between
// Ui::begin() and draw().
#pragma once

#include "burr/scenario/case.h"
#include "window/shell/ui.h"

namespace burr::app {

void draw_task(const Ui& ui, const scenario::Case& work);

}  // namespace burr::app
