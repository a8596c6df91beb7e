// PostgreSQL behind school/database.h.
#include <fmt/format.h>
#include <libpq-fe.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "burr/school/database.h"

namespace burr::school {
namespace {

struct Clear {
  void operator()(PGresult* result) const { PQclear(result); }
};
using Answer = std::unique_ptr<PGresult, Clear>;

// What cannot be done now, but perhaps later, by the classes of SQLSTATE.
bool passes(std::string_view state) {
  for (const std::string_view one : {"08", "53", "57", "58", "40", "55", "28", "XX"})
    if (state.substr(0, 2) == one) return true;
  return state == "25006";  // a server that only reads, because another one took over
}

std::string one_line(std::string_view text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
  std::string line(text.substr(0, text.find('\n')));
  return line;
}

std::string text_of(const Value& value) {
  if (const auto* d = std::get_if<double>(&value)) return fmt::format("{:.17g}", *d);
  return written(value);
}

bool none(const Value& value) {
  const auto* d = std::get_if<double>(&value);
  return is_null(value) || (d != nullptr && !std::isfinite(*d));
}

template <class Number>
Value read(std::string_view text) {
  Number number = 0;
  const auto got = std::from_chars(text.data(), text.data() + text.size(), number);
  return got.ec == std::errc() ? Value(number) : Value(std::string(text));
}

class Postgres final : public Database {
 public:
  Postgres(std::string address, std::string shown, Waits waits)
      : address_(std::move(address)), shown_(std::move(shown)), waits_(waits) {}
  ~Postgres() override { PQfinish(connection_); }

  Status connect() {
    PQfinish(connection_);
    connection_ = nullptr;
    prepared_.clear();
    inside_ = false;
    // libpq quotes what it cannot read, and that may be a password
    if (!is_readable_address(address_))
      return error(Trouble::io,
                   fmt::format("{}: the address cannot be read; write %, /, ? and @ in a password "
                               "as %25, %2F, %3F, %40",
                               shown_));
    const std::string wait = fmt::format("{}", waits_.connect_s);
    // a net that is gone shows after some seconds, not after hours; what the address says goes before
    const char* names[] = {"connect_timeout",  "keepalives_idle",  "keepalives_interval",
                           "keepalives_count", "tcp_user_timeout", "client_encoding",
                           "application_name", "dbname",           nullptr};
    const char* values[] = {wait.c_str(),     "5",    "2", "3", "10000", "UTF8", "burr",
                            address_.c_str(), nullptr};
    connection_ = PQconnectdbParams(names, values, 1);
    if (PQstatus(connection_) != CONNECTION_OK)
      return error(Trouble::io, fmt::format("{}: no connection ({})", shown_,
                                            one_line(PQerrorMessage(connection_))));
    PQsetNoticeProcessor(
        connection_, [](void*, const char*) {}, nullptr);
    const std::string lock = fmt::format("{}", waits_.lock_ms);
    if (const auto set = rows("SELECT set_config('lock_timeout', $1, false)", {lock}); !set)
      return set.error();
    return reads_only_ ? read_only() : fine();
  }

  [[nodiscard]] Kind kind() const override { return Kind::postgres; }

  Result<std::int64_t> run(Sql sql, const Values& values) override {
    auto answer = ask(sql, values);
    if (!answer) return answer.error();
    const std::string_view count = PQcmdTuples(answer->get());
    return count.empty() ? std::int64_t{0} : whole(read<std::int64_t>(count));
  }

  Result<std::vector<Row>> rows(Sql sql, const Values& values) override {
    auto answer = ask(sql, values);
    if (!answer) return answer.error();
    const PGresult* result = answer->get();
    std::vector<Row> all;
    const int width = PQnfields(result);
    for (int n = 0; n < PQntuples(result); ++n) {
      Row row;
      for (int column = 0; column < width; ++column) row.push_back(value_of(result, n, column));
      all.push_back(std::move(row));
    }
    return all;
  }

  Status begin() override {
    if (const Status back = reconnect(); !back) return back;
    const auto begun = run("BEGIN", {});
    if (!begun) return begun.error();
    inside_ = true;
    return fine();
  }
  Status commit() override {
    const auto done = run("COMMIT", {});
    inside_ = false;
    return done ? fine() : Status(done.error());
  }
  void rollback() override {
    inside_ = true;  // no new connection for this
    if (PQstatus(connection_) == CONNECTION_OK) static_cast<void>(run("ROLLBACK", {}));
    inside_ = false;
  }
  bool inside() const override { return inside_; }
  Status read_only() override {
    reads_only_ = true;
    const auto set = run("SET default_transaction_read_only = on", {});
    return set ? fine() : Status(set.error());
  }

 private:
  Status reconnect() { return PQstatus(connection_) == CONNECTION_OK ? fine() : connect(); }

