#include "burr/school/decisions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "burr/base/printable.h"
#include "burr/school/enrolled.h"
#include "burr/school/outbox.h"
#include "burr/school/ratings.h"
#include "burr/school/study/standards.h"
#include "burr/school/uuid.h"

namespace burr::school {
namespace {

template <class T>
Value or_null(const std::optional<T>& value) {
  return value ? Value(*value) : Value();
}

std::optional<double> maybe_number(const Value& value) {
  return is_null(value) ? std::nullopt : std::optional<double>(number(value));
}
std::optional<std::int64_t> maybe_whole(const Value& value) {
  return is_null(value) ? std::nullopt : std::optional<std::int64_t>(whole(value));
}

Status check(const Standard& one) {
  if (const Status good = check_name("who sets the standard", one.set_by); !good) return good;
  if (const Status good = check_reason(one.text); !good) return good;
  if (one.part != "product" && one.part != "process")
    return error(Trouble::usage, "a standard is about the product or the process");
  if (one.method == "contrasting groups") {
    if (one.n_low.value_or(0) < study::kFewestOfAGroup ||
        one.n_high.value_or(0) < study::kFewestOfAGroup)
      return error(
          Trouble::usage,
          fmt::format("contrasting groups need {} people in each group; here are {} and "
                      "{}, so no standard is stored",
                      study::kFewestOfAGroup, one.n_low.value_or(0), one.n_high.value_or(0)));
  } else if (one.method != "Angoff" && one.method != "Hofstee") {
    return error(Trouble::usage, "a standard needs a method: contrasting groups, Angoff, Hofstee");
  } else if (one.judges.value_or(0) < study::kFewestJudges) {
    return error(Trouble::usage,
                 fmt::format("{} needs {} judges; here are {}, so no standard is stored",
                             one.method, study::kFewestJudges, one.judges.value_or(0)));
  }
  if (!(one.cut > 0 && one.cut <= 100))
    return error(Trouble::usage,
                 fmt::format("a cut of {:.4g} is not between 0 and 100 points", one.cut));
  return fine();
}

// Row by row: learner, session, part, total, gates, in the order of time; of each part the newest score.
constexpr Sql kScored =
    "SELECT session.learner_id, session.id, score.part, score.total, score.gates_broken "
    "FROM session JOIN score ON score.session_id = session.id "
    "JOIN seal ON seal.session_id = session.id "  // the others prove nothing
    "WHERE session.guided = 0 AND session.finished = 1 AND score.rubric_hash = $1 "
    "AND (session.learner_id = $2 OR $3 = 1) AND NOT EXISTS (SELECT 1 FROM score AS later "
    "WHERE later.session_id = score.session_id AND later.part = score.part "
    "AND later.rubric_hash = score.rubric_hash AND (later.made_ms > score.made_ms "
    "OR (later.made_ms = score.made_ms AND later.id > score.id))) "
    "ORDER BY session.learner_id, session.started_ms, session.id, score.part";

void conclude(Proposal& one, double cut) {
  std::size_t row = 0;
  for (std::size_t n = 0; n < one.sessions.size(); ++n) {
    Proposal::Seen& seen = one.sessions[n];
    seen.holds = seen.points && *seen.points >= cut && seen.gates_broken == 0;
    row = seen.holds ? row + 1 : 0;
    if (row < kInARow || one.reached) continue;
    one.reached = true;
    one.first = n + 1 - kInARow;
  }
}

Result<std::vector<std::pair<std::string, Proposal>>> proposals_of(Store& store,
                                                                   const Standard& standard,
                                                                   const std::string& learner) {
  const auto found = store.database().rows(
      kScored, {standard.rubric_hash, learner, std::int64_t{learner.empty()}});
  if (!found) return found.error();
  std::vector<std::pair<std::string, Proposal>> all;
  for (const Row& row : *found) {
    if (all.empty() || all.back().first != text(row[0])) all.push_back({text(row[0]), {}});
    std::vector<Proposal::Seen>& sessions = all.back().second.sessions;
    if (sessions.empty() || sessions.back().session != text(row[1]))
      sessions.push_back({text(row[1]), std::nullopt, 0, false});
    if (text(row[2]) == standard.part) sessions.back().points = maybe_number(row[3]);
    sessions.back().gates_broken += whole(row[4]);  // a gate of either part
  }
  for (auto& [unused, one] : all) conclude(one, standard.cut);
  return all;
}

Status check(Store& store, const Decision& one) {
  if (one.outcome != "pass" && one.outcome != "fail")
    return error(Trouble::usage,
                 fmt::format("outcome {}: use pass or fail", base::printable(one.outcome)));
  if (const Status good = check_name("who confirms", one.confirmed_by); !good) return good;
  if (one.confirmed_by == one.learner) return error(Trouble::usage, "nobody decides about oneself");
  if (one.reason.find_first_not_of(' ') == std::string::npos)
    return error(Trouble::usage, "a decision needs a reason");
  if (const Status good = check_reason(one.reason); !good) return good;
  const auto known = has(store, one.learner);
  if (!known) return known.error();
  if (!*known)
    return error(Trouble::usage,
                 fmt::format("{}: there is no such learner; `school::learners` lists them",
                             base::printable(one.learner)));
  return fine();
}

// Who decides, and can prove it.
Result<std::string> who_decides(Store& store, const SigningKey* key) {
  if (key == nullptr) {
    if (store.database().kind() != Database::Kind::postgres)
      return error(Trouble::usage,
                   "no key says who decides; `school::enrol` with `school::Enrolled::kind` makes "
                   "yours known to the "
                   "store");
    const auto login = store.database().rows("SELECT CAST(session_user AS TEXT)");
    if (!login) return login.error();
    return text((*login)[0][0]);
  }
  const auto all = enrolled(store);
  if (!all) return all.error();
  for (const Enrolled& one : *all)
    if (one.name == key->name() && one.key == key->public_key() && one.kind == "decider" &&
        !one.revoked_ms)
      return one.name;
  return error(Trouble::usage,
               fmt::format("key of {}: the store does not know it as that of a person who decides; "
                           "`school::enrol` with `school::Enrolled::kind` makes it known",
                           key->name()));
}

}  // namespace

std::string decision_words(const Decision& one) {
  return fmt::format(
      "burr decision 1\nid {}\nlearner {}\nstandard {}\noutcome {}\nby {}\nreason {}\nsessions {}\n"
      "made_ms {}\n",
      one.id, one.learner, one.standard, one.outcome, one.confirmed_by, one.reason,
      nlohmann::json(one.sessions).dump(), one.made_ms);
}

Result<std::string> set_standard(Store& store, const Standard& standard) {
  if (const Status may = store.may_write(); !may) return may.error();
  if (const Status good = check(standard); !good) return good.error();
  const auto rubric = rubric_in(store, standard.rubric_hash);
  if (!rubric) return rubric.error();
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  const std::string id = uuid_at_random();
  const auto made = store.database().run(
      "INSERT INTO standard (id, rubric_hash, part, method, cut, n_low, n_high, judges, fp, fn, "
      "text, set_by, made_ms) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13)",
      {id, rubric->hash, standard.part, standard.method, standard.cut, or_null(standard.n_low),
       or_null(standard.n_high), or_null(standard.judges), or_null(standard.false_pass),
       or_null(standard.false_fail), standard.text, standard.set_by, now_ms()});
  if (!made) return made.error();
  if (const Status noted = store.note("standard set", id); !noted) return noted.error();
  if (const Status done = change->commit(); !done) return done.error();
  return id;
}

Result<std::vector<Standard>> standards(Store& store) {
  const auto found = store.database().rows(
      "SELECT standard.id, standard.rubric_hash, rubric.name, standard.part, standard.method, "
      "standard.cut, standard.n_low, standard.n_high, standard.judges, standard.fp, standard.fn, "
      "standard.text, standard.set_by, standard.made_ms FROM standard LEFT JOIN rubric "
      "ON rubric.hash = standard.rubric_hash ORDER BY standard.made_ms, standard.id");
  if (!found) return found.error();
  std::vector<Standard> all;
  for (const Row& row : *found)
    all.push_back({text(row[0]), text(row[1]), text(row[2]), text(row[3]), text(row[4]),
                   number(row[5]), maybe_whole(row[6]), maybe_whole(row[7]), maybe_whole(row[8]),
                   maybe_number(row[9]), maybe_number(row[10]), text(row[11]), text(row[12]),
                   whole(row[13])});
  return all;
}

Result<Standard> standard_in(Store& store, const std::string& id) {
  const auto all = standards(store);
  if (!all) return all.error();
  if (all->empty())
    return error(
        Trouble::usage,
        "this centre has set no standard, so nothing can be decided; `school::set_standard` "
        "sets one");
  const Standard* found = nullptr;
  for (const Standard& one : *all) {
    if (one.id == id) return one;
    if (id.empty() || one.id.rfind(id, 0) != 0) continue;
    if (found != nullptr)
      return error(Trouble::usage, fmt::format("{}: several standards begin so; give more of it",
                                               base::printable(id)));
    found = &one;
  }
  if (found == nullptr)
    return error(Trouble::usage,
                 fmt::format("{}: there is no such standard; `school::standards` lists them",
                             base::printable(id)));
  return *found;
}

Result<Proposal> proposal(Store& store, const Standard& standard, const std::string& learner) {
  if (learner.empty()) return error(Trouble::usage, "a proposal is about one learner");
  auto all = proposals_of(store, standard, learner);
  if (!all) return all.error();
  return all->empty() ? Proposal{} : std::move(all->front().second);
}

Result<std::vector<std::pair<std::string, Proposal>>> proposals(Store& store,
                                                                const Standard& standard) {
  return proposals_of(store, standard, {});
}

Result<Decision> decide(Store& store, const Decision& given, const SigningKey* key) {
  if (const Status may = store.may_write(); !may) return may.error();
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  const auto who = who_decides(store, key);
  if (!who) return who.error();
  Decision decision = given;
  decision.confirmed_by = *who;
  if (const Status good = check(store, decision); !good) return good.error();
  const auto standard = standard_in(store, decision.standard);
  if (!standard) return standard.error();
  const auto rests_on = proposal(store, *standard, decision.learner);
  if (!rests_on) return rests_on.error();
  if (rests_on->sessions.empty())
    return error(Trouble::usage,
                 fmt::format("{} has no sealed, finished session without guidance that was scored "
                             "by rubric {}, so there is nothing to decide on",
                             decision.learner, base::printable(standard->rubric)));
  Decision out = decision;
  out.standard = standard->id;
  out.id = uuid_at_random();
  out.made_ms = now_ms();
  out.sessions.clear();
  for (const Proposal::Seen& one : rests_on->sessions) out.sessions.push_back(one.session);
  if (key != nullptr) out.signature = key->sign(decision_words(out));
  const auto made = store.database().run(
      "INSERT INTO decision (id, session_set_json, learner_id, standard_id, outcome, confirmed_by, "
      "reason, made_ms, signature) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9)",
      {out.id, nlohmann::json(out.sessions).dump(), out.learner, out.standard, out.outcome,
       out.confirmed_by, out.reason, out.made_ms,
       out.signature.empty() ? Value() : Value(out.signature)});
  if (!made) return made.error();
  if (const Status queued = queue_decision(store, {out.learner, out.standard, out.outcome,
                                                   out.confirmed_by, out.sessions, out.made_ms});
      !queued)
    return queued.error();
  if (const Status noted = store.note("decision recorded", out.learner); !noted)
    return noted.error();
  if (const Status done = change->commit(); !done) return done.error();
  return out;
}

Result<std::vector<Decision>> decisions(Store& store, const std::string& learner) {
  const auto found = store.database().rows(
      "SELECT learner_id, standard_id, outcome, confirmed_by, reason, id, session_set_json, "
      "made_ms, signature "
      "FROM decision WHERE learner_id = $1 OR $2 = 1 ORDER BY made_ms, id",
      {learner, std::int64_t{learner.empty()}});
  if (!found) return found.error();
  std::vector<Decision> all;
  for (const Row& row : *found) {
    Decision one{text(row[0]), text(row[1]), text(row[2]), text(row[3]),
                 text(row[4]), text(row[5]), {},           whole(row[7])};
    const auto set = nlohmann::json::parse(text(row[6]), nullptr, false);
    if (set.is_array())
      for (const auto& session : set)
        if (session.is_string()) one.sessions.push_back(session.get<std::string>());
    one.signature = text(row[8]);
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace burr::school
