// scoring/step_done.h - has a step of a case reached what its `done` asks for: yes or no, no mark.
//
//     if (Status fits = check_done(lesson, "my.toml"); !fits) return fits;   // once, at the start
//     const auto reached = step_done(*lesson.step("antrum"), lesson, before, now, progress);
//
// The measures are those of a rubric that need no recording. Takes up to seconds: call it on a
// thread of its own, with bones that nobody changes. Thread: any, one at a time.
#pragma once

#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/bone.h"

namespace burr::scoring {

// Every `done` must name a measure of the bone, with what that measure needs and with its limits.
// file: for errors, which are one sentence with file, line, field and remedy.
[[nodiscard]] Status check_done(const scenario::CaseLesson& lesson, const std::string& file);

// False: not yet, not assessable on this bone, or the step has no `done`. The landmarks of the
// lesson are placed, and check_done() found nothing. Error: interrupted.
[[nodiscard]] Result<bool> step_done(const scenario::Step& step, const scenario::CaseLesson& lesson,
                                     const volume::Bone& before, const volume::Bone& now,
                                     Progress& progress);

}  // namespace burr::scoring
