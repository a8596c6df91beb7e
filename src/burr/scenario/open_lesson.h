// scenario/open_lesson.h - the lesson in the text of a case.
//
// Thread: any. Errors: one sentence with file, line, field and remedy.
#pragma once

#include <string_view>

#include "burr/base/result.h"
#include "burr/scenario/case.h"
#include "burr/scenario/lesson.h"

namespace burr::scenario {

// parse_case() has checked it already.
[[nodiscard]] Result<CaseLesson> lesson_of(const Case& work);
// file: its name for errors.
[[nodiscard]] Result<CaseLesson> parse_lesson(std::string_view text, std::string_view file);

}  // namespace burr::scenario
