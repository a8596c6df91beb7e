// apps/burr/school/study_source.h - where `burr study` takes its table from: a file, or the store of learners.
//
// Thread: as the Store. Errors: one sentence.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/decisions.h"
#include "burr/school/study/table.h"

namespace burr::app {

struct StudySource {
  std::string path;                    // a table
  std::string store;                   // a file, or postgresql://...; with `from_store`
  bool from_store = false;             // --store was given
  std::string rubric;                  // of the store: a name or a hash; empty: the only one
  std::string part = "product";        // of a score: "product", "process"
  std::vector<std::string> low, high;  // levels of learners
  std::string out;                     // F.csv: the table that was used; empty: none
};

enum class Asked { marks, ratings, groups };
// The same columns from both, so that both give the same figures.
[[nodiscard]] Result<school::study::Table> table_for(const StudySource& source, Asked asked,
                                                     const std::vector<std::string>& needed,
                                                     const std::vector<std::string>& optional = {});

// Of each learner of the store the last mark without guidance.
[[nodiscard]] Result<std::vector<double>> last_marks(const StudySource& source);

// How much each item of the part counts, so that all together are 100 points. Error: judged: items that are not those of
// the part.
[[nodiscard]] Result<std::vector<double>> points_of_items(const StudySource& source,
                                                          const std::vector<std::string>& judged);

// The cut becomes a standard of the centre. standard: part and rubric are those of the source. Returns its id.
[[nodiscard]] Result<std::string> keep_standard(const StudySource& source,
                                                school::Standard standard);

}  // namespace burr::app
