#include "burr/report/questions.h"

#include <algorithm>
#include <utility>

#include "burr/scoring/rubric.h"
#include "burr/words/words.h"

namespace burr::report {

using words::spoken;
using words::Word;
using words::word;

std::string rubric_of(const scenario::Case& work) {
  if (!work.rubric.empty()) return work.rubric == scenario::kOwnFile ? "" : work.rubric;
  const std::vector<std::string> names = scoring::built_in_rubrics();
  return std::find(names.begin(), names.end(), work.name) != names.end() ? work.name : "";
}

std::vector<QuestionPart> questions_on(const scenario::Case& work) {
  const std::string name = rubric_of(work);
  if (name.empty()) return {};
  const auto rubric = scoring::read_rubric(name);
  if (!rubric) return {};
  std::vector<QuestionPart> parts;
  for (const auto& [part, title] : {std::pair{scoring::Part::product, Word::report_product},
                                    std::pair{scoring::Part::process, Word::report_process}}) {
    QuestionPart one = {word(title), {}};
    for (const scoring::Item& item : rubric->items)
      if (item.part == part) one.items.push_back({item.id, item.say.in(spoken().code), item.gate});
    if (!one.items.empty()) parts.push_back(std::move(one));
  }
  return parts;
}

}  // namespace burr::report
