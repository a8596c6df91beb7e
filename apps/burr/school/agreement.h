// apps/burr/school/agreement.h - rows of a table become what the figures are made of: for `burr study` and `burr serve`.
//
// Thread: any. Errors: a value that is no number or no mark, with file, line and column.
#pragma once

#include <vector>

#include "burr/base/result.h"
#include "burr/school/study/raters.h"
#include "burr/school/study/reliability.h"
#include "burr/school/study/table.h"

namespace burr::app {

// Columns product, rater, item, met.
[[nodiscard]] Result<std::vector<school::study::Rating>> ratings_of(
    const school::study::Table& table);
// Columns learner, mark, bone, guided: those without guidance.
[[nodiscard]] Result<std::vector<school::study::Mark>> marks_of(const school::study::Table& table);

}  // namespace burr::app
