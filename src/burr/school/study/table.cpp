#include "burr/school/study/table.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "burr/base/printable.h"
#include "burr/base/table_cell.h"
#include "burr/base/text_file.h"
#include "burr/base/trimmed.h"

namespace burr::school::study {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{64} << 20;  // [byte]

// The records of a text: fields, and the line on which each record begins.
struct Records {
  std::vector<std::vector<std::string>> fields;
  std::vector<int> lines;
};

std::string unquoted(std::string_view raw) {
  const std::string_view text = base::trimmed(raw);
  if (text.size() < 2 || text.front() != '"' || text.back() != '"') return base::text_of_cell(text);
  std::string out;
  for (std::size_t n = 1; n + 1 < text.size(); ++n) {
    out += text[n];
    if (text[n] == '"' && text[n + 1] == '"' && n + 2 < text.size()) ++n;
  }
  return base::text_of_cell(out);
}

Result<Records> records_of(std::string_view text, const std::string& file) {
  Records out;
  int line = 1;
  std::size_t at = 0;
  while (at < text.size()) {
    const int begins = line;
    std::vector<std::string> fields;
    const std::size_t start = at;
    std::size_t from = at;
    bool quoted = false, ended = false;
    for (; !ended; ++at) {
      const bool end_of_text = at == text.size();
      const char c = end_of_text ? '\n' : text[at];
      if (end_of_text && quoted)
        return error(fmt::format("{}: line {}: a quote is opened and not closed", file, begins));
      if (c == '"') quoted = !quoted;
      if (c == '\n' && !end_of_text) ++line;
      if (quoted || (c != ',' && c != '\n')) continue;
      fields.push_back(unquoted(text.substr(from, at - from)));
      from = at + 1;
      ended = c == '\n';
    }
    const bool blank = fields.size() == 1 && fields.front().empty();
    const bool remark = base::trimmed(text.substr(start)).starts_with('#');  // not in quotes
    if (blank || remark) continue;
    out.fields.push_back(std::move(fields));
    out.lines.push_back(begins);
  }
  return out;
}

// Where each wanted column is; -1: nowhere.
Result<std::vector<int>> places_of(const std::vector<std::string>& head, const std::string& where,
                                   const std::vector<std::string>& wanted, std::size_t needed) {
  std::vector<int> places;
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    const auto times = std::count(head.begin(), head.end(), wanted[n]);
    if (times > 1)
      return error(fmt::format("{}: column {} appears twice; keep one", where, wanted[n]));
    if (times == 0 && n < needed)
      return error(fmt::format(
          "{}: column {} is missing; the first line must name the columns {}", where, wanted[n],
          base::list_of(std::vector<std::string>(
              wanted.begin(), wanted.begin() + static_cast<std::ptrdiff_t>(needed)))));
    const auto found = std::find(head.begin(), head.end(), wanted[n]);
    places.push_back(found == head.end() ? -1 : static_cast<int>(found - head.begin()));
  }
  return places;
}

}  // namespace

std::string Table::place(std::size_t row, std::size_t column) const {
  return fmt::format("{}: line {}: column {}", file, lines[row], columns[column]);
}

Result<double> Table::number(std::size_t row, std::size_t column) const {
  const std::string& text = rows[row][column];
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [last, wrong] = std::from_chars(text.data(), end, value);
  if (text.empty() || wrong != std::errc() || last != end || !std::isfinite(value))
    return error(
        fmt::format("{}: \"{}\" is not a number", place(row, column), base::printable(text)));
  return value;
}

Result<double> Table::number(std::size_t row, std::size_t column, double least, double most) const {
  auto value = number(row, column);
  if (value && (*value < least || *value > most))
    return error(
        fmt::format("{}: {} is not between {} and {}", place(row, column), *value, least, most));
  return value;
}

Result<bool> Table::flag(std::size_t row, std::size_t column) const {
  const std::string& text = rows[row][column];
  for (const char* yes : {"1", "yes", "true", "met"})
    if (text == yes) return true;
  for (const char* no : {"0", "no", "false", "unmet"})
    if (text == no) return false;
  return error(
      fmt::format("{}: \"{}\" is neither 1 nor 0", place(row, column), base::printable(text)));
}

Result<Table> parse_table(std::string_view text, const std::string& file,
                          const std::vector<std::string>& needed,
                          const std::vector<std::string>& optional) {
  auto records = records_of(text, file);
  if (!records) return records.error();
  Table table;
  table.file = file;
  table.columns = needed;
  table.columns.insert(table.columns.end(), optional.begin(), optional.end());
  if (records->fields.empty())
    return error(fmt::format("{}: is empty; the first line must name the columns {}", file,
                             base::list_of(needed)));
  const std::vector<std::string>& head = records->fields.front();
  const auto places = places_of(head, fmt::format("{}: line {}", file, records->lines.front()),
                                table.columns, needed.size());
  if (!places) return places.error();
  for (std::size_t n = 1; n < records->fields.size(); ++n) {
    std::vector<std::string>& fields = records->fields[n];
    if (fields.size() != head.size())
      return error(fmt::format("{}: line {}: {} values, but the first line names {} columns", file,
                               records->lines[n], fields.size(), head.size()));
    std::vector<std::string>& row = table.rows.emplace_back();
    for (const int place : *places)
      row.push_back(place < 0 ? "" : fields[static_cast<std::size_t>(place)]);
    table.lines.push_back(records->lines[n]);
  }
  if (table.rows.empty()) return error(fmt::format("{}: has no rows", file));
  return table;
}

Result<Table> read_table(const std::string& path, const std::vector<std::string>& needed,
                         const std::vector<std::string>& optional) {
  const auto text =
      base::text_of_file(path, kLargestFile, "a table of marks; check that this is the right file");
  if (!text) return text.error();
  return parse_table(*text, std::filesystem::path(path).filename().string(), needed, optional);
}

}  // namespace burr::school::study
