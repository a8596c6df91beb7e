// apps/burr/window/mill/task_panel.h - what is to be done, beside the tools: title, description, targets and
// what must not be cut, as the case states them.
//
// It lies behind everything and takes no mouse. Thread: main, between Ui::begin() and draw().
#pragma once

#include "burr/scenario/case.h"
#include "window/shell/ui.h"

namespace burr::app {

void draw_task(const Ui& ui, const scenario::Case& work);

}  // namespace burr::app
