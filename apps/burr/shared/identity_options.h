// apps/burr/shared/identity_options.h - the options that say which session this is: mode, learner,
// attempt.
#pragma once

#include "burr/record/identity.h"

namespace CLI {
class App;
}

namespace burr::app {

// --mode, --learner, --attempt, --accept-label. Errors: of CLI11, one sentence each.
void add_identity_options(CLI::App& command, record::Identity& identity);

}  // namespace burr::app
