#include "burr/school/audit_row.h"

#include <fmt/format.h>

#include "burr/school/signing_key.h"

namespace burr::school {

std::string audit_digest(const std::string& salt, const std::string& who,
                         const std::string& subject) {
  return sha256(fmt::format("{}\n{}\n{}", salt, who, subject));
}

std::string audit_hash(const std::string& before, std::int64_t number, std::int64_t ms,
                       const std::string& what, const std::string& digest) {
  return sha256(fmt::format("{}\n{}\n{}\n{}\n{}", before, number, ms, what, digest));
}

Status add_to_audit(Database& database, std::int64_t ms, const std::string& who,
                    std::string_view what, std::string_view subject) {
  if (database.kind() ==
      Database::Kind::postgres)  // one after the other; a file lets only one write
    if (const auto alone =
            database.rows("SELECT 1 FROM (SELECT pg_advisory_xact_lock(7237235)) AS t");
        !alone)
      return alone.error();
  const auto last = database.rows(
      "SELECT number, hash FROM audit WHERE number IS NOT NULL ORDER BY number DESC LIMIT 1");
  if (!last) return last.error();
  const std::int64_t number = last->empty() ? 1 : whole((*last)[0][0]) + 1;
  const std::string before = last->empty() ? std::string() : text((*last)[0][1]);
  const std::string salt = random_digits(16), about(subject), did(what);
  const std::string digest = audit_digest(salt, who, about);
  const auto put = database.run(
      "INSERT INTO audit (ms, who, what, subject, number, salt, digest, hash) VALUES "
      "($1, $2, $3, $4, $5, $6, $7, $8)",
      {ms, who, did, about, number, salt, digest, audit_hash(before, number, ms, did, digest)});
  return put ? fine() : Status(put.error());
}

}  // namespace burr::school
