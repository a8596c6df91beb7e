#include "burr/school/ratings.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "burr/base/printable.h"
#include "burr/people/random_stream.h"
#include "burr/school/uuid.h"

namespace burr::school {
namespace {

constexpr const char* kMarkWords[] = {"met", "unmet", "not assessable"};

bool has_control(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7f;
  });
}

// No marks come in while the learner is forgotten, and no two markings of one session at once. Not FOR UPDATE: a rater
// may change no session.
Status hold(Store& store, const std::string& session) {
  if (store.database().kind() != Database::Kind::postgres) return fine();
  const auto alone = store.database().rows(
      "SELECT 1 FROM (SELECT pg_advisory_xact_lock(72372, hashtext($1))) AS t", {session});
  return alone ? fine() : Status(alone.error());
}

Status check_session(Store& store, const Marking& marking) {
  const auto found = store.database().rows("SELECT learner_id, finished FROM session WHERE id = $1",
                                           {marking.session});
  if (!found) return found.error();
  if (found->empty())
    return error(Trouble::usage,
                 fmt::format("{}: there is no such session", base::printable(marking.session)));
  if (text((*found)[0][0]) == marking.rater)
    return error(Trouble::usage, "nobody marks the own session");
  if (whole((*found)[0][1]) == 0)
    return error(Trouble::usage,
                 fmt::format("{}: this session was not finished, so there is no product to mark",
                             base::printable(marking.session)));
  return fine();
}

Status check_marks(Store& store, const Marking& marking) {
  if (marking.marks.empty()) return error(Trouble::usage, "there is no mark to store");
  const auto items = store.database().rows(
      "SELECT DISTINCT item.item_id FROM item JOIN score ON score.id = item.score_id "
      "WHERE score.session_id = $1",
      {marking.session});
  if (!items) return items.error();
  const auto done = store.database().rows(
      "SELECT item_id FROM rater_mark WHERE session_id = $1 AND rater_id = $2 AND blinded = $3",
      {marking.session, marking.rater, std::int64_t{marking.blinded}});
  if (!done) return done.error();
  std::set<std::string> known, marked;
  for (const Row& row : *items) known.insert(text(row[0]));
  for (const Row& row : *done) marked.insert(text(row[0]));
  for (const RaterMark& one : marking.marks) {
    if (!known.contains(one.item))
      return error(Trouble::usage,
                   fmt::format("{}: the session was not scored by such an item; it has {}",
                               base::printable(one.item), base::list_of(known)));
    if (std::find(std::begin(kMarkWords), std::end(kMarkWords), one.mark) == std::end(kMarkWords))
      return error(Trouble::usage,
                   fmt::format("{}: mark \"{}\": use met, \"not met\" or \"not assessable\"",
                               base::printable(one.item), base::printable(one.mark)));
    if (const Status good = check_reason(one.reason); !good) return good;
    if (!marked.insert(one.item).second)
      return error(Trouble::usage,
                   fmt::format("{}: {} has marked this item already; a mark stays",
                               base::printable(one.item), base::printable(marking.rater)));
  }
  return fine();
}

}  // namespace

Result<std::vector<RubricRow>> rubrics(Store& store) {
  const auto found = store.database().rows(
      "SELECT rubric.hash, rubric.name, rubric.text, rubric.version, rubric.calibrated, used.n "
      "FROM rubric JOIN (SELECT rubric_hash, count(DISTINCT session_id) AS n, max(made_ms) AS last "
      "FROM score GROUP BY rubric_hash) AS used ON used.rubric_hash = rubric.hash "
      "ORDER BY used.last DESC, rubric.hash");
  if (!found) return found.error();
  std::vector<RubricRow> all;
  for (const Row& row : *found)
    all.push_back(
        {text(row[0]), text(row[1]), text(row[2]), whole(row[3]), whole(row[4]), whole(row[5])});
  return all;
}

Result<RubricRow> rubric_in(Store& store, const std::string& given) {
  const auto all = rubrics(store);
  if (!all) return all.error();
  std::set<std::string> names;
  const RubricRow* found = nullptr;
  for (const RubricRow& one : *all) {
    names.insert(one.name);
    const bool meant = given.empty() || one.hash == given || one.name == given;
    if (meant && found == nullptr) found = &one;
  }
  if (found == nullptr)
    return error(Trouble::usage,
                 names.empty() ? "the store has no scored session"
                               : fmt::format("the store has no scores by a rubric {}; it has {}",
                                             base::printable(given), base::list_of(names)));
  if (given.empty() && names.size() > 1)
    return error(
        Trouble::usage,
        fmt::format("the store has scores by several rubrics; choose one with `rubric`: {}",
                    base::list_of(names)));
  return *found;
}

