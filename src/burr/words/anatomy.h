// words/anatomy.h - the names of structures in the language of the user.
//
//     anatomy("facial nerve")     "nervus facialis" in Swedish
//
// The titles that a case gives its structures come first. burr itself knows the tissues and
// structures of the bones made from formulas and of its own cases. Any other name comes back as the
// file has it, made safe to print. Thread: main.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "burr/scenario/lesson.h"

namespace burr::words {

[[nodiscard]] std::string anatomy(std::string_view name);

// From now on the titles of this case's structures hold, for the structures and for those tissues of
// theirs that burr does not know; nullptr: those of no case.
void take_titles_of(const scenario::CaseLesson* lesson);

// The title of a place of that case, which is a landmark or a region; without one as anatomy().
[[nodiscard]] std::string place_name(std::string_view name);

// All of them, "facial nerve, dura".
[[nodiscard]] std::string anatomy_list(const std::vector<std::string>& names);

}  // namespace burr::words
