// apps/burr/school/decide.h - `burr learner decide`: what the centre's standards propose for a learner, and what a person
// decided.
//
// Thread: as the Store. Errors: one sentence.
#pragma once

#include "burr/base/result.h"
#include "burr/school/decisions.h"
#include "burr/school/store.h"

namespace burr::app {

// asked: learner, and the standard, or none for all.
[[nodiscard]] Status show_proposals(school::Store& store, const school::Decision& asked, bool json);
[[nodiscard]] Status record_decision(school::Store& store, const school::Decision& decision,
                                     bool json);

}  // namespace burr::app
