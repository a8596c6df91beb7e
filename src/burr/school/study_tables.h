// school/study_tables.h - the store as tables for `burr study`: the same columns as the tables that a centre makes itself,
// so the same figures come out of both.
//
//     auto marks = school::marks_table(*store, rubric->hash, "product");
//     for (const auto& row : marks->rows) ...                       // learner, mark, attempt, bone, guided
//
// Of each session the newest score by that rubric counts. Numbers are written so that they are read back to the bit.
// Thread: as the Store. Errors: as school/database.h; Trouble::usage where there is nothing to tell.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/store.h"
#include "burr/school/study/table.h"

namespace burr::school {

// all: also sessions without a seal, which prove nothing; for learning curves. A standard rests on sealed ones alone.
enum class Which { all, sealed };

// learner, mark, attempt, bone, guided; each learner's rows by time. mark: points of the part. bone: the case, by the hash of
// its text. Left out: sessions that were not finished, and those without points.
[[nodiscard]] Result<study::Table> marks_table(Store& store, const std::string& rubric_hash,
                                               const std::string& part, Which which = Which::all);

// group, mark: of each learner of these levels the last sealed mark without guidance, so that everybody counts once.
[[nodiscard]] Result<study::Table> groups_table(Store& store, const std::string& rubric_hash,
                                                const std::string& part,
                                                const std::vector<std::string>& low,
                                                const std::vector<std::string>& high);

// product, rater, item, met: the blinded marks of persons, and those of the machine (rater "machine") of the same sessions.
// Left out: what could not be judged, items of other rubrics or that no person marked, and raters who were forgotten.
[[nodiscard]] Result<study::Table> ratings_table(Store& store, const std::string& rubric_hash);

// As a file that `burr study` reads.
[[nodiscard]] std::string csv_of(const study::Table& table);

}  // namespace burr::school
