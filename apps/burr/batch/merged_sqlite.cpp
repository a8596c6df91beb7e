// The table of merged.h as a file of SQLite.
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "batch/canonical.h"
#include "batch/merged.h"
#include "burr/base/printable.h"

namespace burr::app {
namespace {

using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

// The name of a column, as a statement has it.
std::string named(const std::string& column) {
  std::string text = "\"";
  for (const char c : column) {
    if (c == '"') text += c;
    text += c;
  }
  return text + "\"";
}

class Writer {
 public:
  explicit Writer(const std::string& file) : file_(file) {
    if (sqlite3_open_v2(file.c_str(), &base_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE,
                        nullptr) != SQLITE_OK)
      fail();
  }
  ~Writer() { sqlite3_close(base_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void run(const std::string& sql) {
    if (status_.ok() && sqlite3_exec(base_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
      fail();
  }
  [[nodiscard]] Statement prepare(const std::string& sql) {
    sqlite3_stmt* made = nullptr;
    if (status_.ok() && sqlite3_prepare_v2(base_, sql.c_str(), -1, &made, nullptr) != SQLITE_OK)
      fail();
    return {made, sqlite3_finalize};
  }
  void insert(const Statement& statement, const std::vector<nlohmann::json>& values) {
    if (!status_.ok()) return;
    sqlite3_reset(statement.get());
    sqlite3_clear_bindings(statement.get());
    for (std::size_t n = 0; n < values.size(); ++n)
      bind(statement.get(), static_cast<int>(n) + 1, values[n]);
    if (sqlite3_step(statement.get()) != SQLITE_DONE) fail();
  }
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  static void bind(sqlite3_stmt* statement, int at, const nlohmann::json& value) {
    if (value.is_string()) {
      const auto& text = value.get_ref<const std::string&>();
      sqlite3_bind_text(statement, at, text.c_str(), static_cast<int>(text.size()),
                        SQLITE_TRANSIENT);
    } else if (value.is_number_float()) {
      sqlite3_bind_double(statement, at, value.get<double>());
    } else if (value.is_number()) {
      sqlite3_bind_int64(statement, at, value.get<std::int64_t>());
    } else if (value.is_boolean()) {
      sqlite3_bind_int(statement, at, value.get<bool>() ? 1 : 0);
    }
  }
  void fail() {
    status_ = error(Trouble::io, fmt::format("{}: cannot be written: {}", base::printable(file_),
                                             sqlite3_errmsg(base_)));
  }

  std::string file_;
  sqlite3* base_ = nullptr;
  Status status_ = fine();
};

void fill(Writer& writer, const Merged& merged) {
  const std::set<std::string> found = merged.found_columns();
  std::string columns = "id TEXT PRIMARY KEY, code INTEGER NOT NULL, sentence TEXT",
              marks = "?, ?, ?";
  for (const std::string& name : merged.manifest.columns) {
    if (name == "id") continue;
    columns += ", " + named(name) + " TEXT";
    marks += ", ?";
  }
  for (const std::string& name : found) {  // no type: as it was found
    columns += ", " + named(name);
    marks += ", ?";
  }
  writer.run("BEGIN");
  writer.run("CREATE TABLE result (" + columns + ") WITHOUT ROWID");
  writer.run("CREATE TABLE engine (engine TEXT NOT NULL)");
  const Statement insert = writer.prepare("INSERT INTO result VALUES (" + marks + ")");
  for (std::size_t n = 0; n < merged.rows.size(); ++n) {
    const ManifestRow& row = merged.manifest.rows[n];
    const MergedRow& one = merged.rows[n];
    std::vector<nlohmann::json> values = {row.id, one.code, one.sentence};
    for (std::size_t c = 0; c < row.cells.size(); ++c)
      if (merged.manifest.columns[c] != "id") values.emplace_back(row.cells[c]);
    for (const std::string& name : found) {
      const auto at = one.found.find(name);
      values.push_back(at == one.found.end() ? nlohmann::json() : at->second);
    }
    writer.insert(insert, values);
  }
  const Statement engine = writer.prepare("INSERT INTO engine VALUES (?)");
  for (const nlohmann::json& one : merged.engines) writer.insert(engine, {canonical(one)});
  writer.run("COMMIT");
}

}  // namespace

Status write_sqlite(const Merged& merged, const std::string& file) {
  constexpr std::size_t kMost = 2000;  // SQLITE_MAX_COLUMN of Debian
  const std::size_t columns = 2 + merged.manifest.columns.size() + merged.found_columns().size();
  if (columns > kMost)
    return error(
        fmt::format("{}: {} columns are more than a table of SQLite takes ({}); use the CSV, "
                    "or merge commands of different kinds apart",
                    base::printable(file), columns, kMost));
  const std::string beside = file + ".part-" + std::to_string(::getpid());
  std::error_code nobody_asks;
  std::filesystem::remove(beside, nobody_asks);
  Status written = fine();
  {
    Writer writer(beside);
    fill(writer, merged);
    written = writer.status();
  }
  if (written && std::rename(beside.c_str(), file.c_str()) != 0)
    written = error(Trouble::io, base::printable(file) + ": cannot be renamed to its final name");
  if (!written) std::filesystem::remove(beside, nobody_asks);
  return written;
}

}  // namespace burr::app
