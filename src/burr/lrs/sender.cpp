#include "burr/lrs/sender.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "burr/base/base64.h"
#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/base/trimmed.h"
#include "burr/net/client.h"
#include "burr/school/outbox.h"

namespace burr::lrs {
namespace {

using Json = nlohmann::json;
using school::Store;
using school::Waiter;
using Trouble = burr::Trouble;

std::string environment(const char* name) {
  const char* said = std::getenv(name);
  return said == nullptr ? std::string() : std::string(said);
}

Result<Lrs> lrs_of(std::string endpoint, const std::string& key, const std::string& where) {
  while (!endpoint.empty() && endpoint.back() == '/') endpoint.pop_back();
  if (const auto url = net::parse_url(endpoint); !url)
    return error(Trouble::usage, fmt::format("{}: the endpoint: {}", where, url.error().text));
  const bool plain = std::none_of(key.begin(), key.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  });
  if (key.find(':') == std::string::npos || !plain)
    return error(Trouble::usage, fmt::format("{}: the key is missing: KEY:SECRET", where));
  return Lrs{std::move(endpoint), "Basic " + base::base64(key)};
}

std::vector<std::pair<std::string, std::string>> fields(const Lrs& lrs) {
  return {{"Authorization", lrs.authorization},
          {"X-Experience-API-Version", "1.0.3"},
          {"Content-Type", "application/json"}};
}

std::vector<std::string> ids_of(std::span<const Waiter> rows) {
  std::vector<std::string> out;
  for (const Waiter& row : rows) out.push_back(row.id);
  return out;
}

// "400: the first words of what it said"
std::string sentence_of(const net::Answer& answer) {
  std::string said = answer.body;
  const Json read = Json::parse(answer.body, nullptr, false);
  if (read.is_object())
    for (const char* name : {"error", "message", "description"})
      if (const auto found = read.find(name); found != read.end() && found->is_string())
        said = found->get<std::string>();
  return fmt::format("{}: {}", answer.status,
                     said.empty() ? "the server gives no reason" : base::printable(said, 400));
}

// When it may be tried again  [ms]; 0: the server does not say. Seconds, or a date.
std::int64_t retry_after(const net::Answer& answer, std::int64_t now) {
  const auto found = answer.fields.find("retry-after");
  if (found == answer.fields.end()) return 0;
  constexpr std::int64_t kMost =
      std::int64_t{7} * 24 * 3'600'000;  // a slip must not stop it for ever
  const std::string& text = found->second;
  if (!text.empty() && text.size() < 10 &&
      text.find_first_not_of("0123456789") == std::string::npos)
    return now + std::min(kMost, 1000 * static_cast<std::int64_t>(std::stoll(text)));
  std::tm day = {};
  if (strptime(text.c_str(), "%a, %d %b %Y %H:%M:%S GMT", &day) == nullptr) return 0;
  return std::min(now + kMost, std::int64_t{1000} * timegm(&day));
}

// One pass over what is due.
class Pass {
 public:
  Pass(Store& store, const Lrs& lrs, const Ways& ways) : store_(store), lrs_(lrs), ways_(ways) {}

  Result<Sent> run() {
    for (;;) {
      const auto rows = school::take_due(store_, school::now_ms(), ways_.most, ways_.all);
      if (!rows) return rows.error();
      if (rows->empty()) break;
      if (const Status done = deliver(*rows); !done) return done.error();
      if (stopped_) break;
    }
    const std::int64_t until = out_.trouble.empty() ? 0 : until_;
    if (const Status kept = school::set_pause(store_, until, kept_); !kept) return kept.error();
    return out_;
  }

 private:
  Result<net::Answer> ask(const char* method, const std::string& path, std::string body) {
    return net::ask({method, lrs_.endpoint + path, fields(lrs_), std::move(body), ways_.wait_s});
  }

