#include "burr/school/outbox.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "burr/base/printable.h"

namespace burr::school {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestSentence = 300;

Status ran(const Result<std::int64_t>& done) { return done ? fine() : Status(done.error()); }

// The row with the switch; an empty object where it is off.
Result<Json> settings(Store& store) {
  const auto rows =
      store.database().rows("SELECT statement_json FROM outbox WHERE id = 'settings'");
  if (!rows) return rows.error();
  if (rows->empty()) return Json::object();
  Json read = Json::parse(text((*rows)[0][0]), nullptr, false);
  return read.is_object() ? read : Json::object();
}

std::string text_in(const Json& json, const char* name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

Status queue(Store& store, const Statement& one) {
  return ran(
      store.database().run("INSERT INTO outbox (id, statement_json, state, tries, next_ms) "
                           "VALUES ($1, $2, 'waiting', 0, 0) ON CONFLICT DO NOTHING",
                           {one.id, one.json}));
}

void take_out(std::string& text, const std::string& part) {
  if (part.size() < 3) return;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos;)
    text.replace(at, part.size(), "...");
}

// A sentence outlives its statement in a server's figures and copies; it names nobody.
std::string without_names(std::string why, const Waiter& row) {
  const Json read = Json::parse(row.json, nullptr, false);
  if (read.is_object()) {
    const Json::json_pointer name("/actor/account/name"), registration("/context/registration");
    for (const Json::json_pointer& one : {name, registration})
      if (read.contains(one) && read[one].is_string()) take_out(why, read[one]);
  }
  take_out(why, row.id);
  return base::printable(why, kLongestSentence);
}

bool is_iri(const std::string& text) {
  const std::size_t colon = text.find(':');
  return colon != std::string::npos && colon > 0 && colon + 1 < text.size() &&
         text.find_first_of(" <>\"{}|\\^`") == std::string::npos &&
         std::none_of(text.begin(), text.end(),
                      [](char c) { return static_cast<unsigned char>(c) < 0x20; });
}

}  // namespace

std::int64_t wait_after(std::int64_t tries) {
  constexpr std::int64_t kFirst = 60'000, kMost = 6 * 3'600'000;
  return std::min(kMost, kFirst << std::clamp<std::int64_t>(tries - 1, 0, 10));
}

Result<std::string> home_page(Store& store) {
  const auto read = settings(store);
  if (!read) return read.error();
  return text_in(*read, "home_page");
}

Status set_home_page(Store& store, const std::string& iri) {
  if (const Status may = store.may_write(); !may) return may;
  if (!iri.empty() && !is_iri(iri))
    return error(
        Trouble::usage,
        fmt::format("`home_page` {}: use the centre's address, such as https://centre.example",
                    base::printable(iri, 200)));
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  if (const Status gone = ran(store.database().run("DELETE FROM outbox WHERE id = 'settings'"));
      !gone)
    return gone;
  if (!iri.empty())
    if (const Status put = ran(
            store.database().run("INSERT INTO outbox (id, statement_json, state, tries, next_ms) "
                                 "VALUES ('settings', $1, 'settings', 0, 0)",
                                 {Json{{"home_page", iri}}.dump()}));
        !put)
      return put;
  if (const Status noted = store.note(iri.empty() ? "xAPI off" : "xAPI on", ""); !noted)
    return noted;
  return change->commit();
}

Status queue_session(Store& store, const SessionRecord& record) {
  const auto page = home_page(store);
  if (!page) return page.error();
  if (page->empty()) return fine();
  for (const Statement& one : statements_of(record, *page))
    if (const Status put = queue(store, one); !put) return put;
  return fine();
}

Status queue_decision(Store& store, const Decided& decision) {
  const auto page = home_page(store);
  if (!page) return page.error();
  if (page->empty() || decision.sessions.empty()) return fine();
  const auto named = store.database().rows(
      "SELECT case_def.name FROM session JOIN case_def ON case_def.hash = session.case_hash "
      "WHERE session.id = $1",
      {decision.sessions.back()});
  if (!named) return named.error();
  const auto one =
      statement_of(decision, named->empty() ? std::string() : text((*named)[0][0]), *page);
  return one ? queue(store, *one) : fine();
}

