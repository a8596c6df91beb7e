// base/table_cell.h - a text as a cell of a table (CSV) that a spreadsheet opens.
//
//     line += "," + base::table_cell(name);
//
// A spreadsheet runs a cell that begins like a formula (=, +, -, @, a tab, a line's end). Such a text gets an
// apostrophe before it, which spreadsheets do not show; a number stays a number. Whoever reads a table takes the
// apostrophe away again with text_of_cell(): any text comes back as it was. Every table that burr writes takes its
// cells from here, but those that hold numbers and words of burr alone. Thread: any.
#pragma once

#include <string>
#include <string_view>

namespace burr::base {

// With the apostrophe where it is needed, not in quotes: for writers that put quotes themselves.
[[nodiscard]] std::string guarded_cell(std::string_view text);
// The cell as it stands in the file: guarded, and in quotes where it needs them.
[[nodiscard]] std::string table_cell(std::string_view text);
// The text of a cell without its quotes.
[[nodiscard]] std::string text_of_cell(std::string_view cell);

}  // namespace burr::base
