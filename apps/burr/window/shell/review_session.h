// apps/burr/window/shell/review_session.h - the review of a session, with the page that plays recordings behind it: the
// learner looks at the evidence of an item. Neither page knows the other.
//
// Thread: main.
#pragma once

#include "burr/base/result.h"
#include "window/review/review.h"
#include "window/ui/closed.h"
#include "window/ui/desk.h"

namespace burr::app {

// As review(); options.show is set here.
[[nodiscard]] Result<Closed> review_session(Desk& desk, ReviewOptions options);

}  // namespace burr::app
