// apps/burr/school/session_of.h - a recording becomes what the store of learners keeps of a session: scores by the
// rubric of its case, items with their evidence, the learner's own marks, some measures.
//
// Thread: any. Cost: seconds, as report/scored.h. Errors: one sentence.
#pragma once

#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/report/scored.h"
#include "burr/scenario/recipe.h"
#include "burr/school/session_record.h"

namespace burr::app {

// Before it is believed the recording is simulated again, as by `burr replay --check`, and its seal is read; the store
// checks the seal itself (school/enrolled.h).
// learner: whose the session is; empty: as the recording says. rubric: a name or a file; empty: the built-in one of its
// case. Error, Trouble::usage: the recording says another learner, or none. Trouble::interrupted: it is
// still being written.
[[nodiscard]] Result<school::SessionRecord> session_of(const std::string& recording,
                                                       const std::string& learner,
                                                       const std::string& rubric,
                                                       const scenario::BoneRecipe& volume,
                                                       Progress& progress);

// Without file and date.
[[nodiscard]] school::SessionRecord record_of(const report::Scored& scored);

}  // namespace burr::app
