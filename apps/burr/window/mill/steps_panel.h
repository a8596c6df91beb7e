// apps/burr/window/mill/steps_panel.h - the steps of the case, beside the tools: the current one with
// its text and the tool that suits it, and the list of all.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include <cstddef>
#include <optional>

#include "burr/guidance/step_marks.h"
#include "burr/guidance/steps.h"
#include "window/ui/ui.h"

namespace burr::app {

struct StepsPressed {
  bool done = false;               // the current step is done
  bool light = false;              // its target shall be lit, or no longer
  std::optional<std::size_t> row;  // this step shall be the current one, or be opened again
};

struct StepsState {
  bool offers_light = false;                 // there is a button that shows the target
  const guidance::StepMarks* lit = nullptr;  // what is shown now; nullptr: nothing
  std::optional<double> press = {};          // proposed for the step; none: not known [m]
};
[[nodiscard]] StepsPressed draw_steps(Ui& ui, const guidance::Steps& steps,
                                      const StepsState& state);

// The button with which the user declares the work done, at the top right. column: width at the right
// that slices cover [pixel]. True: it was pressed.
[[nodiscard]] bool draw_done_button(Ui& ui, float column);

}  // namespace burr::app
