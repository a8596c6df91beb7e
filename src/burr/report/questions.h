// report/questions.h - the questions of the page where the learner marks his own work: the
// items of the rubric of his case.
//
// Thread: any. Cost: the rubric is read.
#pragma once

#include <string>
#include <vector>

#include "burr/scenario/case.h"

namespace burr::report {

struct Question {
  std::string id, text;  // of the item; text: what was to be done
  bool gate = false;
};

// The items of one part: product or process.
struct QuestionPart {
  std::string title;
  std::vector<Question> items;
};

// What scoring::read_rubric() reads for this case: its own file, or the built-in rubric of its name.
// Empty: there is none, or the case is from a recording, which does not hold the place of a file.
[[nodiscard]] std::string rubric_of(const scenario::Case& work);

// Empty: there is no rubric for this case.
[[nodiscard]] std::vector<QuestionPart> questions_on(const scenario::Case& work);

}  // namespace burr::report