Status check_name(std::string_view what, std::string_view name) {
  const bool blank = name.find_first_not_of(' ') == std::string_view::npos;
  if (blank || name.size() > kLongestName || has_control(name) || name.front() == ' ' ||
      name.back() == ' ')
    return error(Trouble::usage,
                 fmt::format("{}: give the name or pseudonym of a person, at most {} letters", what,
                             kLongestName));
  if (name == "machine" || name == "burr" || name == "forgotten")
    return error(Trouble::usage,
                 fmt::format("{} {}: this must be a person", what, base::printable(name)));
  return fine();
}

Status check_reason(std::string_view reason) {
  if (reason.size() <= kLongestReason && !has_control(reason)) return fine();
  return error(Trouble::usage,
               fmt::format("a reason is one line of at most {} letters", kLongestReason));
}

Result<std::vector<Product>> to_mark(Store& store, const std::string& rater,
                                     const std::string& rubric_hash, std::uint64_t seed) {
  // of each session the newest score, found by the index of its scores: 5000 sessions have 10 000 of them
  const auto found = store.database().rows(
      "SELECT queue.id, case_def.name, queue.rubric_hash, queue.recording_uri, "
      "queue.recording_hash FROM (SELECT session.id, session.case_hash, session.recording_uri, "
      "session.recording_hash, (SELECT score.rubric_hash FROM score "
      "WHERE score.session_id = session.id AND (score.rubric_hash = $2 OR $3 = 1) "
      "ORDER BY score.made_ms DESC, score.id LIMIT 1) AS rubric_hash FROM session "
      "WHERE session.finished = 1 AND session.learner_id <> $1 AND NOT EXISTS (SELECT 1 "
      "FROM rater_mark WHERE rater_mark.session_id = session.id AND rater_mark.rater_id = $4 "
      "AND rater_mark.blinded = 1)) AS queue LEFT JOIN case_def ON case_def.hash = queue.case_hash "
      "WHERE queue.rubric_hash IS NOT NULL ORDER BY queue.id",
      {rater, rubric_hash, std::int64_t{rubric_hash.empty()}, rater});
  if (!found) return found.error();
  std::vector<Product> all;
  for (const Row& row : *found)
    all.push_back({text(row[0]), text(row[1]), text(row[2]), text(row[3]), text(row[4])});
  people::RandomStream random(seed);
  for (std::size_t n = all.size(); n > 1; --n)
    std::swap(all[n - 1], all[static_cast<std::size_t>(random.below(static_cast<int>(n)))]);
  return all;
}

Status mark(Store& store, const Marking& marking) {
  if (const Status may = store.may_write(); !may) return may;
  if (const Status good = check_name("the rater", marking.rater); !good) return good;
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  for (const Status& good :
       {hold(store, marking.session), check_session(store, marking), check_marks(store, marking)})
    if (!good) return good;
  for (const RaterMark& one : marking.marks) {
    // an id at random: one that was made from the rater's name would outlive the name
    const auto made = store.database().run(
        "INSERT INTO rater_mark (id, session_id, rater_id, item_id, mark, blinded, reason, "
        "made_ms) VALUES ($1, $2, $3, $4, $5, $6, $7, $8)",
        {uuid_at_random(), marking.session, marking.rater, one.item, one.mark,
         std::int64_t{marking.blinded}, one.reason.empty() ? Value() : Value(one.reason),
         now_ms()});
    if (!made) return made.error();
  }
  if (const Status noted = store.note("marked by a person", marking.session); !noted) return noted;
  return change->commit();
}

Result<std::vector<RaterMarkRow>> rater_marks(Store& store, const std::string& session) {
  const auto found = store.database().rows(
      "SELECT session_id, rater_id, item_id, mark, reason, blinded, made_ms FROM rater_mark "
      "WHERE session_id = $1 OR $2 = 1 ORDER BY session_id, rater_id, item_id, made_ms",
      {session, std::int64_t{session.empty()}});
  if (!found) return found.error();
  std::vector<RaterMarkRow> all;
  for (const Row& row : *found)
    all.push_back({text(row[0]), text(row[1]), text(row[2]), text(row[3]), text(row[4]),
                   whole(row[5]) != 0, whole(row[6])});
  return all;
}

}  // namespace burr::school
