#include "burr/school/store_schema.h"

#include <span>

namespace burr::school {
namespace {

// ids TEXT, times BIGINT [ms since 1970, UTC], flags SMALLINT, JSON as TEXT: what both databases know.
constexpr Sql kFirst[] = {
    R"(CREATE TABLE learner (id TEXT PRIMARY KEY, created_ms BIGINT NOT NULL, level TEXT NOT NULL,
       handed TEXT NOT NULL, retain_until_ms BIGINT, consent_research SMALLINT NOT NULL))",
    R"(CREATE TABLE IF NOT EXISTS names.person (learner_id TEXT PRIMARY KEY, name TEXT, mail TEXT,
       external_id TEXT))",
    "CREATE TABLE cohort (id TEXT PRIMARY KEY, title TEXT NOT NULL UNIQUE)",
    R"(CREATE TABLE cohort_member (cohort_id TEXT NOT NULL REFERENCES cohort(id),
       learner_id TEXT NOT NULL REFERENCES learner(id), PRIMARY KEY (cohort_id, learner_id)))",
    "CREATE TABLE case_def (hash TEXT PRIMARY KEY, name TEXT NOT NULL, version BIGINT, text TEXT)",
    R"(CREATE TABLE rubric (hash TEXT PRIMARY KEY, name TEXT NOT NULL, version BIGINT, calibrated BIGINT,
       text TEXT))",
    R"(CREATE TABLE session (id TEXT PRIMARY KEY, learner_id TEXT REFERENCES learner(id),
       case_hash TEXT REFERENCES case_def(hash), started_ms BIGINT, seconds DOUBLE PRECISION, mode TEXT,
       guided SMALLINT, finished SMALLINT, attempt BIGINT, device TEXT, device_max_n DOUBLE PRECISION,
       voxel_um DOUBLE PRECISION, engine TEXT, recording_hash TEXT, recording_uri TEXT))",
    R"(CREATE TABLE score (id TEXT PRIMARY KEY, session_id TEXT NOT NULL REFERENCES session(id),
       rubric_hash TEXT NOT NULL REFERENCES rubric(hash), engine TEXT NOT NULL, part TEXT NOT NULL,
       total DOUBLE PRECISION, gates_broken BIGINT, assessable_weight DOUBLE PRECISION, made_ms BIGINT,
       UNIQUE (session_id, rubric_hash, engine, part)))",
    R"(CREATE TABLE item (score_id TEXT NOT NULL REFERENCES score(id), item_id TEXT NOT NULL,
       result TEXT NOT NULL, value DOUBLE PRECISION, threshold DOUBLE PRECISION, margin DOUBLE PRECISION,
       evidence_json TEXT, PRIMARY KEY (score_id, item_id)))",
    R"(CREATE TABLE metric (session_id TEXT NOT NULL REFERENCES session(id), name TEXT NOT NULL,
       unit TEXT NOT NULL, value DOUBLE PRECISION, PRIMARY KEY (session_id, name)))",
    R"(CREATE TABLE self_mark (session_id TEXT NOT NULL REFERENCES session(id), item_id TEXT NOT NULL,
       mark TEXT NOT NULL, PRIMARY KEY (session_id, item_id)))",
    R"(CREATE TABLE rater_mark (id TEXT PRIMARY KEY, session_id TEXT NOT NULL REFERENCES session(id),
       rater_id TEXT NOT NULL, item_id TEXT NOT NULL, mark TEXT NOT NULL, blinded SMALLINT NOT NULL, reason TEXT,
       made_ms BIGINT))",
    R"(CREATE TABLE standard (id TEXT PRIMARY KEY, rubric_hash TEXT REFERENCES rubric(hash), method TEXT,
       cut DOUBLE PRECISION, n_low BIGINT, n_high BIGINT, fp DOUBLE PRECISION, fn DOUBLE PRECISION, text TEXT))",
    R"(CREATE TABLE decision (session_set_json TEXT NOT NULL, learner_id TEXT NOT NULL REFERENCES learner(id),
       standard_id TEXT NOT NULL REFERENCES standard(id), outcome TEXT NOT NULL, confirmed_by TEXT NOT NULL,
       reason TEXT, made_ms BIGINT))",
    R"(CREATE TABLE outbox (id TEXT PRIMARY KEY, statement_json TEXT NOT NULL, state TEXT NOT NULL,
       tries BIGINT NOT NULL, next_ms BIGINT))",
    R"(CREATE TABLE audit (ms BIGINT NOT NULL, who TEXT NOT NULL, what TEXT NOT NULL, subject TEXT NOT NULL))",
};

