// apps/burr/school/practice_words.h - the proposal when to practise again, as a line of a terminal and as JSON; one place,
// so that `burr learner` and the instructor's page say the same.
//
// today: school::day_here(). Thread: any.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "burr/school/practice.h"

namespace burr::app {

// {"case", "finished", "unguided", "last_day", "on_last_day", "needed", "next": null or {"day", "in_days", "due", "sessions",
// "trend", "other_bone"}}; days as "2026-12-03"; in_days: from today, below 0 where the day has passed.
[[nodiscard]] nlohmann::ordered_json practice_json(const school::CasePractice& one,
                                                   std::int64_t today);

// "tooth: from 2026-12-03 on, at most 2 sessions a day, because the curve still rises".
[[nodiscard]] std::string practice_line(const school::CasePractice& one, std::int64_t today);

}  // namespace burr::app
