// apps/burr/school/learner_sessions.h - `burr learner enter` and `burr learner take-in`: recordings become sessions of a
// learner in the store.
//
// Thread: main. Errors: one sentence.
#pragma once

#include "burr/base/result.h"
#include "school/learner_store.h"

namespace burr::app {

[[nodiscard]] Status enter_session(const LearnerOptions& options);
// Also scores recordings; the window starts this beside itself.
[[nodiscard]] Status take_in_sessions(const LearnerOptions& options);

}  // namespace burr::app
