#include "burr/school/forget.h"

#include <fmt/format.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "burr/base/printable.h"
#include "burr/school/pending.h"
#include "burr/school/sessions.h"
#include "burr/school/uuid.h"

namespace burr::school {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string computer() {
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return host.data();
}

void delete_recording(const std::string& path, Forgotten& done) {
  std::error_code trouble;
  // its report; and where the window keeps sessions, its account
  const bool kept = fs::path(path).parent_path().filename() == "sessions";
  for (const char* ending : {".html", ".json", ".toml"}) {
    const fs::path beside = fs::path(path).replace_extension(ending);
    if ((kept || beside.extension() == ".html") && fs::remove(beside, trouble))
      done.deleted.push_back(beside.string());
  }
  if (fs::remove(path, trouble))
    done.deleted.push_back(path);
  else if (trouble)
    done.unreached.push_back(fmt::format("{} ({})", path, trouble.message()));
}

void delete_recording(const SessionRow& session, Forgotten& done) {
  if (session.recording_uri.empty()) return;
  const std::string path = path_of(session.recording_uri);
  std::error_code nobody_asks;
  if (path.empty()) {
    done.unreached.push_back(session.recording_uri + " (on another computer)");
  } else if (!fs::exists(path, nobody_asks)) {
    done.unreached.push_back(session.recording_uri + " (not there any more)");
  } else if (const auto hash = sha1_of_file(path); !hash || *hash != session.recording_hash) {
    done.unreached.push_back(session.recording_uri + " (another file has its name now)");
  } else {
    delete_recording(path, done);
  }
}

bool is_about(const Json& statement, const std::string& learner) {
  const auto actor = statement.find("actor");
  if (actor == statement.end() || !actor->is_object()) return false;
  const auto account = actor->find("account");
  return account != actor->end() && account->is_object() && account->value("name", "") == learner;
}

// A statement that was sent is taken back by another one, which names nobody.
Json voiding(const Json& sent, const std::string& id) {
  const Json account = {{"homePage", sent["actor"]["account"].value("homePage", "")},
                        {"name", "burr"}};
  return {{"id", uuid_of(id, "voided")},
          {"actor", {{"objectType", "Agent"}, {"account", account}}},
          {"verb", {{"id", "http://adlnet.gov/expapi/verbs/voided"}}},
          {"object", {{"objectType", "StatementRef"}, {"id", id}}}};
}

Status void_statements(Store& store, const std::string& learner, Forgotten& done) {
  Database& in = store.database();
  const auto all = in.rows("SELECT id, statement_json, state FROM outbox");
  if (!all) return all.error();
  for (const Row& row : *all) {
    const Json statement = Json::parse(text(row[1]), nullptr, false);
    // what cannot be read is deleted where it holds the id at all
    const bool read = statement.is_object();
    if (read ? !is_about(statement, learner) : text(row[1]).find(learner) == std::string::npos)
      continue;
    const std::string id = text(row[0]);
    if (const auto gone = in.run("DELETE FROM outbox WHERE id = $1", {id}); !gone)
      return gone.error();
    if (!read || text(row[2]) != "sent") continue;
    const Json back = voiding(statement, id);
    const auto put = in.run(
        "INSERT INTO outbox (id, statement_json, state, tries, next_ms) "
        "VALUES ($1, $2, 'waiting', 0, 0) ON CONFLICT DO NOTHING",
        {back["id"].get<std::string>(), back.dump()});
    if (!put) return put.error();
    ++done.voided;
  }
  return fine();
}

// What hangs on a learner, the leaves first.
constexpr Sql kDeletes[] = {
    "DELETE FROM names.person WHERE learner_id = $1",
    "DELETE FROM item WHERE score_id IN (SELECT score.id FROM score JOIN session "
    "ON session.id = score.session_id WHERE session.learner_id = $1)",
    "DELETE FROM score WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1)",
    "DELETE FROM metric WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1)",
    "DELETE FROM self_mark WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1)",
    "DELETE FROM rater_mark WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1)",
    "DELETE FROM decision WHERE learner_id = $1",
    "UPDATE audit SET subject = '' WHERE subject IN (SELECT id FROM session WHERE learner_id = $1)",
    "UPDATE audit SET subject = '' WHERE subject = $1",
    "UPDATE audit SET who = 'forgotten' WHERE who = $1",
    "UPDATE rater_mark SET rater_id = 'forgotten' WHERE rater_id = $1",
    "UPDATE decision SET confirmed_by = 'forgotten' WHERE confirmed_by = $1",
    "DELETE FROM session WHERE learner_id = $1",
    "DELETE FROM cohort_member WHERE learner_id = $1",
    "DELETE FROM learner WHERE id = $1",
};

constexpr Sql kScrubFile[] = {"VACUUM main", "VACUUM names"};
// tables that held something of a learner are written anew
constexpr Sql kScrubServer[] = {
    "VACUUM FULL names.person", "VACUUM FULL item",          "VACUUM FULL score",
    "VACUUM FULL metric",       "VACUUM FULL self_mark",     "VACUUM FULL rater_mark",
    "VACUUM FULL decision",     "VACUUM FULL outbox",        "VACUUM FULL audit",
    "VACUUM FULL session",      "VACUUM FULL cohort_member", "VACUUM FULL learner",
};

Status delete_rows(Store& store, const std::string& learner, Forgotten& done) {
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  if (const Status voided = void_statements(store, learner, done); !voided) return voided;
  for (const Sql one : kDeletes)
    if (const auto gone = store.database().run(one, {learner}); !gone) return gone.error();
  // a cohort of nobody says nothing
  const auto empty = store.database().run(
      "DELETE FROM cohort WHERE NOT EXISTS "
      "(SELECT 1 FROM cohort_member WHERE cohort_id = cohort.id)");
  if (!empty) return empty.error();
  if (const Status noted = store.note("learner forgotten", ""); !noted) return noted;
  return change->commit();
}

}  // namespace

