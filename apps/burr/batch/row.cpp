#include "batch/row.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>

#include "burr/base/printable.h"
#include "shared/front_words.h"

namespace burr::app {
namespace {

struct Registered {
  const char* name;
  RowCommand::Add add;
};

std::vector<Registered>& registered() {
  static std::vector<Registered> all;
  return all;
}

// What a command writes, what asks a person or a device, and what depends on the clock.
constexpr std::array<std::string_view, 14> kNotHere = {
    "record", "embed",    "picture",  "picture-size", "json", "force",    "out",
    "help",   "continue", "realtime", "device",       "home", "is-homed", "explain"};

// What separates several values of one option in a cell.
constexpr char kSeparator = ';';

std::vector<std::string> parts_of(const std::string& cell) {
  std::vector<std::string> parts(1);
  for (const char c : cell) {
    if (c == kSeparator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

// The option of this name, or what stands without an option; nullptr: there is none.
const CLI::Option* option_of(const CLI::App& command, const std::string& column) {
  if (const auto* option = command.get_option_no_throw("--" + column); option != nullptr)
    return option;
  const auto* option = command.get_option_no_throw(column);
  return option != nullptr && option->get_positional() ? option : nullptr;
}

// The words of a cell on the command line.
struct Words {
  std::vector<std::string> options, positionals;
};
// Error: "neither yes nor no".
Status add_words(const CLI::Option& option, const std::string& column, const std::string& cell,
                 Words& words) {
  if (option.get_items_expected_max() == 0) {
    if (cell != "yes" && cell != "no")
      return error(fmt::format("{} is neither yes nor no", base::printable(cell)));
    if (cell == "yes") words.options.push_back("--" + column);
    return fine();
  }
  const bool several = option.get_items_expected_max() > 1 && option.get_delimiter() == '\0';
  for (std::string& part : several ? parts_of(cell) : std::vector<std::string>{cell}) {
    if (option.get_positional())
      words.positionals.push_back(std::move(part));
    else
      words.options.push_back(fmt::format("--{}={}", column, part));
  }
  return fine();
}

// The column whose option a sentence names; empty: none of them.
std::string column_in(const std::string& sentence, const Manifest& manifest) {
  std::string found;
  for (const std::string& column : manifest.columns) {
    const std::string option = "--" + column;
    const std::size_t at = sentence.find(option);
    if (at == std::string::npos || column.size() < found.size()) continue;
    const std::size_t behind = at + option.size();
    const bool longer = behind < sentence.size() &&
                        (std::isalnum(static_cast<unsigned char>(sentence[behind])) != 0 ||
                         sentence[behind] == '-');
    if (!longer) found = column;
  }
  return found;
}

Error of_row(const Manifest& manifest, const ManifestRow& row, const std::string& sentence) {
  return error(
      fmt::format("{}: {}", manifest.place(row.line, column_in(sentence, manifest)), sentence));
}

// A file that the row names and that is not there, though its folder is: nobody needs to try again.
bool names_missing_file(const Manifest& manifest, const ManifestRow& row) {
  std::error_code nobody_asks;
  for (std::size_t n = 0; n < manifest.columns.size(); ++n) {
    const std::filesystem::path path = row.cells[n];
    if (path.empty() || std::filesystem::exists(path, nobody_asks)) continue;
    if (!path.has_parent_path() && !path.has_extension()) continue;  // a word
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (std::filesystem::is_directory(folder, nobody_asks)) return true;
  }
  return false;
}

Error judged(const Error& problem, const Manifest& manifest, const ManifestRow& row) {
  switch (problem.trouble) {
    case Trouble::usage:
    case Trouble::data:
    case Trouble::failed:
      return of_row(manifest, row, problem.text);
    case Trouble::io:
      if (names_missing_file(manifest, row)) return of_row(manifest, row, problem.text);
      return error(kTryAgain, problem.text);
    default:
      return problem;
  }
}

}  // namespace

RowCommand::RowCommand(const char* name, Add add) { registered().push_back({name, add}); }

std::vector<std::string> row_commands() {
  std::vector<std::string> names;
  for (const Registered& one : registered()) names.emplace_back(one.name);
  std::sort(names.begin(), names.end());
  return names;
}

void add_row_commands(CLI::App& app, RowTodo& todo) {
  for (const Registered& one : registered()) one.add(app, todo);
}

Status check_columns(const Manifest& manifest) {
  CLI::App app;
  RowTodo todo;
  add_row_commands(app, todo);
  for (const std::string& column : manifest.columns) {
    if (column == "id" || column == "command") continue;
    const std::string where = manifest.place(manifest.head_line, column);
    if (std::find(kNotHere.begin(), kNotHere.end(), column) != kNotHere.end())
      return error(
          fmt::format("{}: a batch sets this itself; remove the column (`burr batch --record` "
                      "records)",
                      where));
    const auto commands = app.get_subcommands({});
    if (std::none_of(commands.begin(), commands.end(), [&](const CLI::App* command) {
          return option_of(*command, column) != nullptr;
        }))
      return error(
          fmt::format("{}: none of the commands {} has such an option; see `burr help "
                      "surgeon`, and write the option without its dashes",
                      where, fmt::join(row_commands(), ", ")));
  }
  return fine();
}

Result<RowTodo> todo_of(const Manifest& manifest, const ManifestRow& row,
                        const std::vector<std::string>& more) {
  CLI::App app;
  RowTodo todo;
  add_row_commands(app, todo);
  const auto names = row_commands();
  if (std::find(names.begin(), names.end(), row.command) == names.end())
    return error(fmt::format("{}: {} is no command of a batch; use one of {}",
                             manifest.place(row.line, "command"),
                             row.command.empty() ? "an empty cell" : base::printable(row.command),
                             fmt::join(names, ", ")));
  const CLI::App& command = *app.get_subcommand(row.command);
  speak_for(command);  // in what follows the row speaks
  Words words;
  for (std::size_t n = 0; n < manifest.columns.size(); ++n) {
    const std::string &column = manifest.columns[n], &cell = row.cells[n];
    if (column == "id" || column == "command" || cell.empty()) continue;
    const CLI::Option* option = option_of(command, column);
    const std::string where = manifest.place(row.line, column);
    if (option == nullptr)
      return error(fmt::format("{}: `burr {}` has no such option; leave the cell empty in this row",
                               where, row.command));
    if (const Status added = add_words(*option, column, cell, words); !added)
      return error(fmt::format("{}: {}; write yes, no or nothing", where, added.error().text));
  }
  std::vector<std::string> line = {row.command};
  line.insert(line.end(), words.options.begin(), words.options.end());
  line.insert(line.end(), more.begin(), more.end());
  if (!words.positionals.empty()) line.emplace_back("--");
  line.insert(line.end(), words.positionals.begin(), words.positionals.end());
  std::reverse(line.begin(), line.end());  // as CLI11 wants it
  try {
    app.parse(line);
  } catch (const CLI::ParseError& problem) {
    const std::string column = column_in(problem.what(), manifest);
    return error(fmt::format("{}: {}; mend the cell, `burr help {}` says what is possible",
                             manifest.place(row.line, column), problem.what(), row.command));
  }
  return todo;
}

Result<CommandResult> do_row(const Manifest& manifest, const ManifestRow& row,
                             const std::vector<std::string>& more) {
  try {
    const auto todo = todo_of(manifest, row, more);
    if (!todo) return todo.error();
    CommandResult findings;
    const Status done = todo->work(findings);
    if (!done) return judged(in_options(done.error()), manifest, row);
    return findings;
  } catch (const std::bad_alloc&) {
    return error(kTryAgain,
                 "not enough memory; ask for more (`burr batch --dry-run` says how much)");
  } catch (const std::system_error& problem) {
    return error(
        problem.code() == std::errc::resource_unavailable_try_again ? kTryAgain : Trouble::internal,
        fmt::format("unexpected: {}", problem.what()));
  } catch (const std::exception& problem) {
    return error(Trouble::internal,
                 fmt::format("unexpected: {}; please report it", problem.what()));
  }
}

}  // namespace burr::app
