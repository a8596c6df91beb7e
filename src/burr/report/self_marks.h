// report/self_marks.h - the learner's own marks, made before he saw those of the machine.
//
//     # marks.toml
//     [marks]
//     "sinus.identified" = "met"        # or "not met", "unknown"
//
// Thread: any. Errors: one sentence with file, line, field and remedy.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "burr/base/result.h"
#include "burr/record/player.h"
#include "burr/scoring/rubric.h"

namespace burr::report {

enum class SelfMark { met, unmet, unknown };
using SelfMarks = std::map<std::string, SelfMark, std::less<>>;  // by the id of the item

// The rubric must have every item that the file names.
[[nodiscard]] Result<SelfMarks> read_self_marks(const std::string& path,
                                                const scoring::Rubric& rubric);
[[nodiscard]] Result<SelfMarks> parse_self_marks(std::string_view text, std::string_view file,
                                                 const scoring::Rubric& rubric);

// Those in the recording; of several for one item the last. Items that the rubric lacks are left out.
[[nodiscard]] SelfMarks recorded_self_marks(const record::Player& player,
                                            const scoring::Rubric& rubric);

}  // namespace burr::report