// what the lists ask for
constexpr Sql kSecond[] = {
    "CREATE INDEX session_of_learner ON session(learner_id, started_ms)",
    "CREATE INDEX mark_of_session ON rater_mark(session_id)",
    "CREATE INDEX decision_on_learner ON decision(learner_id)",
    "CREATE INDEX member_in_cohort ON cohort_member(learner_id)",
    "CREATE INDEX outbox_next ON outbox(state, next_ms)",
};

// A server keeps the most frequent values of a column apart, for its planner: names and pseudonyms would outlive their
// rows there. No such figures are made, and a type that is set again drops those that are there.
constexpr Sql kThirdOfServer[] = {
    R"(ALTER TABLE names.person ALTER learner_id SET STATISTICS 0, ALTER name SET STATISTICS 0,
       ALTER mail SET STATISTICS 0, ALTER external_id SET STATISTICS 0)",
    R"(ALTER TABLE names.person ALTER learner_id TYPE TEXT, ALTER name TYPE TEXT, ALTER mail TYPE TEXT,
       ALTER external_id TYPE TEXT)",
    "ALTER TABLE learner ALTER id SET STATISTICS 0",
    "ALTER TABLE learner ALTER id TYPE TEXT",
    R"(ALTER TABLE session ALTER id SET STATISTICS 0, ALTER learner_id SET STATISTICS 0,
       ALTER recording_uri SET STATISTICS 0, ALTER recording_hash SET STATISTICS 0)",
    R"(ALTER TABLE session ALTER id TYPE TEXT, ALTER learner_id TYPE TEXT, ALTER recording_uri TYPE TEXT,
       ALTER recording_hash TYPE TEXT)",
    "ALTER TABLE cohort_member ALTER learner_id SET STATISTICS 0",
    "ALTER TABLE cohort_member ALTER learner_id TYPE TEXT",
    R"(ALTER TABLE decision ALTER learner_id SET STATISTICS 0, ALTER confirmed_by SET STATISTICS 0,
       ALTER session_set_json SET STATISTICS 0)",
    R"(ALTER TABLE decision ALTER learner_id TYPE TEXT, ALTER confirmed_by TYPE TEXT,
       ALTER session_set_json TYPE TEXT)",
    "ALTER TABLE rater_mark ALTER rater_id SET STATISTICS 0, ALTER session_id SET STATISTICS 0",
    "ALTER TABLE rater_mark ALTER rater_id TYPE TEXT, ALTER session_id TYPE TEXT",
    "ALTER TABLE outbox ALTER statement_json SET STATISTICS 0",
    "ALTER TABLE outbox ALTER statement_json TYPE TEXT",
    "ALTER TABLE audit ALTER who SET STATISTICS 0, ALTER subject SET STATISTICS 0",
    "ALTER TABLE audit ALTER who TYPE TEXT, ALTER subject TYPE TEXT",
    "ALTER TABLE score ALTER session_id SET STATISTICS 0",
    "ALTER TABLE score ALTER session_id TYPE TEXT",
    "ALTER TABLE metric ALTER session_id SET STATISTICS 0",
    "ALTER TABLE metric ALTER session_id TYPE TEXT",
    "ALTER TABLE self_mark ALTER session_id SET STATISTICS 0",
    "ALTER TABLE self_mark ALTER session_id TYPE TEXT",
};

