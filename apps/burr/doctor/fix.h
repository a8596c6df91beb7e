// apps/burr/doctor/fix.h - writes the udev rule that lets the person at the computer open haptic
// devices. Asks first; the file's old content is kept beside it as .old.
//
// Thread: main.
#pragma once

#include <functional>
#include <string>

#include "burr/base/result.h"
#include "doctor/doctor_checks.h"

namespace burr::app {

enum class Answer { yes, no, nobody };  // nobody: there is no one to ask

// ask: is shown the new content of the file. Returns what was done and what to do next. Error:
// there is nobody to ask, or the file cannot be written; says how to do it.
[[nodiscard]] Result<std::string> write_rules(const System& system,
                                              const std::function<Answer(const std::string&)>& ask);

}  // namespace burr::app
