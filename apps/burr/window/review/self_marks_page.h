// apps/burr/window/review/self_marks_page.h - the learner marks his own work, item by item, before he
// sees what the machine found.
//
//     SelfMarksPage page(questions_on(work));
//     each frame:   if (page.draw(ui) == SelfMarksPage::Pressed::finished) ... page.marks()
//
// Nobody has to mark anything. Thread: main, between Ui::begin() and draw().
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/report/questions.h"
#include "window/ui/ui.h"

namespace burr::app {

class SelfMarksPage {
 public:
  enum class Pressed { nothing, finished, skipped };
  // By the id of the item; "met", "unmet" or "unknown", as the recording has it.
  using Marks = std::vector<std::pair<std::string, std::string>>;

  explicit SelfMarksPage(std::vector<report::QuestionPart> parts);
  [[nodiscard]] Pressed draw(Ui& ui);
  // Only what was marked.
  [[nodiscard]] Marks marks() const;

 private:
  enum class Mark { none, met, unmet, unknown };
  [[nodiscard]] std::size_t count() const;
  void part(Ui& ui, std::size_t p, float wide);
  void row(Ui& ui, const report::Question& question, Mark& mark, float wide);

  std::vector<report::QuestionPart> parts_;
  std::vector<std::vector<Mark>> marks_;  // as parts_
};

}  // namespace burr::app
