// apps/burr/school/learner_export.h - `burr learner export`: all that is known of one learner, as tables and reports in a
// .zip; or tables of all learners, without names.
//
// Thread: main. Errors: one sentence.
#pragma once

#include "burr/base/result.h"
#include "school/learner_store.h"

namespace burr::app {

[[nodiscard]] Status export_learners(const LearnerOptions& options);

}  // namespace burr::app
