// apps/burr/window/review/full_report.h - writes the full report of a recording as a second process
// does it, `burr report`, and shows it with the program that the desktop has for pages.
//
// Thread: main. Nothing waits for the process, and it goes on when this object is gone.
#pragma once

#include <memory>
#include <string>

#include "burr/scenario/recipe.h"
#include "shared/helper_process.h"

namespace burr::app {

class FullReport {
 public:
  // file: the recording; rubric: empty for the built-in one of its case; volume: if the recording does not find its bone; page: the .html to be
  // written, replaced if it is there.
  FullReport(std::string file, std::string rubric, scenario::BoneRecipe volume, std::string page)
      : file_(std::move(file)),
        rubric_(std::move(rubric)),
        volume_(std::move(volume)),
        page_(std::move(page)) {}
  ~FullReport() {
    if (child_) child_->let_go();
  }
  FullReport(const FullReport&) = delete;
  FullReport& operator=(const FullReport&) = delete;
  // Begins to write the page; shows it at once if that was done already.
  void ask();
  // Once a picture. shows: the page that is written now is shown at once.
  void step(bool shows = true);
  [[nodiscard]] bool writes() const { return child_ != nullptr; }
  [[nodiscard]] bool written() const { return written_; }
  [[nodiscard]] const std::string& note() const { return note_; }  // for the user; empty: nothing
  [[nodiscard]] const std::string& page() const { return page_; }

 private:
  void show();
  std::string file_, rubric_;
  scenario::BoneRecipe volume_;
  std::string page_, note_, language_;
  std::unique_ptr<HelperProcess> child_;
  bool written_ = false;
};

}  // namespace burr::app
