// apps/burr/school/learner_sessions.h - `burr learner enter` and `burr learner take-in`: recordings become sessions of a
// learner in the store.
//
// Thread: main. Errors: one sentence.
#pragma once

#include <string>

#include "burr/base/result.h"
#include "school/learner_store.h"

namespace burr::app {

// Whether a session counts, and why not; standing: as school/seal.h has it.
[[nodiscard]] std::string standing_words(const std::string& standing);

[[nodiscard]] Status enter_session(const LearnerOptions& options);
// Also scores recordings; the window starts this beside itself.
[[nodiscard]] Status take_in_sessions(const LearnerOptions& options);

}  // namespace burr::app
