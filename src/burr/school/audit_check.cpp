#include "burr/school/audit_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "burr/base/printable.h"
#include "burr/school/audit_row.h"
#include "burr/school/decisions.h"
#include "burr/school/enrolled.h"
#include "burr/school/signing_key.h"

namespace burr::school {
namespace {

Error broken(std::int64_t number, const char* how) {
  return error(Trouble::failed,
               fmt::format("row {} of the audit {}, so the store was changed behind burr's back; "
                           "compare it with a copy, and restore that",
                           number, how));
}

Status check_rows(Store& store, const std::string& since, AuditFound& found) {
  const auto rows = store.database().rows(
      "SELECT number, ms, who, what, subject, salt, digest, hash FROM audit ORDER BY number");
  if (!rows) return rows.error();
  std::string before;
  bool seen = since.empty();
  for (const Row& row : *rows) {
    if (is_null(row[0])) {
      ++found.older;
      continue;
    }
    const std::int64_t number = whole(row[0]);
    const std::string salt = text(row[5]), digest = text(row[6]);
    if (number != ++found.rows) return broken(found.rows, "is missing");
    if (text(row[7]) != audit_hash(before, number, whole(row[1]), text(row[3]), digest))
      return broken(number, "does not give its hash");
    const bool forgotten = salt.empty();
    found.forgotten += forgotten ? 1 : 0;
    if (!forgotten && digest != audit_digest(salt, text(row[2]), text(row[4])))
      return broken(number, "names somebody else than it did");
    if (forgotten && !text(row[2]).empty() && text(row[2]) != "forgotten")
      return broken(number, "names somebody, though it was forgotten who that is");
    before = text(row[7]);
    seen = seen || before == since;
  }
  found.head = before;
  if (seen) return fine();
  return error(
      Trouble::failed,
      fmt::format("the audit does not hold {} any more, so rows at its end were taken out; "
                  "compare the store with a copy, and restore that",
                  base::printable(since)));
}

Status check_seals(Store& store, AuditFound& found) {
  const auto people = enrolled(store);
  if (!people) return people.error();
  std::map<std::string, std::string> keys;
  for (const Enrolled& one : *people) keys[one.name] = one.key;
  const auto rows = store.database().rows(
      "SELECT seal.session_id, seal.station, seal.nonce, seal.given_ms, seal.ended_ms, "
      "session.learner_id, session.mode, session.case_hash, nonce.rubric_hash, seal.bone_hash, "
      "session.device, seal.start_signature, seal.head, seal.signature, session.started_ms "
      "FROM seal JOIN session ON session.id = seal.session_id JOIN nonce "
      "ON nonce.nonce = seal.nonce ORDER BY seal.given_ms");
  if (!rows) return rows.error();
  for (const Row& row : *rows) {
    const Seal seal{text(row[1]),  text(row[2]),  whole(row[3]), whole(row[4]), text(row[5]),
                    text(row[6]),  text(row[7]),  text(row[8]),  text(row[9]),  text(row[10]),
                    text(row[11]), text(row[12]), text(row[13])};
    const std::string& key = keys[seal.station];
    if (!signed_by(key, start_words(seal), seal.start_signature) ||
        !signed_by(key, end_words(seal), seal.signature) || whole(row[14]) != seal.given_ms)
      return error(Trouble::failed,
                   fmt::format("session {}: its seal does not fit its row, so learner, mode, case, "
                               "device or time were changed in the store; restore it from a copy",
                               text(row[0])));
    ++found.seals;
  }
  return fine();
}

Status check_decisions(Store& store, AuditFound& found) {
  const auto people = enrolled(store);
  if (!people) return people.error();
  const auto all = decisions(store);
  if (!all) return all.error();
  for (const Decision& one : *all) {
    if (one.signature.empty()) continue;  // by a login of the server, or older
    const auto who = std::find_if(people->begin(), people->end(), [&one](const Enrolled& each) {
      return each.name == one.confirmed_by;
    });
    if (who == people->end() || !signed_by(who->key, decision_words(one), one.signature))
      return error(
          Trouble::failed,
          fmt::format("decision {}: its signature does not fit it, so it was changed in the "
                      "store; restore it from a copy",
                      one.id));
    ++found.decisions;
  }
  return fine();
}

}  // namespace

Result<AuditFound> check_audit(Store& store, const std::string& since) {
  AuditFound found;
  for (const Status& done :
       {check_rows(store, since, found), check_seals(store, found), check_decisions(store, found)})
    if (!done) return done.error();
  return found;
}

}  // namespace burr::school
