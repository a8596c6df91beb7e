// school/study/table.h - a small table with named columns, from a CSV file: marks, judgements, attempts.
//
//     const auto table = study::read_table("marks.csv", {"person", "mark"}, {"bone"});
//     table->rows[0][0]          the person of the first row
//
// RFC 4180: a field may stand in quotes, which are then doubled inside. Blank lines and lines that begin with # are left
// out. Columns may stand in any order; others are ignored. Thread: any.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"

namespace burr::school::study {

struct Table {
  std::string file;                  // without its folder
  std::vector<std::string> columns;  // needed ones, then optional ones
  std::vector<std::vector<std::string>>
      rows;                // a field for each of `columns`; an optional column that is missing: ""
  std::vector<int> lines;  // of each row in the file, the first line is 1

  // The field as a number; an Error names file, line and column.
  [[nodiscard]] Result<double> number(std::size_t row, std::size_t column) const;
  // The same for a number from `least` to `most`.
  [[nodiscard]] Result<double> number(std::size_t row, std::size_t column, double least,
                                      double most) const;
  // "1", "yes", "true", "met": true; "0", "no", "false", "unmet": false.
  [[nodiscard]] Result<bool> flag(std::size_t row, std::size_t column) const;
  [[nodiscard]] std::string place(std::size_t row,
                                  std::size_t column) const;  // "marks.csv: line 7: column mark"
};

// Error: a needed column is missing, or a column appears twice, or a row has another number of fields than the head.
[[nodiscard]] Result<Table> parse_table(std::string_view text, const std::string& file,
                                        const std::vector<std::string>& needed,
                                        const std::vector<std::string>& optional = {});
[[nodiscard]] Result<Table> read_table(const std::string& path,
                                       const std::vector<std::string>& needed,
                                       const std::vector<std::string>& optional = {});

}  // namespace burr::school::study
