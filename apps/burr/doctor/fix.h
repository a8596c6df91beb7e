// apps/burr/doctor/fix.h - writes the udev rule that lets whoever sits at the computer open haptic
// devices. Asks first; what the file held is kept beside as .old.
//
// Thread: main.
#pragma once

#include <functional>
#include <string>

#include "burr/base/result.h"
#include "doctor/look.h"

namespace burr::app {

enum class Answer { yes, no, nobody };  // nobody: there is no one to ask

// ask: shown what the file is to hold. Gives back what was done and what to do next. Error: nobody
// to ask, or it cannot be written; says how.
[[nodiscard]] Result<std::string> write_rules(const System& system,
                                              const std::function<Answer(const std::string&)>& ask);

}  // namespace burr::app
