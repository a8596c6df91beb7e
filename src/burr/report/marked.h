// report/marked.h - a recording becomes a report without pictures: what the page at the end
// of a case shows.
//
// The marks are those of `burr score`, by the rubric of the case; the learner's own marks are
// those in the recording. Thread: any, one at a time for each recording. Cost: that of scored.h; texts
// are in the language that is spoken then. Errors: those of scored.h; Trouble::interrupted.
#pragma once

#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/report/report.h"
#include "burr/scenario/recipe.h"

namespace burr::report {

// rubric: empty for the built-in one of the recording's case. volume: where the bone is, if burr does
// not find it.
[[nodiscard]] Result<Report> marked(const std::string& recording, const std::string& rubric,
                                    const scenario::BoneRecipe& volume, Progress& progress);

}  // namespace burr::report
