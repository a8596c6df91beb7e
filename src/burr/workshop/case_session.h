// workshop/case_session.h - what a case wants of a session, [session] in its file, becomes settings.
//
// Thread: any. Errors: one sentence with the file, the line and the field.
#pragma once

#include "burr/base/result.h"
#include "burr/scenario/case.h"
#include "burr/tick/settings.h"

namespace burr::workshop {

// What the case does not name stays. Its tool and its burr are not part of it. Error: a field that the
// table of settings (tick/setting_table.h) does not have, or does not take.
[[nodiscard]] Status take_session(const scenario::Case& work, tick::ServoSettings& servo);
// The error alone, for who needs no settings.
[[nodiscard]] Status check_session(const scenario::Case& work);

}  // namespace burr::workshop
