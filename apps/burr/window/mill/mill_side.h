// apps/burr/window/mill/mill_side.h - the panel beside the tools on the page for milling: which of
// its leaves is open (the task of the case, its steps, the structures), and what is clicked there.
//
// Thread: main; draw() between Ui::begin() and Ui::draw().
#pragma once

#include "burr/record/diary.h"
#include "window/mill/mill_case.h"
#include "window/mill/mill_names.h"
#include "window/mill/mill_site.h"
#include "window/mill/mill_view.h"
#include "window/mill/side_panel.h"

namespace burr::app {

class MillSide {
 public:
  MillSide(const MillSite& site, MillCase& work_case, MillView& view, MillNames& names);

  void show_task();  // the task, the steps, nothing
  void show_structures();
  [[nodiscard]] Leaf leaf() const { return leaf_; }
  // The first bone is gone, so the task has been read; a key shows it again.
  void leave_task();
  // What of it helps the user now, for the recording.
  void tell(record::Sight& sight) const;

  void draw(Ui& ui);
  [[nodiscard]] float right() const;  // its right edge, or that of the tools [points]

 private:
  void draw_structures_leaf(Ui& ui);

  const WindowOptions& options_;
  MillNotes& notes_;
  MillOver& over_;
  MillCase& case_;
  MillView& view_;
  MillNames& names_;
  Leaf leaf_;
  bool task_read_ = false;
};

}  // namespace burr::app
