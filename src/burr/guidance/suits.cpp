#include "burr/guidance/suits.h"

#include "burr/scenario/rack.h"
#include "burr/words/words.h"

namespace burr::guidance {

using words::say;
using words::spoken;
using words::Word;
using words::word;

std::string suits(const scenario::Step& step) {
  if (const scenario::RackTool* tool = scenario::built_in_rack().find(step.tool); tool != nullptr)
    return tool->title.in(spoken().code);
  std::string text;
  if (step.kind)
    text = word(*step.kind == tool::BurrKind::diamond ? Word::steps_diamond : Word::steps_cutting);
  if (step.diameter) {
    if (!text.empty()) text += ", ";
    text += say(Word::steps_sizes, 1e3 * step.diameter->first, 1e3 * step.diameter->second);
  }
  return text;
}

}  // namespace burr::guidance
