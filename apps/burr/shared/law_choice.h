// apps/burr/shared/law_choice.h - a custom law, as the user named it.
//
// Thread: any.
#pragma once

#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/tick/own_law.h"

namespace burr::app {

struct LawChoice {
  std::string file, settings;  // empty: none
};

// Opens it, with a state of its own for each call. realtime: it must be fit for a session in real time. No file:
// nullptr.
[[nodiscard]] Result<std::shared_ptr<tick::OwnLaw>> own_law(const LawChoice& law, bool realtime);

}  // namespace burr::app
