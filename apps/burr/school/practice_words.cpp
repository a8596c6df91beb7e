#include "school/practice_words.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "burr/base/printable.h"

namespace burr::app {
namespace {

const char* because(school::Trend trend) {
  switch (trend) {
    case school::Trend::rising:
      return "the curve still rises";
    case school::Trend::flat:
      return "the curve is flat";
    case school::Trend::falling:
      return "the curve falls";
    case school::Trend::unknown:
      break;
  }
  return "there are too few sessions for a curve";
}

}  // namespace

nlohmann::ordered_json practice_json(const school::CasePractice& one, std::int64_t today) {
  nlohmann::ordered_json out = {{"case", one.case_name},
                                {"finished", one.finished},
                                {"unguided", one.unguided},
                                {"last_day", school::date_of(one.last_day)},
                                {"on_last_day", one.on_last_day},
                                {"needed", school::kFewestForProposal},
                                {"next", nullptr}};
  if (one.next)
    out["next"] = {{"day", school::date_of(one.next->day)},
                   {"in_days", one.next->day - today},
                   {"due", one.next->day <= today},
                   {"sessions", one.next->sessions},
                   {"trend", school::word_of(one.next->trend)},
                   {"other_bone", one.next->other_bone}};
  return out;
}

std::string practice_line(const school::CasePractice& one, std::int64_t today) {
  const std::string name = base::printable(one.case_name);
  if (!one.next)
    return fmt::format("{}: no proposal, {} of {} finished sessions", name, one.finished,
                       school::kFewestForProposal);
  return fmt::format(
      "{}: {} {} on, at most {} a day, because {}{}", name,
      one.next->day <= today ? "due, from" : "from", school::date_of(one.next->day),
      one.next->sessions == 1 ? "1 session" : fmt::format("{} sessions", one.next->sessions),
      because(one.next->trend), one.next->other_bone ? "; better on another bone" : "");
}

}  // namespace burr::app
