#include "batch/manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <unordered_map>
#include <utility>

#include "burr/base/plain_file.h"
#include "burr/base/printable.h"
#include "burr/base/table_cell.h"
#include "burr/scenario/case.h"
#include "burr/workshop/sha256.h"

namespace burr::app {
namespace {

constexpr std::size_t kLongestId = 64;

// One line of the table, which quotes may spread over several of the file.
struct Line {
  std::vector<std::string> cells;
  int number = 0;  // of its first line in the file
};

// Reads a table cell by cell.
class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  // false: there is none left
  Result<bool> next(Line& line) {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      std::string_view whole = text_.substr(at_, end - at_);
      if (whole.ends_with('\r')) whole.remove_suffix(1);
      if (!whole.empty() && whole.front() != '#') break;
      at_ = std::min(end + 1, text_.size());
      ++number_;
    }
    if (at_ >= text_.size()) return false;
    line = {.cells = {}, .number = number_};
    for (bool more = true; more;) {
      std::string cell;
      const auto read = text_[at_] == '"' ? quoted(cell) : plain(cell);
      if (!read) return read.error();
      more = *read;
      line.cells.push_back(base::text_of_cell(cell));
      if (more && at_ >= text_.size()) {  // the file ends with a comma
        line.cells.emplace_back();
        more = false;
      }
    }
    return true;
  }

 private:
  // Behind a cell. true: another one follows
  Result<bool> behind() {
    if (at_ < text_.size() && text_[at_] == ',') {
      ++at_;
      return true;
    }
    if (at_ < text_.size() && text_[at_] == '\r') ++at_;
    if (at_ < text_.size() && text_[at_] != '\n')
      return error(
          fmt::format("{}: line {}: something stands behind the closing quote of a cell; "
                      "put a comma between two cells, and write a quote inside quotes "
                      "twice",
                      file_, number_));
    at_ = std::min(at_ + 1, text_.size());
    ++number_;
    return false;
  }

  Result<bool> plain(std::string& cell) {
    const std::size_t end = std::min(text_.find_first_of(",\r\n", at_), text_.size());
    cell = text_.substr(at_, end - at_);
    at_ = end;
    if (cell.find('"') != std::string::npos)
      return error(
          fmt::format("{}: line {}: a quote stands inside the cell {}; put the whole cell "
                      "in quotes, and the quote twice",
                      file_, number_, base::printable(cell)));
    return behind();
  }

  Result<bool> quoted(std::string& cell) {
    const int began = number_;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\n') ++number_;
      if (text_[at_] != '"') {
        cell += text_[at_];
      } else if (at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
        cell += text_[at_++];
      } else {
        ++at_;
        return behind();
      }
    }
    return error(
        fmt::format("{}: line {}: a quote is opened and never closed; close it", file_, began));
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int number_ = 1;
};

bool is_id(const std::string& id) {
  return !id.empty() && id.size() <= kLongestId && id.front() != '.' &&
         id.find(".json") == std::string::npos && !id.ends_with(".time") &&  // names of files
         std::all_of(id.begin(), id.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '-';
         });
}

Status take_columns(const Line& line, Manifest& manifest) {
  manifest.columns = line.cells;
  manifest.head_line = line.number;
  for (std::size_t n = 0; n < line.cells.size(); ++n) {
    const std::string& name = line.cells[n];
    if (name.empty())
      return error(
          fmt::format("{}: column {} has no name; name it as an option of the command, or "
                      "remove it",
                      manifest.place(line.number), n + 1));
    if (std::find(line.cells.begin(), line.cells.begin() + static_cast<std::ptrdiff_t>(n), name) !=
        line.cells.begin() + static_cast<std::ptrdiff_t>(n))
      return error(fmt::format("{}: the column stands there twice; remove one",
                               manifest.place(line.number, name)));
  }
  for (const char* needed : {"id", "command"})
    if (std::find(line.cells.begin(), line.cells.end(), needed) == line.cells.end())
      return error(
          fmt::format("{}: there is no column {}; the first line below \"{}\" names the "
                      "columns, id and command among them",
                      manifest.place(line.number), needed, kManifestHead));
  return fine();
}

}  // namespace

