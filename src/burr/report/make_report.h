// report/make_report.h - scores become reports.
//
//     Report report = report_on(mine, {.self = marks, .beside = &expert}, progress());
//
// The same score gives the same report, byte for byte. A report holds no date, no path and no name.
// Thread: main; without pictures any. Cost: that of the pictures. Errors: of the pictures; Trouble::interrupted.
#pragma once

#include <cstddef>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/report/report.h"
#include "burr/report/scored.h"
#include "burr/report/self_marks.h"

namespace burr::report {

struct ReportSettings {
  SelfMarks self = {};
  Scored* beside = nullptr;        // an expert's session; its bone moves, as that of the session
  std::size_t most_pictures = 12;  // of the session: four sides, the others are evidence; 0: none
  std::string rubric = {};         // as the user named it, for the command; empty: the built-in one
};
[[nodiscard]] Result<Report> report_on(Scored& scored, const ReportSettings& settings,
                                       Progress& progress);

// Error, Trouble::usage: they were judged by different rubrics.
[[nodiscard]] Status comparable(const Scored& a, const Scored& b);

// Two sessions on the same case, neither of them the measure of the other.
[[nodiscard]] Result<Report> comparison(Scored& a, Scored& b, const ReportSettings& settings,
                                        Progress& progress);

}  // namespace burr::report
