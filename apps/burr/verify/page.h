// apps/burr/verify/page.h - the report as one HTML file that needs nothing beside it: plots are
// SVG.
#pragma once

#include <string>

#include "shared/html_page.h"
#include "verify_report.h"

namespace burr::app {

[[nodiscard]] std::string page(const VerifyReport& report);

// One plot as SVG; its axes stand side by side.
[[nodiscard]] std::string svg(const Plot& plot);

}  // namespace burr::app
