// school/database.h - one small face of two databases: SQLite, a file, and PostgreSQL, a server.
//
//     auto database = open_sqlite("school.sqlite", "school-names.sqlite", {});
//     auto rows = (*database)->rows("SELECT id FROM learner WHERE level = $1", {"PGY1"});
//
// Statements are prepared, and values travel apart from them: Sql takes only a constant, so no text of a person can
// become part of a statement. $1, $2 ... work in both. Times are milliseconds since 1970, UTC.
//
// Errors. Trouble::io: the database cannot be reached or written now (locked, disk full, server gone). Trouble::data: it
// answered that it will not do this (no right, no such table, damaged). A session waits after both (pending.h).
// Thread: one at a time for each Database. A call may wait: SQLite Waits::lock, PostgreSQL some seconds.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "burr/base/result.h"

namespace burr::school {

// NULL, a whole number, a number, a text. Numbers that are not finite are stored as NULL.
using Value = std::variant<std::monostate, std::int64_t, double, std::string>;
using Values = std::vector<Value>;
using Row = std::vector<Value>;

// The text of a statement: a constant of the program.
class Sql {
 public:
  consteval Sql(const char* text) : text_(text) {}  // NOLINT(google-explicit-constructor)
  [[nodiscard]] const char* text() const { return text_; }

 private:
  const char* text_;
};

class Database {
 public:
  enum class Kind { sqlite, postgres };

  Database() = default;
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  virtual ~Database() = default;

  [[nodiscard]] virtual Kind kind() const = 0;
  // One statement. Returns how many rows it changed.
  [[nodiscard]] virtual Result<std::int64_t> run(Sql sql, const Values& values = {}) = 0;
  [[nodiscard]] virtual Result<std::vector<Row>> rows(Sql sql, const Values& values = {}) = 0;
  // From begin() to commit() all or nothing; with SQLite in each of the two files by itself: what fails at the end may be
  // in the store and not in the names. A connection that was lost is made anew by begin(), and never between.
  [[nodiscard]] virtual Status begin() = 0;
  [[nodiscard]] virtual Status commit() = 0;
  virtual void rollback() = 0;
  [[nodiscard]] virtual bool inside() const = 0;  // between begin() and commit() or rollback()
  // From now on nothing can be written.
  [[nodiscard]] virtual Status read_only() = 0;
};

// Takes back what was not committed.
class Transaction {
 public:
  [[nodiscard]] static Result<Transaction> begin(Database& database) {
    if (const Status begun = database.begin(); !begun) return begun.error();
    return Transaction(database);
  }
  Transaction(Transaction&& other) noexcept : database_(std::exchange(other.database_, nullptr)) {}
  Transaction& operator=(Transaction&&) = delete;
  ~Transaction() {
    if (database_ != nullptr) database_->rollback();
  }
  [[nodiscard]] Status commit() {
    const Status done = database_->commit();
    if (done) database_ = nullptr;
    return done;
  }

 private:
  explicit Transaction(Database& database) : database_(&database) {}
  Database* database_;
};

struct Waits {
  int lock_ms = 5000;  // for another program that writes
  int connect_s = 5;   // for a server
  int answer_s = 20;   // for its answer
};

// file: made if it is not there, for this user alone; names: a second file, which the statements know as `names`.
// shown: what errors call it.
[[nodiscard]] Result<std::unique_ptr<Database>> open_sqlite(const std::string& file,
                                                            const std::string& names, Waits waits);
// address: postgresql://..., as libpq reads it; a password is better in ~/.pgpass. shown: the address without user and
// password, for errors.
// True: libpq reads it, and takes no part of a password for a host or a database (`/`, `@` in it must be %2F, %40).
[[nodiscard]] bool is_readable_address(const std::string& address);
[[nodiscard]] Result<std::unique_ptr<Database>> open_postgres(const std::string& address,
                                                              const std::string& shown,
                                                              Waits waits);

// ---- values out of a row; of another type: 0, "" or none
[[nodiscard]] std::int64_t whole(const Value& value);
[[nodiscard]] double number(const Value& value);
[[nodiscard]] std::string text(const Value& value);
[[nodiscard]] inline bool is_null(const Value& value) { return value.index() == 0; }
// As a CSV has it: the shortest text that is read back as the same number; NULL is empty.
[[nodiscard]] std::string written(const Value& value);

}  // namespace burr::school
