// scenario/read_lesson.h - reads the tables of format 2 of a case. For use of this room only.
//
// Thread: any.
#pragma once

#include "burr/scenario/lesson.h"
#include "burr/scenario/toml_reader.h"

namespace burr::scenario {

// Everything but the fields of format 1, which parse_case() reads. Checks that names that refer to
// each other are there, but not those of landmarks, which the bone may have.
void read_lesson(Reader& reader, CaseLesson& out);

// read_landmarks.cpp: [[landmark]] and [[region]]
void read_landmarks(Reader& reader, CaseLesson& out);
void read_regions(Reader& reader, CaseLesson& out);
void read_pieces(Reader& reader, CaseLesson& out);

// check_lesson.cpp: names that are given twice, and names that nothing has
void check_names(Reader& reader, const CaseLesson& lesson);

}  // namespace burr::scenario
