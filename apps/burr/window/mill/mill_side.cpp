#include "window/mill/mill_side.h"

#include <utility>

#include "shared/word_names.h"
#include "window/mill/task_panel.h"

namespace burr::app {

MillSide::MillSide(const MillSite& site, MillCase& work_case, MillView& view, MillNames& names)
    : options_(site.options),
      notes_(site.notes),
      over_(site.over),
      case_(work_case),
      view_(view),
      names_(names),
      leaf_(site.options.work_case ? Leaf::task : Leaf::none) {}

void MillSide::show_task() {
  if (!options_.work_case) return notes_.note(word(Word::task_none));
  leaf_ = leaf_ == Leaf::task && case_.steps_offered()  ? Leaf::steps
          : leaf_ == Leaf::task || leaf_ == Leaf::steps ? Leaf::none
                                                        : Leaf::task;
}

void MillSide::show_structures() {
  if (!case_.names_offered()) return case_.say_refused();
  leaf_ = leaf_ == Leaf::structures ? Leaf::none : Leaf::structures;
}

void MillSide::leave_task() {
  if (std::exchange(task_read_, true) || leaf_ != Leaf::task) return;
  const bool steps = case_.steps_offered() && options_.allowed.steps == workshop::Offer::always;
  leaf_ = steps ? Leaf::steps : Leaf::none;
}

void MillSide::tell(record::Sight& sight) const {
  if (!over_.panels) return;
  if (leaf_ == Leaf::task && options_.work_case) sight.helps.insert("task");
  if (leaf_ == Leaf::steps && case_.steps_offered()) sight.helps.insert("steps");
  if (leaf_ == Leaf::structures || !names_.pins().empty()) sight.helps.insert("names");
}

float MillSide::right() const {
  return leaf_ == Leaf::none ? kSideLeft : kSideLeft + kSideWide + 10;
}

void MillSide::draw(Ui& ui) {
  const bool task = options_.work_case.has_value(), steps = case_.steps_offered();
  if (leaf_ == Leaf::task && !task) leaf_ = Leaf::none;
  if (leaf_ == Leaf::steps && !steps) leaf_ = Leaf::none;
  if (leaf_ == Leaf::structures && !case_.names_offered()) leaf_ = Leaf::none;
  if (leaf_ == Leaf::none || over_.menu) return;  // the menu takes its place
  if (const auto pressed = draw_side_tabs(ui, leaf_, task, steps, case_.names_offered()))
    leaf_ = *pressed;
  switch (leaf_) {
    case Leaf::none:
      break;
    case Leaf::task:
      if (draw_task(ui, *options_.work_case, options_.lesson ? &*options_.lesson : nullptr))
        leaf_ = Leaf::none;
      break;
    case Leaf::steps:
      case_.draw_steps_panel(ui);
      break;
    case Leaf::structures:
      draw_structures_leaf(ui);
      break;
  }
}

void MillSide::draw_structures_leaf(Ui& ui) {
  const StructuresPressed pressed =
      draw_structures(ui, view_.structures(), names_.pins(), options_.allowed.distance);
  if (pressed.toggle) {
    view_.structures().toggle(*pressed.toggle);
    view_.show_labels(view_.labels());
  }
  if (pressed.pin) names_.pin(*pressed.pin);
}

}  // namespace burr::app
