// report/report_words.h - what the library calls measures, values and verdicts, in the
// user's language.
//
// Thread: any.
#pragma once

#include <string>
#include <string_view>

#include "burr/record/identity.h"
#include "burr/report/report.h"
#include "burr/report/self_marks.h"
#include "burr/scoring/outcome.h"
#include "burr/scoring/rubric.h"

namespace burr::report {

// "share removed"; a text that nobody has translated stays English.
[[nodiscard]] std::string value_word(std::string_view what);
// One sentence on what the measure means; empty for a measure that is not known here.
[[nodiscard]] std::string measure_word(std::string_view measure);
[[nodiscard]] std::string mode_word(record::Mode mode);
// Met, not met, too early to say; or not assessable. The same words in every list of a report.
[[nodiscard]] ReportMark mark_of(const scoring::Outcome& outcome);
[[nodiscard]] ReportMark mark_of(SelfMark mark);
// "share removed 12 % (error 3 %), at least 80 %"; empty: there is no number.
[[nodiscard]] std::string figures_of(const scoring::Outcome& outcome);
// Why it is not met or not assessable, in one sentence; empty: nothing to say.
[[nodiscard]] std::string reason_of(const scoring::Item& item, const scoring::Outcome& outcome);

}  // namespace burr::report