std::string uri_of(const std::string& path) {
  std::error_code nobody_asks;
  return "file://" + computer() + fs::absolute(path, nobody_asks).string();
}

std::string path_of(const std::string& uri) {
  const std::string here = "file://" + computer();
  return uri.rfind(here + "/", 0) == 0 ? uri.substr(here.size()) : std::string();
}

Status scrub(Store& store) {
  Database& in = store.database();
  if (in.kind() == Database::Kind::postgres) {
    for (const Sql one : kScrubServer)
      if (const auto done = in.run(one); !done) return done.error();
    return fine();
  }
  for (const Sql one : kScrubFile)
    if (const auto done = in.rows(one); !done) return done.error();
  for (const Sql one : {Sql("PRAGMA main.wal_checkpoint(TRUNCATE)"),
                        Sql("PRAGMA names.wal_checkpoint(TRUNCATE)")}) {
    const auto moved = in.rows(one);
    if (!moved) return moved.error();
    if (!moved->empty() && whole((*moved)[0][0]) != 0)
      return error(Trouble::io, "another program reads the store");
  }
  return fine();
}

Result<Forgotten> forget(Store& store, const std::string& learner,
                         const std::vector<std::string>& more) {
  if (const Status may = store.may_write(); !may) return may.error();
  const auto known = has(store, learner);
  if (!known) return known.error();
  if (!*known)
    return error(Trouble::usage, fmt::format("{}: there is no such learner; `burr learner list`",
                                             base::printable(learner)));
  const auto sessions = sessions_of(store, learner);
  if (!sessions) return sessions.error();
  Forgotten done;
  done.sessions = sessions->size();
  for (const SessionRow& session : *sessions) delete_recording(session, done);
  for (const std::string& path : more) delete_recording(path, done);
  std::error_code ignored;
  for (const Waiting& one : waiting(store.place(), done.notices)) {
    if ((one.session ? one.session->learner : one.recording->learner) != learner) continue;
    if (one.recording) delete_recording(one.recording->file, done);
    fs::remove(one.file, ignored);
    ++done.waiting;
  }
  if (const Status gone = delete_rows(store, learner, done); !gone) return gone.error();
  if (const Status clean = scrub(store); !clean)
    done.notices.push_back(fmt::format(
        "the rows are deleted, but their bytes may still be in the files of the store ({}); close "
        "burr elsewhere and run `burr learner forget --scrub`",
        clean.error().text));
  return done;
}

}  // namespace burr::school
