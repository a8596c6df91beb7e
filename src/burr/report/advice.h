// report/advice.h - what to do next, which items deserve a picture, and how the learner's
// own marks agree with the machine's.
//
// Thread: any.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "burr/report/report.h"
#include "burr/report/scored.h"
#include "burr/report/self_marks.h"

namespace burr::report {

inline constexpr std::size_t kMostAdvice = 3;

// Items that are not met or borderline, by their number in the rubric. First items of safety, then the
// others that did harm, then those that the learner marked as met, then the rest, the farthest from
// their threshold first. Left out: what it is too early to say, and what only follows from another item.
[[nodiscard]] std::vector<std::size_t> by_importance(const Scored& scored, const SelfMarks& self);

// At most kMostAdvice. After what did harm, if it applies, that too little was removed.
[[nodiscard]] std::vector<ReportAdvice> advice(const Scored& scored, const SelfMarks& self);

[[nodiscard]] std::string agreement(const Scored& scored, const SelfMarks& self);

}  // namespace burr::report
