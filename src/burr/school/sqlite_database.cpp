// SQLite behind school/database.h.
#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>

#include "burr/base/plain_file.h"
#include "burr/school/database.h"

namespace burr::school {
namespace {

// What cannot be done now, but perhaps later.
bool passes(int code) {
  switch (code & 0xFF) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_NOMEM:
    case SQLITE_PERM:
      return true;
    default:
      return false;
  }
}

const char* advice(int code) {
  switch (code & 0xFF) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program writes to it";
    case SQLITE_FULL:
      return "the disk is full";
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return "it may not be written";
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
      return "it is no store of learners, or it is damaged; restore it from a copy";
    default:
      return nullptr;
  }
}

class Sqlite final : public Database {
 public:
  explicit Sqlite(std::string file) : file_(std::move(file)) {}
  ~Sqlite() override {
    for (const auto& [text, statement] : statements_) sqlite3_finalize(statement);
    sqlite3_close_v2(handle_);
  }

  Status open(const std::string& names, int wait_ms) {
    for (const std::string& one : {file_, names}) {
      if (const Status plain = base::check_plain_file(one); !plain) return plain.error();
      // for this user alone; SQLite gives the same rights to the files that it puts beside
      const int made = ::open(one.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
      if (made >= 0) ::close(made);
    }
    const int code = sqlite3_open_v2(file_.c_str(), &handle_,
                                     SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
    if (code != SQLITE_OK) return failed(code);
    sqlite3_extended_result_codes(handle_, 1);
    sqlite3_busy_timeout(handle_, wait_ms);
    if (const auto attached = run("ATTACH DATABASE $1 AS names", {names}); !attached)
      return attached.error();
    // deleted text is overwritten, not only forgotten
    for (const Sql one : {Sql("PRAGMA journal_mode = WAL"), Sql("PRAGMA names.journal_mode = WAL"),
                          Sql("PRAGMA foreign_keys = ON"), Sql("PRAGMA secure_delete = ON"),
                          Sql("PRAGMA names.secure_delete = ON")})
      if (const auto set = rows(one, {}); !set) return set.error();
    return fine();
  }

  [[nodiscard]] Kind kind() const override { return Kind::sqlite; }

  Result<std::int64_t> run(Sql sql, const Values& values) override {
    const auto nothing = rows(sql, values);
    if (!nothing) return nothing.error();
    return static_cast<std::int64_t>(sqlite3_changes(handle_));
  }

  Result<std::vector<Row>> rows(Sql sql, const Values& values) override {
    auto prepared = prepare(sql);
    if (!prepared) return prepared.error();
    sqlite3_stmt* statement = *prepared;
    for (std::size_t n = 0; n < values.size(); ++n) bind(statement, n, values[n]);
    std::vector<Row> all;
    int code = SQLITE_ROW;
    while ((code = sqlite3_step(statement)) == SQLITE_ROW) {
      Row row;
      for (int column = 0; column < sqlite3_column_count(statement); ++column)
        row.push_back(value_of(statement, column));
      all.push_back(std::move(row));
    }
    std::optional<Error> trouble;
    if (code != SQLITE_DONE) trouble = failed(code);
    sqlite3_reset(statement);
    sqlite3_clear_bindings(statement);
    if (trouble) return *trouble;
    return all;
  }

  Status begin() override { return done("BEGIN IMMEDIATE"); }
  Status commit() override { return done("COMMIT"); }
  void rollback() override {
    if (sqlite3_get_autocommit(handle_) == 0) static_cast<void>(run("ROLLBACK", {}));
  }
  bool inside() const override { return sqlite3_get_autocommit(handle_) == 0; }
  Status read_only() override { return done("PRAGMA query_only = ON"); }

 private:
  Status done(Sql sql) {
    const auto some = rows(sql, {});
    return some ? fine() : some.error();
  }

  Error failed(int code) const {
    const char* known = advice(code);
    const char* said = handle_ != nullptr ? sqlite3_errmsg(handle_) : sqlite3_errstr(code);
    return error(passes(code) ? Trouble::io : Trouble::data,
                 fmt::format("{}: {}", std::filesystem::path(file_).filename().string(),
                             known != nullptr ? known : said));
  }

  Result<sqlite3_stmt*> prepare(Sql sql) {
    if (const auto known = statements_.find(sql.text()); known != statements_.end())
      return known->second;
    sqlite3_stmt* made = nullptr;
    const int code = sqlite3_prepare_v3(handle_, sql.text(), -1, 0, &made, nullptr);
    if (code != SQLITE_OK) return failed(code);
    statements_[sql.text()] = made;
    return made;
  }

  static void bind(sqlite3_stmt* statement, std::size_t n, const Value& value) {
    const int at = sqlite3_bind_parameter_index(statement, fmt::format("${}", n + 1).c_str());
    if (at == 0) return;
    if (const auto* i = std::get_if<std::int64_t>(&value))
      sqlite3_bind_int64(statement, at, *i);
    else if (const auto* d = std::get_if<double>(&value); d != nullptr && std::isfinite(*d))
      sqlite3_bind_double(statement, at, *d);
    else if (const auto* s = std::get_if<std::string>(&value))
      sqlite3_bind_text64(statement, at, s->data(), s->size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    else
      sqlite3_bind_null(statement, at);
  }

  static Value value_of(sqlite3_stmt* statement, int column) {
    switch (sqlite3_column_type(statement, column)) {
      case SQLITE_INTEGER:
        return static_cast<std::int64_t>(sqlite3_column_int64(statement, column));
      case SQLITE_FLOAT:
        return sqlite3_column_double(statement, column);
      case SQLITE_NULL:
        return std::monostate();
      default: {
        const void* bytes = sqlite3_column_text(statement, column);
        const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement, column));
        return std::string(static_cast<const char*>(bytes), size);
      }
    }
  }

  std::string file_;
  sqlite3* handle_ = nullptr;
  std::map<const char*, sqlite3_stmt*> statements_;
};

}  // namespace

Result<std::unique_ptr<Database>> open_sqlite(const std::string& file, const std::string& names,
                                              Waits waits) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::error_code trouble;
  if (!folder.empty()) std::filesystem::create_directories(folder, trouble);
  auto made = std::make_unique<Sqlite>(file);
  if (const Status opened = made->open(names, waits.lock_ms); !opened) return opened.error();
  return std::unique_ptr<Database>(std::move(made));
}

}  // namespace burr::school