// who set a standard, for which part of a score, when, and by how many judges; a decision can be named
constexpr Sql kFourth[] = {
    "ALTER TABLE standard ADD COLUMN part TEXT",   "ALTER TABLE standard ADD COLUMN judges BIGINT",
    "ALTER TABLE standard ADD COLUMN set_by TEXT", "ALTER TABLE standard ADD COLUMN made_ms BIGINT",
    "ALTER TABLE decision ADD COLUMN id TEXT",
};
// the same; no figures of names for the planner here either
constexpr Sql kFourthOfServer[] = {
    kFourth[0], kFourth[1], kFourth[2],
    kFourth[3], kFourth[4], "ALTER TABLE standard ALTER set_by SET STATISTICS 0",
};

// stations and their seals; how far a session is believed; the audit as a chain
constexpr Sql kStation =
    R"(CREATE TABLE station (name TEXT PRIMARY KEY, key TEXT NOT NULL UNIQUE, kind TEXT NOT NULL,
       enrolled_ms BIGINT NOT NULL, enrolled_by TEXT NOT NULL, revoked_ms BIGINT, revoked_by TEXT))";
constexpr Sql kSeal =
    R"(CREATE TABLE seal (session_id TEXT PRIMARY KEY REFERENCES session(id),
       nonce TEXT NOT NULL UNIQUE REFERENCES nonce(nonce), station TEXT NOT NULL REFERENCES station(name),
       given_ms BIGINT NOT NULL, ended_ms BIGINT NOT NULL, bone_hash TEXT NOT NULL, head TEXT NOT NULL,
       start_signature TEXT NOT NULL, signature TEXT NOT NULL))";
constexpr Sql kStanding = "ALTER TABLE session ADD COLUMN standing TEXT";
constexpr Sql kAuditNumber = "ALTER TABLE audit ADD COLUMN number BIGINT";
constexpr Sql kAuditSalt = "ALTER TABLE audit ADD COLUMN salt TEXT";
constexpr Sql kAuditDigest = "ALTER TABLE audit ADD COLUMN digest TEXT";
constexpr Sql kAuditHash = "ALTER TABLE audit ADD COLUMN hash TEXT";
constexpr Sql kAuditIndex = "CREATE UNIQUE INDEX audit_in_order ON audit(number)";
constexpr Sql kDecisionKey = "ALTER TABLE decision ADD COLUMN signature TEXT";
constexpr Sql kFifth[] = {
    kStation,
    R"(CREATE TABLE nonce (nonce TEXT PRIMARY KEY, station TEXT NOT NULL REFERENCES station(name),
       learner_id TEXT NOT NULL REFERENCES learner(id), mode TEXT NOT NULL, case_hash TEXT NOT NULL,
       rubric_hash TEXT NOT NULL, given_ms BIGINT NOT NULL))",
    R"(CREATE TABLE nonce_end (nonce TEXT PRIMARY KEY REFERENCES nonce(nonce), head TEXT NOT NULL,
       ended_ms BIGINT NOT NULL))",
    kSeal,
    kStanding,
    kAuditNumber,
    kAuditSalt,
    kAuditDigest,
    kAuditHash,
    kAuditIndex,
    kDecisionKey,
};
// the times are the server's own: a station has no right to write them (docs/teach/security.md)
constexpr Sql kFifthOfServer[] = {
    kStation,
    R"(CREATE TABLE nonce (nonce TEXT PRIMARY KEY, station TEXT NOT NULL REFERENCES station(name),
       learner_id TEXT NOT NULL REFERENCES learner(id), mode TEXT NOT NULL, case_hash TEXT NOT NULL,
       rubric_hash TEXT NOT NULL,
       given_ms BIGINT NOT NULL DEFAULT (extract(epoch FROM clock_timestamp()) * 1000)::bigint))",
    R"(CREATE TABLE nonce_end (nonce TEXT PRIMARY KEY REFERENCES nonce(nonce), head TEXT NOT NULL,
       ended_ms BIGINT NOT NULL DEFAULT (extract(epoch FROM clock_timestamp()) * 1000)::bigint))",
    kSeal,
    kStanding,
    kAuditNumber,
    kAuditSalt,
    kAuditDigest,
    kAuditHash,
    kAuditIndex,
    kDecisionKey,
    "ALTER TABLE nonce ALTER learner_id SET STATISTICS 0, ALTER nonce SET STATISTICS 0",
    "ALTER TABLE nonce_end ALTER nonce SET STATISTICS 0",
    "ALTER TABLE station ALTER enrolled_by SET STATISTICS 0, ALTER revoked_by SET STATISTICS 0",
    "ALTER TABLE audit ALTER salt SET STATISTICS 0, ALTER digest SET STATISTICS 0",
    "ALTER TABLE seal ALTER session_id SET STATISTICS 0, ALTER nonce SET STATISTICS 0",
};

