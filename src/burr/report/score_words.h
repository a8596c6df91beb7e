// report/score_words.h - a score in words and in JSON.
//
// No grade, no pass: items, safety, totals, and "default" beside every threshold that nobody has
// compared with people.
#pragma once

#include <string>

#include "burr/scoring/outcome.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/score.h"

namespace burr::report {

// "  not met           sinus.identified   share seen through thin bone 12 %, required at least 60 % (default)"
[[nodiscard]] std::string item_line(const scoring::Item& item, const scoring::Outcome& outcome);

// "product: 7 of 25 items met". Points follow only where every item of the part is calibrated; or why
// there are none. Empty: the rubric has no item of this part.
[[nodiscard]] std::string total_line(const scoring::Rubric& rubric, scoring::Part part,
                                     const scoring::Total& total);

// Why the work has no mark (scoring/whole_work.h), in one line; empty: it may have one.
[[nodiscard]] std::string no_mark_line(const scoring::Score& score);

// How many items of safety (gates) are met and which are not, in one line; empty: the rubric has none.
[[nodiscard]] std::string safety_line(const scoring::Rubric& rubric, const scoring::Score& score);

// All that is known about one item, several lines. rate_hz: of the recording, for its moments.
[[nodiscard]] std::string explanation(const scoring::Item& item, const scoring::Outcome& outcome,
                                      double rate_hz);

// All of it as one JSON object.
[[nodiscard]] std::string score_json(const scoring::Rubric& rubric, const scoring::Score& score);

}  // namespace burr::report