std::string Manifest::place(int line, const std::string& column) const {
  return fmt::format("{}: line {}{}", file, line,
                     column.empty() ? "" : ", column " + base::printable(column));
}

nlohmann::json Manifest::inputs(const ManifestRow& row) const {
  nlohmann::json out = nlohmann::json::object();
  for (std::size_t n = 0; n < columns.size(); ++n)
    if (columns[n] != "id" && !row.cells[n].empty()) out[columns[n]] = row.cells[n];
  return out;
}

Result<Manifest> parse_manifest(std::string_view text, const std::string& file) {
  Manifest manifest;
  manifest.file = base::printable(file);
  manifest.hash = workshop::sha256(text);
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // as spreadsheets write it
  const std::string_view first = text.substr(0, text.find_first_of("\r\n"));
  if (first != kManifestHead)
    return error(fmt::format("{}: line 1: is not \"{}\"; a manifest begins with this line",
                             manifest.file, kManifestHead));
  Reader reader(text, manifest.file);
  Line line;
  const auto head = reader.next(line);
  if (!head) return head.error();
  if (!*head)
    return error(
        fmt::format("{}: ends after its first line; the next line names the columns, for "
                    "example id,command,case,seed",
                    manifest.file));
  if (const Status taken = take_columns(line, manifest); !taken) return taken.error();
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(
        std::find(manifest.columns.begin(), manifest.columns.end(), name) -
        manifest.columns.begin());
  };
  const std::size_t id = column("id"), command = column("command");
  std::unordered_map<std::string, int> lines;  // of each id
  while (true) {
    const auto more = reader.next(line);
    if (!more) return more.error();
    if (!*more) break;
    if (line.cells.size() != manifest.columns.size())
      return error(
          fmt::format("{}: has {} cells where there are {} columns; give each column a "
                      "cell, if need be an empty one",
                      manifest.place(line.number), line.cells.size(), manifest.columns.size()));
    ManifestRow row{line.cells[id], line.cells[command], std::move(line.cells), line.number};
    if (!is_id(row.id))
      return error(
          fmt::format("{}: {} is no id; use 1 to {} letters, digits, _, . and -, not "
                      "beginning with a point, without .json, not ending in .time",
                      manifest.place(row.line, "id"),
                      row.id.empty() ? "an empty cell" : base::printable(row.id), kLongestId));
    if (const auto [at, fresh] = lines.try_emplace(row.id, row.line); !fresh)
      return error(fmt::format("{}: {} is the id of line {} too; give each row an id of its own",
                               manifest.place(row.line, "id"), row.id, at->second));
    manifest.rows.push_back(std::move(row));
  }
  if (manifest.rows.empty())
    return error(fmt::format("{}: has no rows; write one below the columns", manifest.file));
  return manifest;
}

Result<Manifest> read_manifest(const std::string& path) {
  if (const Status plain = base::check_plain_file(path); !plain) return plain.error();
  std::ifstream in(path, std::ios::binary);
  if (!in)
    return error(Trouble::io, fmt::format("{}: cannot be opened: {}", base::printable(path),
                                          std::strerror(errno)));
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (in.bad()) return error(Trouble::io, fmt::format("{}: cannot be read", base::printable(path)));
  return parse_manifest(text, path);
}

Result<Shard> shard_of(const std::string& text) {
  const auto number = [](std::string_view digits, std::uint64_t& value) {
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return read.ec == std::errc() && read.ptr == digits.data() + digits.size();
  };
  const std::size_t slash = text.find('/');
  Shard shard;
  if (slash == std::string::npos || !number(std::string_view(text).substr(0, slash), shard.part) ||
      !number(std::string_view(text).substr(slash + 1), shard.of) || shard.part >= shard.of)
    return error(Trouble::usage,
                 fmt::format("--shard {}: write K/N, K from 0 to N-1, for example 0/64 to 63/64",
                             base::printable(text)));
  return shard;
}

bool belongs(const ManifestRow& row, const Shard& shard) {
  return scenario::text_hash(row.id) % shard.of == shard.part;
}

}  // namespace burr::app
