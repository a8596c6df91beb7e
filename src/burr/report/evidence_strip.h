// report/evidence_strip.h - when what an item judges happened: a short line of time, for every
// item of a report, also for one that has no picture and for one that could not be judged.
//
//     above the line    as it should be: a small burr near, a long stroke, coolant on
//     below it          not as it should be
//     on it             neither: when the burr cut in the region, when it was nearest
//
// It shows what the measure looked at, at 100 Hz, and decides nothing. Thread: any. Cost: below a
// millisecond for most items.
#pragma once

#include <cstddef>
#include <string>

#include "burr/report/report.h"
#include "burr/report/scored.h"

namespace burr::report {

// Of item n of the rubric.
[[nodiscard]] ReportStrip strip_of(const Scored& scored, std::size_t n);

// For a page.
[[nodiscard]] std::string strip_html(const ReportStrip& strip);

}  // namespace burr::report
