// apps/burr/window/mill/task_panel.h - the task of the case, beside the tools: title, description,
// targets, and what must not be cut.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include "burr/scenario/case.h"
#include "burr/scenario/lesson.h"
#include "window/ui/ui.h"

namespace burr::app {

// lesson: of the case, for title and description in the user's language; nullptr: in English. True:
// it was clicked, and goes away.
[[nodiscard]] bool draw_task(Ui& ui, const scenario::Case& work,
                             const scenario::CaseLesson* lesson);

}  // namespace burr::app