  Status deliver(std::span<const Waiter> rows) {
    if (stopped_) return later(rows);
    std::string body = "[";
    for (const Waiter& row : rows) body += (body.size() > 1 ? "," : "") + row.json;
    const auto answer = ask("POST", "/statements", body + "]");
    if (!answer) return stop(rows, answer.error().text, 0);
    const int status = answer->status;
    if (status == 200) {
      if (!names_them(answer->body, rows))
        return stop(rows, "200, but this is no answer of a learning record store", 0);
      return sent(rows);
    }
    const std::int64_t after = retry_after(*answer, school::now_ms());
    const bool of_the_key = status < 400 || status == 401 || status == 403 || status == 404 ||
                            status == 405 || status == 407;
    if (status == 429 || status == 408 || status >= 500 || of_the_key)
      return stop(rows, sentence_of(*answer), after);
    if (rows.size() > 1) {  // which of them is it?
      const std::size_t half = rows.size() / 2;
      if (const Status done = deliver(rows.first(half)); !done) return done;
      return deliver(rows.subspan(half));
    }
    if (status == 409) return compare(rows);
    return put_aside(rows, sentence_of(*answer));
  }

  static bool names_them(const std::string& body, std::span<const Waiter> rows) {
    const Json read = Json::parse(body, nullptr, false);
    if (!read.is_array() || read.size() != rows.size()) return false;
    for (std::size_t n = 0; n < rows.size(); ++n)
      if (read[n] != rows[n].id) return false;
    return true;
  }

  // The server has a statement of this id.
  Status compare(std::span<const Waiter> rows) {
    const Waiter& row = rows.front();
    for (const char* by : {"statementId", "voidedStatementId"}) {
      const auto found = ask("GET", fmt::format("/statements?{}={}", by, row.id), "");
      if (!found) return stop(rows, found.error().text, 0);
      if (found->status == 404) continue;
      if (found->status == 429 || found->status >= 500)
        return stop(rows, sentence_of(*found), retry_after(*found, school::now_ms()));
      if (found->status == 200 && is_same(row.json, found->body)) return sent(rows);
      return put_aside(rows, found->status == 200
                                 ? "409: the server has another statement of this id"
                                 : "409, and then " + sentence_of(*found));
    }
    return put_aside(rows, "409: the server has the id, but does not show its statement");
  }

  Status sent(std::span<const Waiter> rows) {
    out_.sent += rows.size();
    return school::mark_sent(store_, ids_of(rows));
  }
  Status put_aside(std::span<const Waiter> rows, const std::string& why) {
    out_.parked += rows.size();
    return school::park(store_, rows.front(), why);
  }
  // after: as retry_after()
  Status stop(std::span<const Waiter> rows, const std::string& why, std::int64_t after) {
    stopped_ = true;
    out_.trouble = why;
    // a server's sentence may name somebody of fifty: it is shown, and only its number is kept
    const bool answered = why.size() > 3 && why.find_first_not_of("0123456789") == 3;
    kept_ = answered ? "the server answers " + why.substr(0, 3) : why;
    std::int64_t tries = 1;
    for (const Waiter& row : rows) tries = std::max(tries, row.tries);
    const std::int64_t now = school::now_ms();
    until_ = after != 0 ? std::max(after, now) : now + school::wait_after(tries);
    return later(rows);
  }
  Status later(std::span<const Waiter> rows) {
    return school::put_off(store_, ids_of(rows), until_);
  }

  Store& store_;
  const Lrs& lrs_;
  const Ways& ways_;
  Sent out_;
  bool stopped_ = false;
  std::int64_t until_ = 0;
  std::string kept_;
};

// Numbers by value, so 1 is 1.0; of an object only what was sent.
bool holds(const Json& found, const Json& sent) {
  if (sent.is_object()) {
    if (!found.is_object()) return false;
    return std::all_of(sent.items().begin(), sent.items().end(), [&](const auto& item) {
      const auto there = found.find(item.key());
      return there != found.end() && holds(*there, item.value());
    });
  }
  if (sent.is_array()) {
    if (!found.is_array() || found.size() != sent.size()) return false;
    for (std::size_t n = 0; n < sent.size(); ++n)
      if (!holds(found[n], sent[n])) return false;
    return true;
  }
  return found == sent;
}

}  // namespace