constexpr Sql kNames[] = {
    R"(CREATE TABLE IF NOT EXISTS names.person (learner_id TEXT PRIMARY KEY, name TEXT, mail TEXT,
       external_id TEXT))",
};

// From version v to the next one.
std::span<const Sql> step(std::int64_t v, Database::Kind kind) {
  if (v == 0) return kFirst;
  if (v == 1) return kSecond;
  const bool server = kind == Database::Kind::postgres;
  if (v == 2) return server ? std::span<const Sql>(kThirdOfServer) : std::span<const Sql>();
  if (v == 3) return server ? std::span<const Sql>(kFourthOfServer) : std::span<const Sql>(kFourth);
  return server ? std::span<const Sql>(kFifthOfServer) : std::span<const Sql>(kFifth);
}
static_assert(kSchema == 5);

Result<std::int64_t> version_of(Database& database) {
  const auto there =
      database.kind() == Database::Kind::sqlite
          ? database.rows("SELECT 1 FROM sqlite_master WHERE name = 'schema_version'")
          : database.rows(
                "SELECT 1 FROM (SELECT to_regclass('schema_version') AS r) AS t "
                "WHERE r IS NOT NULL");
  if (!there) return there.error();
  if (there->empty()) return std::int64_t{0};
  const auto newest = database.rows("SELECT max(v) FROM schema_version");
  if (!newest) return newest.error();
  return newest->empty() ? std::int64_t{0} : whole((*newest)[0][0]);
}

Status run_all(Database& database, std::span<const Sql> statements) {
  for (const Sql one : statements)
    if (const auto done = database.run(one); !done) return done.error();
  return fine();
}

// Names lie in a file of their own, which may be lost, or not yet written when the store was made.
Status make_names(Database& database) {
  const auto there = database.rows("SELECT 1 FROM names.sqlite_master WHERE name = 'person'");
  if (!there) return there.error();
  return there->empty() ? run_all(database, kNames) : fine();
}

Result<std::int64_t> bring_tables_to(Database& database, std::int64_t now_ms, std::int64_t to) {
  auto version = version_of(database);
  if (!version || *version >= to) return version;
  auto change = Transaction::begin(database);
  if (!change) return change.error();
  if (database.kind() == Database::Kind::postgres) {
    // one station at a time; the others wait here and then find it done
    if (const auto alone =
            database.rows("SELECT 1 FROM (SELECT pg_advisory_xact_lock(7237234)) AS t");
        !alone)
      return alone.error();
  }
  version = version_of(database);
  if (!version || *version >= to) return version;
  if (*version == 0) {
    if (const auto made = database.run(
            "CREATE TABLE schema_version (v BIGINT PRIMARY KEY, applied_ms BIGINT NOT NULL)");
        !made)
      return made.error();
    if (database.kind() == Database::Kind::postgres)
      if (const auto made = database.run("CREATE SCHEMA IF NOT EXISTS names"); !made)
        return made.error();
  }
  for (std::int64_t v = *version; v < to; ++v) {
    if (const Status done = run_all(database, step(v, database.kind())); !done) return done.error();
    if (const auto noted = database.run(
            "INSERT INTO schema_version (v, applied_ms) VALUES ($1, $2)", {v + 1, now_ms});
        !noted)
      return noted.error();
  }
  if (const Status done = change->commit(); !done) return done.error();
  return to;
}

}  // namespace

Result<std::int64_t> bring_to(Database& database, std::int64_t now_ms, std::int64_t to) {
  auto version = bring_tables_to(database, now_ms, to);
  if (version && *version <= kSchema && database.kind() == Database::Kind::sqlite)
    if (const Status made = make_names(database); !made) return made.error();
  return version;
}

}  // namespace burr::school
