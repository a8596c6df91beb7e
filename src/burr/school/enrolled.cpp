#include "burr/school/enrolled.h"

#include <fmt/format.h>

#include <tuple>

#include "burr/base/printable.h"
#include "burr/school/signing_key.h"

namespace burr::school {
namespace {

constexpr std::int64_t kSlackMs = 2000;  // between the clock of the ticks and the store's

Error refused(const std::string& why) { return error(Trouble::usage, why); }

std::string hours(std::int64_t ms) { return fmt::format("{}", ms / 3'600'000); }

Result<std::optional<Enrolled>> station_in(Store& store, const std::string& name) {
  const auto all = enrolled(store);
  if (!all) return all.error();
  for (const Enrolled& one : *all)
    if (one.name == name && one.kind == "station") return std::optional<Enrolled>(one);
  return std::optional<Enrolled>();
}

// What the store wrote down when it gave the nonce.
struct Wrote {
  Seal seal;
  std::optional<std::int64_t> ended_ms;
};
Result<std::optional<Wrote>> nonce_in(Store& store, const std::string& nonce) {
  const auto found = store.database().rows(
      "SELECT nonce.station, nonce.learner_id, nonce.mode, nonce.case_hash, nonce.rubric_hash, "
      "nonce.given_ms, nonce_end.ended_ms, nonce_end.head FROM nonce LEFT JOIN nonce_end "
      "ON nonce_end.nonce = nonce.nonce WHERE nonce.nonce = $1",
      {nonce});
  if (!found) return found.error();
  if (found->empty()) return std::optional<Wrote>();
  const Row& row = found->front();
  Wrote out;
  out.seal.nonce = nonce;
  out.seal.station = text(row[0]);
  out.seal.learner = text(row[1]);
  out.seal.mode = text(row[2]);
  out.seal.case_hash = text(row[3]);
  out.seal.rubric_hash = text(row[4]);
  out.seal.given_ms = whole(row[5]);
  if (!is_null(row[6])) out.ended_ms = whole(row[6]);
  out.seal.head = text(row[7]);
  return std::optional<Wrote>(out);
}

// The seal says of itself what the session is.
Status check_words(const SessionRecord& record) {
  const Seal& seal = *record.seal;
  for (const auto& [name, sealed, is] :
       {std::tuple{"learner", &seal.learner, &record.learner},
        std::tuple{"mode", &seal.mode, &record.mode},
        std::tuple{"case", &seal.case_hash, &record.work_case.hash},
        std::tuple{"device", &seal.device, &record.device}})
    if (*sealed != *is)
      return refused(
          fmt::format("the seal is about {} {}, and the session is about {} {}; use the "
                      "original file",
                      name, base::printable(*sealed), name, base::printable(*is)));
  return fine();
}

Status check_signatures(const Enrolled& station, const Seal& seal) {
  const bool start = signed_by(station.key, start_words(seal), seal.start_signature);
  if (start && (!seal.ended() || signed_by(station.key, end_words(seal), seal.signature)))
    return fine();
  return refused(
      fmt::format("the seal of its {} is not that of station {}: the signature does not fit what "
                  "it says, so the "
                  "recording or the seal was changed; use the original file",
                  start ? "end" : "start", station.name));
}

// What the station says under its signature is what the store gave.
Status check_nonce(const Enrolled& station, const Seal& seal, const Wrote& wrote) {
  for (const auto& [name, says, gave] :
       {std::tuple{"station", &seal.station, &wrote.seal.station},
        std::tuple{"learner", &seal.learner, &wrote.seal.learner},
        std::tuple{"mode", &seal.mode, &wrote.seal.mode},
        std::tuple{"case", &seal.case_hash, &wrote.seal.case_hash},
        std::tuple{"rubric", &seal.rubric_hash, &wrote.seal.rubric_hash}})
    if (*says != *gave)
      return refused(
          fmt::format("its nonce was given for {} {}, and its seal says {} {}; enter the "
                      "session that the nonce was given for",
                      name, base::printable(*gave), name, base::printable(*says)));
  if (seal.given_ms != wrote.seal.given_ms ||
      (seal.ended() && wrote.ended_ms && seal.ended_ms != *wrote.ended_ms))
    return refused(
        "its seal says another time than this store's clock gave; use the original file");
  if (station.revoked_ms && *station.revoked_ms <= (seal.ended() ? seal.ended_ms : seal.given_ms))
    return refused(fmt::format(
        "station {} was revoked before the session ended, so its seal is not believed; enrol the "
        "station under a new name and repeat the session",
        station.name));
  return fine();
}

Status check_end(Store& store, const SessionRecord& record, const Wrote& wrote) {
  const Seal& seal = *record.seal;
  if (!wrote.ended_ms)
    return refused(
        "its nonce was never closed in this store; enter it into the store that closed it");
  if (seal.ended_ms - seal.given_ms > kNonceLivesMs)
    return refused(
        fmt::format("its nonce was closed more than {} hours after it was given, so it is "
                    "too old; repeat the session",
                    hours(kNonceLivesMs)));
  const auto lasted = static_cast<std::int64_t>(1000 * record.seconds);
  if (lasted > seal.ended_ms - seal.given_ms + kSlackMs)
    return refused(
        fmt::format("the session lasts {:.0f} s, and by the store's clock only {:.0f} s went by, "
                    "so nobody worked "
                    "that long; repeat the session",
                    record.seconds, 1e-3 * static_cast<double>(seal.ended_ms - seal.given_ms)));
  if (wrote.seal.head != seal.head)
    return refused(
        "its nonce was closed for another recording, so it was used twice; enter that recording");
  const auto used =
      store.database().rows("SELECT session_id FROM seal WHERE nonce = $1", {seal.nonce});
  if (!used) return used.error();
  if (!used->empty() && text((*used)[0][0]) != session_id(record))
    return refused("its nonce belongs to another session of the store; enter each session once");
  return fine();
}

}  // namespace

Status enrol(Store& store, const Enrolled& one) {
  if (const Status may = store.may_write(); !may) return may;
  if (const Status good = check_key_name(one.name); !good) return good;
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  const auto all = enrolled(store);
  if (!all) return all.error();
  for (const Enrolled& other : *all)
    if (other.name == one.name || other.key == one.key)
      return error(
          Trouble::usage,
          fmt::format("name {}: the store knows {} already, {}; choose a new name and a new "
                      "key",
                      one.name, other.name == one.name ? "this name" : "its key",
                      other.revoked_ms ? "revoked" : "enrolled"));
  const auto put = store.database().run(
      "INSERT INTO station (name, key, kind, enrolled_ms, enrolled_by) VALUES ($1, $2, $3, $4, $5)",
      {one.name, one.key, one.kind, now_ms(), store.place().who});
  if (!put) return put.error();
  if (const Status noted = store.note(one.kind + " enrolled", one.name); !noted) return noted;
  return change->commit();
}

Result<std::vector<Enrolled>> enrolled(Store& store) {
  const auto found = store.database().rows(
      "SELECT name, key, kind, enrolled_ms, enrolled_by, revoked_ms, revoked_by FROM station "
      "ORDER BY enrolled_ms, name");
  if (!found) return found.error();
  std::vector<Enrolled> all;
  for (const Row& row : *found) {
    Enrolled one{text(row[0]), text(row[1]), text(row[2]), whole(row[3]), text(row[4])};
    if (!is_null(row[5])) one.revoked_ms = whole(row[5]);
    one.revoked_by = text(row[6]);
    all.push_back(std::move(one));
  }
  return all;
}

Status revoke(Store& store, const std::string& name) {
  if (const Status may = store.may_write(); !may) return may;
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  const auto done = store.database().run(
      "UPDATE station SET revoked_ms = $2, revoked_by = $3 WHERE name = $1 AND revoked_ms IS NULL",
      {name, now_ms(), store.place().who});
  if (!done) return done.error();
  if (*done == 0)
    return error(
        Trouble::usage,
        fmt::format("name {}: nothing of this name is enrolled now; `school::enrolled` lists "
                    "what is",
                    base::printable(name)));
  if (const Status noted = store.note("revoked", name); !noted) return noted;
  return change->commit();
}

Result<Given> give_nonce(Store& store, const Seal& asked) {
  if (const Status may = store.may_write(); !may) return may.error();
  const auto station = station_in(store, asked.station);
  if (!station) return station.error();
  if (!*station || (*station)->revoked_ms)
    return error(Trouble::usage,
                 fmt::format("station {}: the store {}; `school::enrol` makes it known",
                             base::printable(asked.station),
                             *station ? "has revoked it" : "does not know it"));
  const auto known = has(store, asked.learner);
  if (!known) return known.error();
  if (!*known)
    return error(Trouble::usage,
                 fmt::format("{}: there is no such learner in the store; `school::add` enters one",
                             base::printable(asked.learner)));
  // the server's own clock, which a station with rights on the other columns alone cannot set
  const Given given{random_digits(16), 0};
  const Values values = {given.nonce, asked.station,   asked.learner,
                         asked.mode,  asked.case_hash, asked.rubric_hash};
  const auto put =
      store.database().kind() == Database::Kind::postgres
          ? store.database().run(
                "INSERT INTO nonce (nonce, station, learner_id, mode, case_hash, rubric_hash) "
                "VALUES "
                "($1, $2, $3, $4, $5, $6)",
                values)
          : store.database().run(
                "INSERT INTO nonce (nonce, station, learner_id, mode, case_hash, rubric_hash, "
                "given_ms) VALUES ($1, $2, $3, $4, $5, $6, "
                "CAST((julianday('now') - 2440587.5) * 86400000 AS INTEGER))",
                values);
  if (!put) return put.error();
  const auto wrote = nonce_in(store, given.nonce);
  if (!wrote) return wrote.error();
  return Given{given.nonce, *wrote ? (*wrote)->seal.given_ms : 0};
}

Result<std::int64_t> end_nonce(Store& store, const std::string& nonce, const std::string& head) {
  if (const Status may = store.may_write(); !may) return may.error();
  const auto wrote = nonce_in(store, nonce);
  if (!wrote) return wrote.error();
  if (!*wrote)
    return refused("the nonce of this session is not of this store; begin a new session");
  if ((*wrote)->ended_ms)
    return refused("the nonce of this session was closed before; begin a new session");
  const auto put = store.database().kind() == Database::Kind::postgres
                       ? store.database().run("INSERT INTO nonce_end (nonce, head) VALUES ($1, $2)",
                                              {nonce, head})
                       : store.database().run(
                             "INSERT INTO nonce_end (nonce, head, ended_ms) VALUES ($1, $2, "
                             "CAST((julianday('now') - 2440587.5) * 86400000 AS INTEGER))",
                             {nonce, head});
  if (!put) return put.error();
  const auto now = nonce_in(store, nonce);
  if (!now) return now.error();
  return *now ? (*now)->ended_ms.value_or(0) : 0;
}

namespace {

Result<std::string> standing_in(Store& store, const SessionRecord& record) {
  if (!record.goes_on_with.empty()) return std::string(standing::kContinued);
  if (!record.seal) return std::string(standing::kNoSeal);
  const Seal& seal = *record.seal;
  if (const Status same = check_words(record); !same) return same.error();
  const auto station = station_in(store, seal.station);
  if (!station) return station.error();
  if (!*station) return std::string(standing::kUnknownStation);
  if (const Status good = check_signatures(**station, seal); !good) return good.error();
  const auto wrote = nonce_in(store, seal.nonce);
  if (!wrote) return wrote.error();
  if (!*wrote)
    return refused(
        "its nonce was not given by this store, so the session is not of this store, or its nonce "
        "is "
        "an old one; enter it into the store that gave the nonce");
  if (const Status same = check_nonce(**station, seal, **wrote); !same) return same.error();
  if (!seal.ended()) {
    if ((*wrote)->ended_ms)
      return refused(
          "its nonce was closed in this store, and the recording has no seal of its end, so it was "
          "cut "
          "off, or the disk was full; use the original file");
    return std::string(standing::kNoEnd);
  }
  if (const Status good = check_end(store, record, **wrote); !good) return good.error();
  if (!is_persons_hand(seal.device)) return std::string(standing::kNoPerson);
  return std::string(record.replayed ? standing::kSealed : standing::kNotReplayed);
}

}  // namespace

Result<std::string> check_seal(Store& store, const SessionRecord& record) {
  auto found = standing_in(store, record);
  if (found || found.error().trouble != Trouble::usage || record.recording_uri.empty())
    return found;
  const std::string file = record.recording_uri.substr(record.recording_uri.rfind('/') + 1);
  return error(Trouble::usage, fmt::format("{}: {}", base::printable(file), found.error().text));
}

Result<bool> keep_seal(Store& store, const SessionRecord& record) {
  const Seal& seal = *record.seal;
  const auto put = store.database().run(
      "INSERT INTO seal (session_id, nonce, station, given_ms, ended_ms, bone_hash, head, "
      "start_signature, signature) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9) ON CONFLICT DO "
      "NOTHING",
      {session_id(record), seal.nonce, seal.station, seal.given_ms, seal.ended_ms, seal.bone_hash,
       seal.head, seal.start_signature, seal.signature});
  if (!put) return put.error();
  return *put > 0;
}

}  // namespace burr::school
