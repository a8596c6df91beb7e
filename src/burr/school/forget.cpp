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
#include "burr/school/statements.h"
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

void delete_recording(const std::string& path, const fs::path& folder, Forgotten& done) {
  std::error_code trouble;
  // its report; and where the window keeps sessions, its account
  const bool kept =
      !folder.empty() && fs::equivalent(fs::path(path).parent_path(), folder, trouble);
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

void delete_recording(const SessionRow& session, const fs::path& folder, Forgotten& done) {
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
    delete_recording(path, folder, done);
  }
}

bool names_learner(const Json& statement, const std::string& learner) {
  const auto actor = statement.find("actor");
  if (actor == statement.end() || !actor->is_object()) return false;
  const auto account = actor->find("account");
  return account != actor->end() && account->is_object() && account->value("name", "") == learner;
}

Status void_statements(Store& store, const std::string& learner, Forgotten& done) {
  Database& in = store.database();
  const auto all = in.rows("SELECT id, statement_json, state, tries FROM outbox");
  if (!all) return all.error();
  for (const Row& row : *all) {
    if (!is_about(text(row[1]), learner)) continue;
    const Json statement = Json::parse(text(row[1]), nullptr, false);
    const bool read = statement.is_object();
    const std::string id = text(row[0]);
    if (const auto gone = in.run("DELETE FROM outbox WHERE id = $1", {id}); !gone)
      return gone.error();
    // one that was tried may have arrived, though nobody heard of it
    if (!read || (text(row[2]) != "sent" && whole(row[3]) == 0)) continue;
    const Statement back = voiding(id, statement["actor"]["account"].value("homePage", ""));
    const auto put = in.run(
        "INSERT INTO outbox (id, statement_json, state, tries, next_ms) "
        "VALUES ($1, $2, 'waiting', 0, 0) ON CONFLICT DO NOTHING",
        {back.id, back.json});
    if (!put) return put.error();
    ++done.voided;
  }
  return fine();
}

// What hangs on a learner, the leaves first.
constexpr Sql kDeletes[] = {
    R"(DELETE FROM item WHERE score_id IN (SELECT score.id FROM score JOIN session ON session.id = score.session_id
       WHERE session.learner_id = $1))",
    "DELETE FROM score WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1)",
    "DELETE FROM metric WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1)",
    "DELETE FROM self_mark WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1)",
    "DELETE FROM rater_mark WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1)",
    "DELETE FROM seal WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1)",
    "DELETE FROM decision WHERE learner_id = $1",
    // whoever did it may be the learner
    R"(UPDATE audit SET subject = '', who = '', salt = '' WHERE subject IN
       (SELECT id FROM session WHERE learner_id = $1))",
    "UPDATE audit SET subject = '', who = '', salt = '' WHERE subject = $1",
    "UPDATE audit SET who = 'forgotten', salt = '' WHERE who = $1",
    "UPDATE rater_mark SET rater_id = 'forgotten' WHERE rater_id = $1",
    "UPDATE decision SET confirmed_by = 'forgotten', signature = NULL WHERE confirmed_by = $1",
    "UPDATE standard SET set_by = 'forgotten' WHERE set_by = $1",
    "DELETE FROM nonce_end WHERE nonce IN (SELECT nonce FROM nonce WHERE learner_id = $1)",
    "DELETE FROM nonce WHERE learner_id = $1",
    "DELETE FROM session WHERE learner_id = $1",
    "DELETE FROM cohort_member WHERE learner_id = $1",
    "DELETE FROM learner WHERE id = $1",
};

constexpr Sql kScrubFile[] = {"VACUUM main", "VACUUM names"};
// tables that held something of a learner are written anew
constexpr Sql kScrubServer[] = {
    "VACUUM (FULL, ANALYZE) names.person", "VACUUM (FULL, ANALYZE) item",
    "VACUUM (FULL, ANALYZE) score",        "VACUUM (FULL, ANALYZE) metric",
    "VACUUM (FULL, ANALYZE) self_mark",    "VACUUM (FULL, ANALYZE) rater_mark",
    "VACUUM (FULL, ANALYZE) decision",     "VACUUM (FULL, ANALYZE) outbox",
    "VACUUM (FULL, ANALYZE) standard",     "VACUUM (FULL, ANALYZE) audit",
    "VACUUM (FULL, ANALYZE) session",      "VACUUM (FULL, ANALYZE) cohort_member",
    "VACUUM (FULL, ANALYZE) learner",      "VACUUM (FULL, ANALYZE) seal",
    "VACUUM (FULL, ANALYZE) nonce",        "VACUUM (FULL, ANALYZE) nonce_end",
};

