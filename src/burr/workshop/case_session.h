// workshop/case_session.h - what a case wants of a session, [session] in its file, becomes settings.
//
// Thread: any. Errors: one sentence with the file and the field.
#pragma once

#include "burr/base/result.h"
#include "burr/scenario/case.h"
#include "burr/tick/settings.h"

namespace burr::workshop {

// What the case does not name stays. Its tool and its burr are not part of it. Error: a method of
// touch or a law of removal that does not exist.
[[nodiscard]] Status take_session(const scenario::Case& work, tick::ServoSettings& servo);

}  // namespace burr::workshop