Result<std::vector<Waiter>> take_due(Store& store, std::int64_t now, std::int64_t most, bool all) {
  Database& in = store.database();
  auto change = Transaction::begin(in);
  if (!change) return change.error();
  if (in.kind() == Database::Kind::postgres)  // two that send take turns here
    if (const auto alone = in.rows("SELECT 1 FROM (SELECT pg_advisory_xact_lock(7237235)) AS t");
        !alone)
      return alone.error();
  // by id: those of one session lie anywhere, and the server does not care
  const auto rows = in.rows(
      "SELECT id, statement_json, tries FROM outbox WHERE state IN ('waiting', 'trying') AND "
      "(next_ms <= $1 OR $3 = 1) ORDER BY next_ms, id LIMIT $2",
      {now, most, std::int64_t{all}});
  if (!rows) return rows.error();
  std::vector<Waiter> out;
  for (const Row& row : *rows) {
    out.push_back({text(row[0]), text(row[1]), whole(row[2]) + 1});
    if (const Status begun =
            ran(in.run("UPDATE outbox SET state = 'trying', tries = $2, next_ms = $3 WHERE id = $1",
                       {out.back().id, out.back().tries, now + wait_after(out.back().tries)}));
        !begun)
      return begun.error();
  }
  if (const Status done = change->commit(); !done) return done.error();
  return out;
}

Status mark_sent(Store& store, const std::vector<std::string>& ids) {
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  for (const std::string& id : ids)
    if (const Status put =
            ran(store.database().run("UPDATE outbox SET state = 'sent' WHERE id = $1", {id}));
        !put)
      return put;
  return change->commit();
}

Status park(Store& store, const Waiter& row, const std::string& why) {
  return ran(store.database().run("UPDATE outbox SET state = $2 WHERE id = $1",
                                  {row.id, "parked: " + without_names(why, row)}));
}

Status put_off(Store& store, const std::vector<std::string>& ids, std::int64_t until_ms) {
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  for (const std::string& id : ids)
    if (const Status put = ran(store.database().run(
            "UPDATE outbox SET state = 'waiting', next_ms = $2 WHERE id = $1", {id, until_ms}));
        !put)
      return put;
  return change->commit();
}

Result<std::int64_t> unpark(Store& store) {
  if (const Status may = store.may_write(); !may) return may.error();
  return store.database().run(
      "UPDATE outbox SET state = 'waiting', next_ms = 0 WHERE state LIKE 'parked: %'");
}

Status set_pause(Store& store, std::int64_t until_ms, const std::string& trouble) {
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  auto read = settings(store);
  if (!read) return read.error();
  if (read->empty()) return fine();  // off meanwhile
  (*read)["trouble"] = base::printable(trouble, kLongestSentence);
  if (const Status put = ran(store.database().run(
          "UPDATE outbox SET statement_json = $1, next_ms = $2 WHERE id = 'settings'",
          {read->dump(-1, ' ', false, Json::error_handler_t::replace), until_ms}));
      !put)
    return put;
  return change->commit();
}

Result<OutboxStatus> outbox_status(Store& store) {
  Database& in = store.database();
  OutboxStatus out;
  const auto read = settings(store);
  if (!read) return read.error();
  out.home_page = text_in(*read, "home_page");
  out.trouble = text_in(*read, "trouble");
  const auto rows = in.rows(
      "SELECT count(CASE WHEN state IN ('waiting', 'trying') THEN 1 END), "
      "count(CASE WHEN state = 'sent' THEN 1 END), "
      "count(CASE WHEN state LIKE 'parked: %' THEN 1 END), "
      "max(CASE WHEN id = 'settings' THEN next_ms ELSE 0 END), "
      "min(CASE WHEN state IN ('waiting', 'trying') THEN next_ms END) FROM outbox");
  if (!rows) return rows.error();
  const Row& row = (*rows)[0];
  out.waiting = whole(row[0]);
  out.sent = whole(row[1]);
  out.parked = whole(row[2]);
  out.not_before_ms = whole(row[3]);
  if (!is_null(row[4])) out.next_ms = whole(row[4]);
  const auto parked = in.rows(
      "SELECT id, statement_json, state FROM outbox WHERE state LIKE 'parked: %' ORDER BY id "
      "LIMIT 20");
  if (!parked) return parked.error();
  for (const Row& one : *parked) {
    const Json statement = Json::parse(text(one[1]), nullptr, false);
    const Json::json_pointer verb("/verb/id");
    std::string said =
        statement.is_object() && statement.contains(verb) && statement[verb].is_string()
            ? statement[verb].get<std::string>()
            : std::string();
    out.first_parked.push_back(
        {text(one[0]), said.substr(said.rfind('/') + 1), text(one[2]).substr(8)});
  }
  return out;
}

}  // namespace burr::school
