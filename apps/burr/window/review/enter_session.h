// apps/burr/window/review/enter_session.h - a session of a learner goes into the store of learners, beside the window: a
// small file says that its recording waits, and `burr learner take-in` scores it in a process of its own. So the window
// never waits for a store, and what is not done when the computer is switched off is done at the next start.
//
// Thread: main.
#pragma once

#include <memory>
#include <string>

#include "burr/record/identity.h"
#include "burr/scenario/case.h"
#include "burr/school/station_sealer.h"
#include "window/ui/desk.h"

namespace burr::app {

// Who seals the session, where this computer is an enrolled station. nullptr: nobody; it has no key (`burr station
// enrol`), or the session goes into no store. The start page shows a key that cannot be used.
[[nodiscard]] std::shared_ptr<school::StationSealer> sealer_for(Desk& desk,
                                                                const record::Identity& identity,
                                                                const scenario::Case* work);
// After the recording is finished: why it has no seal, if it has none.
void tell_of_seal(Desk& desk, const std::shared_ptr<school::StationSealer>& sealer);

// When the recording begins: a session that is killed comes in at the next start, as unfinished.
void session_begins(Desk& desk, const std::string& recording, const record::Identity& identity,
                    const scenario::Case* work);

// recording: finished, or as much as the disk took. kept: false if there is no such file, because nothing was done. Without
// a learner, a case with a rubric, or a store that is wanted (school::is_wanted) it does nothing. The start page shows what
// went wrong.
void session_ended(Desk& desk, const std::string& recording, const record::Identity& identity,
                   const scenario::Case* work, bool kept);

// What waited since another start. Call it once, at the start.
void enter_waiting(Desk& desk);

}  // namespace burr::app
