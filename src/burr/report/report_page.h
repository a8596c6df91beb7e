// report/report_page.h - a report as one HTML page: nothing beside it, no script, no
// address of the net; prints on A4.
//
// Well-formed as XML too, so that any tool reads it. Every text is escaped. Thread: any.
#pragma once

#include <string>

#include "burr/report/report.h"

namespace burr::report {

[[nodiscard]] std::string page_of(const Report& report);

}  // namespace burr::report
