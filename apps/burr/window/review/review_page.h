// apps/burr/window/review/review_page.h - the page at the end of a case: what the machine found, beside
// the learner's own marks. Safety apart; no grade, no pass, no total without its items.
//
// Takes plain data and says what was pressed. Thread: main, between Ui::begin() and draw().
#pragma once

#include <optional>
#include <string>

#include "burr/report/report.h"
#include "window/ui/ui.h"

namespace burr::app {

struct ReviewState {
  std::string title;                       // of the case
  const report::Report* report = nullptr;  // nullptr: not ready, or not to be shown
  double progress = 0;                     // of the marks, while there is no report  [0..1]
  std::string trouble;                     // why there are no marks; empty: none
  bool exam = false;                       // the examiner has the marks
  bool repeats = false;                    // the case can be done again
  bool writes = false;                     // the full report is being written
  std::string note;                        // of the full report
};

struct ReviewPressed {
  bool close = false, again = false, full = false;
  const report::ReportItem* item = nullptr;  // its evidence is to be seen
};

[[nodiscard]] ReviewPressed draw_review(Ui& ui, const ReviewState& state);

}  // namespace burr::app