  Result<Answer> ask(Sql sql, const Values& values) {
    if (!inside_)
      if (const Status back = reconnect(); !back) return back.error();
    auto name = prepare(sql);
    if (!name) return name.error();
    std::vector<std::string> texts;
    for (const Value& value : values) texts.push_back(text_of(value));
    std::vector<const char*> given;
    for (std::size_t n = 0; n < values.size(); ++n)
      given.push_back(none(values[n]) ? nullptr : texts[n].c_str());
    if (PQsendQueryPrepared(connection_, name->c_str(), static_cast<int>(given.size()),
                            given.data(), nullptr, nullptr, 0) == 0)
      return failed();
    Answer answer = wait(sql);
    if (const Status good = check(answer.get()); !good) return good.error();
    return answer;
  }

  Result<std::string> prepare(Sql sql) {
    if (const auto known = prepared_.find(sql.text()); known != prepared_.end())
      return known->second;
    std::string name = fmt::format("q{}", prepared_.size());
    if (PQsendPrepare(connection_, name.c_str(), sql.text(), 0, nullptr) == 0) return failed();
    const Answer made = wait(sql);
    if (const Status good = check(made.get()); !good) return good.error();
    prepared_[sql.text()] = name;
    return name;
  }

  // The last answer to what was sent; none: the connection is lost, or the server hangs.
  Answer wait(Sql sql) {
    using Clock = std::chrono::steady_clock;
    constexpr int kLong = 600;  // [s] a table is written anew
    const bool is_long = std::string_view(sql.text()).substr(0, 6) == "VACUUM";
    const auto end = Clock::now() + std::chrono::seconds(is_long ? kLong : waits_.answer_s);
    Answer last;
    for (;;) {
      while (PQisBusy(connection_) != 0) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        pollfd one = {PQsocket(connection_), POLLIN, 0};
        const int ready = left > 0 ? ::poll(&one, 1, static_cast<int>(left)) : 0;
        if (ready < 0 && errno == EINTR) continue;
        if (ready <= 0 || PQconsumeInput(connection_) == 0) {
          hangs_ = ready == 0;
          if (hangs_) PQfinish(std::exchange(connection_, nullptr));
          return nullptr;
        }
      }
      Answer next(PQgetResult(connection_));
      if (!next) return last;
      last = std::move(next);
    }
  }

  Error failed() {
    if (std::exchange(hangs_, false))
      return error(Trouble::io, fmt::format("{}: the server does not answer", shown_));
    return error(Trouble::io, fmt::format("{}: {}", shown_, one_line(PQerrorMessage(connection_))));
  }

  Status check(const PGresult* answer) {
    if (answer == nullptr) return failed();
    const ExecStatusType status = PQresultStatus(answer);
    if (status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK) return fine();
    const char* state = PQresultErrorField(answer, PG_DIAG_SQLSTATE);
    // without a state the answer never came
    const bool later = PQstatus(connection_) != CONNECTION_OK || state == nullptr || passes(state);
    const char* primary = PQresultErrorField(answer, PG_DIAG_MESSAGE_PRIMARY);
    return error(later ? Trouble::io : Trouble::data,
                 fmt::format("{}: {}", shown_,
                             one_line(primary != nullptr ? primary : PQerrorMessage(connection_))));
  }

  static Value value_of(const PGresult* result, int row, int column) {
    if (PQgetisnull(result, row, column) != 0) return std::monostate();
    const std::string_view text(PQgetvalue(result, row, column),
                                static_cast<std::size_t>(PQgetlength(result, row, column)));
    constexpr Oid kInt8 = 20, kInt2 = 21, kInt4 = 23, kFloat4 = 700, kFloat8 = 701, kNumeric = 1700;
    switch (PQftype(result, column)) {
      case kInt8:
      case kInt2:
      case kInt4:
        return read<std::int64_t>(text);
      case kFloat4:
      case kFloat8:
      case kNumeric:
        return read<double>(text);
      default:
        return std::string(text);
    }
  }

  std::string address_, shown_;
  Waits waits_;
  PGconn* connection_ = nullptr;
  bool inside_ = false;  // a transaction
  bool reads_only_ = false;
  bool hangs_ = false;                           // the last answer did not come in time
  std::map<const char*, std::string> prepared_;  // of this connection
};

}  // namespace

bool is_readable_address(const std::string& address) {
  char* said = nullptr;
  PQconninfoOption* options = PQconninfoParse(address.c_str(), &said);
  PQfreemem(said);
  if (options == nullptr) return false;
  PQconninfoFree(options);
  // libpq ends user and password at the first @ before the first /; a second one is in a password
  const std::size_t begin = address.find("://") + 3;
  const std::size_t path = std::min(address.find('/', begin), address.size());
  const std::size_t query = std::min(address.find('?', path), address.size());
  return std::count(address.begin() + static_cast<std::ptrdiff_t>(begin),
                    address.begin() + static_cast<std::ptrdiff_t>(path), '@') <= 1 &&
         address.substr(path, query - path).find('@') == std::string::npos;
}

Result<std::unique_ptr<Database>> open_postgres(const std::string& address,
                                                const std::string& shown, Waits waits) {
  auto made = std::make_unique<Postgres>(address, shown, waits);
  if (const Status connected = made->connect(); !connected) return connected.error();
  return std::unique_ptr<Database>(std::move(made));
}

}  // namespace burr::school