// In a change of its own: with SQLite the names are another file, and nothing is whole over both.
Result<bool> delete_name(Store& store, const std::string& learner) {
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  const auto gone =
      store.database().run("DELETE FROM names.person WHERE learner_id = $1", {learner});
  if (!gone) return gone.error();
  if (const Status done = change->commit(); !done) return done.error();
  return *gone > 0;
}

Status delete_rows(Store& store, const std::string& learner, Forgotten& done) {
  if (const Status voided = void_statements(store, learner, done); !voided) return voided;
  for (const Sql one : kDeletes)
    if (const auto gone = store.database().run(one, {learner}); !gone) return gone.error();
  // a cohort of nobody says nothing
  const auto empty = store.database().run(
      "DELETE FROM cohort WHERE NOT EXISTS "
      "(SELECT 1 FROM cohort_member WHERE cohort_id = cohort.id)");
  if (!empty) return empty.error();
  return store.note("learner forgotten", "");
}

void delete_waiting(Store& store, const std::string& learner, const Recordings& more,
                    Forgotten& done) {
  std::error_code ignored;
  for (const Waiting& one : waiting(store.place(), done.notices)) {
    if ((one.session ? one.session->learner : one.recording->learner) != learner) continue;
    if (one.recording) delete_recording(one.recording->file, more.folder, done);
    fs::remove(one.file, ignored);
    ++done.waiting;
  }
  const Leftovers left = leftovers(store.place(), learner);
  for (const fs::path& file : left.holding) {
    if (fs::remove(file, ignored)) done.deleted.push_back(file.string());
    if (fs::exists(file, ignored)) done.unreached.push_back(file.string());
  }
  for (const fs::path& file : left.unread)
    done.unreached.push_back(file.string() + " (it cannot be read)");
}

}  // namespace

bool is_about(const std::string& statement, const std::string& learner) {
  const Json read = Json::parse(statement, nullptr, false);
  return read.is_object() ? names_learner(read, learner)
                          : statement.find(learner) != std::string::npos;
}

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

Result<Forgotten> forget(Store& store, const std::string& learner, const Recordings& more) {
  if (const Status may = store.may_write(); !may) return may.error();
  const auto known = has(store, learner);
  if (!known) return known.error();
  const auto named = delete_name(store, learner);
  if (!named) return named.error();
  if (!*known && !*named)
    return error(Trouble::usage,
                 fmt::format("{}: there is no such learner; `school::learners` lists them",
                             base::printable(learner)));
  Forgotten done;
  {
    auto change = Transaction::begin(store.database());
    if (!change) return change.error();
    // no session of this learner comes in from here on; SQLite lets nobody else write anyway
    if (store.database().kind() == Database::Kind::postgres)
      if (const auto alone =
              store.database().rows("SELECT id FROM learner WHERE id = $1 FOR UPDATE", {learner});
          !alone)
        return alone.error();
    // nor marks of its sessions (ratings.cpp)
    if (store.database().kind() == Database::Kind::postgres)
      if (const auto alone = store.database().rows(
              "SELECT pg_advisory_xact_lock(72372, hashtext(id)) FROM session "
              "WHERE learner_id = $1 ORDER BY id",
              {learner});
          !alone)
        return alone.error();
    const auto sessions = sessions_of(store, learner);
    if (!sessions) return sessions.error();
    done.sessions = sessions->size();
    if (const Status gone = delete_rows(store, learner, done); !gone) return gone.error();
    for (const SessionRow& session : *sessions) delete_recording(session, more.folder, done);
    for (const std::string& path : more.mine) delete_recording(path, more.folder, done);
    delete_waiting(store, learner, more, done);
    if (const Status kept = change->commit(); !kept) return kept.error();
  }
  done.unreached.insert(done.unreached.end(), more.unread.begin(), more.unread.end());
  if (const Status clean = scrub(store); !clean)
    done.notices.push_back(fmt::format(
        "the rows are deleted, but their bytes may still be in the files of the store ({}); close "
        "burr elsewhere and run `school::scrub`",
        clean.error().text));
  return done;
}

}  // namespace burr::school
