// report/time_line.h - force, nearest distance, burr, steps and events of a session over
// one axis of time.
//
// Thread: main.
#pragma once

#include "burr/report/report.h"
#include "burr/report/scored.h"

namespace burr::report {

[[nodiscard]] ReportLine time_line_of(const Scored& scored);

// As SVG, seconds: of the axis, so that two sessions can stand one over the other.
[[nodiscard]] std::string svg_of(const ReportLine& line, double seconds);

}  // namespace burr::report