bool is_same(const std::string& sent, const std::string& found) {
  Json mine = Json::parse(sent, nullptr, false), other = Json::parse(found, nullptr, false);
  if (!mine.is_object() || !other.is_object()) return false;
  // a server may write times and names otherwise, and makes a list of a single activity
  for (Json* one : {&mine, &other}) {
    one->erase("timestamp");
    if (one->contains("verb") && (*one)["verb"].is_object()) (*one)["verb"].erase("display");
    if (one->contains("object") && (*one)["object"].is_object())
      (*one)["object"].erase("definition");
    if (one->contains("context") && (*one)["context"].is_object())
      (*one)["context"].erase("contextActivities");
    for (const char* part : {"actor", "object"})
      if (one->contains(part) && (*one)[part].is_object() &&
          ((*one)[part].value("objectType", Json()) == "Agent" ||
           (*one)[part].value("objectType", Json()) == "Activity"))
        (*one)[part].erase("objectType");
  }
  return holds(other, mine);
}

Result<Lrs> read_lrs(const std::string& file, const std::filesystem::path& config) {
  const std::string endpoint = environment("BURR_XAPI_ENDPOINT"),
                    key = environment("BURR_XAPI_KEY");
  if (file.empty() && !endpoint.empty() && !key.empty())
    return lrs_of(endpoint, key, "BURR_XAPI_ENDPOINT, BURR_XAPI_KEY");
  std::string path = file.empty() ? environment("BURR_XAPI_FILE") : file;
  if (path.empty() && !config.empty()) path = (config / "xapi").string();
  const std::string name = std::filesystem::path(path).filename().string();
  struct stat status = {};
  if (path.empty() || stat(path.c_str(), &status) != 0)
    return error(
        Trouble::usage,
        fmt::format("{}: there is no such file. Write the endpoint and KEY:SECRET into it, "
                    "on a line each, and run: chmod 600 {}",
                    base::printable(path, 300), base::printable(name)));
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    return error(Trouble::usage,
                 fmt::format("{0}: other users may read the key; run: chmod 600 {0}",
                             base::printable(name)));
  const auto text =
      base::text_of_file(path, 4096, "an endpoint and a key; check that this is the right file");
  if (!text) return text.error();
  const std::size_t end = std::min(text->find('\n'), text->size());
  return lrs_of(std::string(base::trimmed(text->substr(0, end))),
                std::string(base::trimmed(text->substr(std::min(end + 1, text->size())))),
                base::printable(name));
}

Result<Sent> send_due(Store& store, const Lrs& lrs, const Ways& ways) {
  if (const Status may = store.may_write(); !may) return may.error();
  const auto now = school::outbox_status(store);
  if (!now) return now.error();
  if (now->home_page.empty())
    return error(Trouble::usage, "no statements are made; `school::set_home_page` begins");
  if (!ways.all && now->not_before_ms > school::now_ms()) return Sent{0, 0, now->trouble};
  return Pass(store, lrs, ways).run();
}

Result<std::string> about(const Lrs& lrs) {
  const auto answer = net::ask({"GET", lrs.endpoint + "/about", fields(lrs), "", 15});
  if (!answer) return answer.error();
  const Json read = Json::parse(answer->body, nullptr, false);
  if (answer->status != 200 || !read.is_object() || !read.contains("version") ||
      !read["version"].is_array())
    return error(Trouble::io, fmt::format("this is no learning record store ({})", answer->status));
  std::string versions;
  bool known = false;
  for (const Json& one : read["version"]) {
    if (!one.is_string()) continue;
    versions += (versions.empty() ? "" : ", ") + one.get<std::string>();
    known = known || one.get<std::string>().rfind("1.0", 0) == 0;
  }
  if (!known) return error(Trouble::failed, fmt::format("it speaks xAPI {}, burr 1.0.3", versions));
  // it may answer that without the key
  const auto keyed = net::ask({"GET", lrs.endpoint + "/statements?limit=1", fields(lrs), "", 15});
  if (!keyed) return keyed.error();
  if (keyed->status != 200 && keyed->status != 403)  // a key may write and not read
    return error(Trouble::failed,
                 fmt::format("the server does not take the key ({})", keyed->status));
  return versions;
}

}  // namespace burr::lrs
