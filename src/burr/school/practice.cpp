#include "burr/school/practice.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <map>
#include <utility>

#include "burr/school/study/curve.h"

namespace burr::school {
namespace {

namespace chrono = std::chrono;

using Marks = std::vector<std::pair<int, double>>;  // attempt and points, without guidance

Marks marks_of(const std::vector<Practised>& sessions) {
  Marks out;
  for (const Practised& one : sessions)
    if (one.points && !one.guided) out.emplace_back(one.attempt, *one.points);
  return out;
}

Trend trend_of(const Marks& marks) {
  std::vector<study::Attempt> attempts;
  for (const auto& [number, points] : marks) attempts.push_back({number, "", points, false});
  const int last = marks.empty() ? 0 : marks.back().first;
  const study::Curve curve = study::fit_curve(attempts);
  if (curve.kind == study::CurveKind::points || !(curve.a > 0) || last <= kFlatAttempts)
    return Trend::unknown;
  const double gain = curve.at(last) - curve.at(last - kFlatAttempts);
  if (std::abs(gain) < kFlatShare * curve.a) return Trend::flat;
  return gain > 0 ? Trend::rising : Trend::falling;
}

std::optional<NextPractice> proposal(const std::vector<Practised>& sessions, Trend trend) {
  if (static_cast<int>(sessions.size()) < kFewestForProposal) return std::nullopt;
  NextPractice out;
  out.trend = trend;
  const bool flat = trend == Trend::flat;
  out.day = sessions.back().day + (flat ? kDaysWhenFlat : kDaysBetween);
  out.sessions = flat ? 1 : kMostADay;
  out.other_bone = flat;
  return out;
}

CasePractice practice_of(std::string name, const std::vector<Practised>& sessions, Trend trend) {
  CasePractice out;
  out.case_name = std::move(name);
  out.finished = static_cast<int>(sessions.size());
  out.last_day = sessions.back().day;
  for (const Practised& one : sessions) {
    out.unguided += one.guided ? 0 : 1;
    out.on_last_day += one.day == out.last_day ? 1 : 0;
  }
  out.next = proposal(sessions, trend);
  return out;
}

}  // namespace

const char* word_of(Trend trend) {
  switch (trend) {
    case Trend::rising:
      return "rising";
    case Trend::flat:
      return "flat";
    case Trend::falling:
      return "falling";
    case Trend::unknown:
      break;
  }
  return "unknown";
}

std::optional<NextPractice> next_practice(const std::vector<Practised>& sessions) {
  return proposal(sessions, trend_of(marks_of(sessions)));
}

Result<std::vector<LearnerPractice>> practice(Store& store, const std::string& learner,
                                              PracticeMemo* memo) {
  // of each session the newest points of the product; attempts are counted over all sessions, as everywhere
  const auto found = store.database().rows(
      "WITH counted AS (SELECT session.id, session.learner_id, case_def.name AS case_name, "
      "session.guided, session.finished, session.started_ms, ROW_NUMBER() OVER (PARTITION BY "
      "session.learner_id, case_def.name ORDER BY session.started_ms, session.id) AS attempt "
      "FROM session LEFT JOIN case_def ON case_def.hash = session.case_hash "
      "WHERE session.learner_id = $1 OR $2 = 1) "
      "SELECT counted.learner_id, counted.case_name, counted.started_ms, counted.attempt, "
      "counted.guided, score.total FROM counted LEFT JOIN score ON score.session_id = counted.id "
      "AND score.part = 'product' AND NOT EXISTS (SELECT 1 FROM score AS later "
      "WHERE later.session_id = score.session_id AND later.part = score.part "
      "AND (later.made_ms > score.made_ms OR (later.made_ms = score.made_ms "
      "AND later.id > score.id))) WHERE counted.finished = 1 AND counted.learner_id IS NOT NULL "
      "ORDER BY counted.learner_id, counted.started_ms, counted.id",
      {learner, std::int64_t{learner.empty()}});
  if (!found) return found.error();
  PracticeMemo fresh;
  const auto remembered = [&](const std::string& id, const std::string& name,
                              const std::vector<Practised>& sessions) {
    PracticeMemo::Known now{marks_of(sessions), Trend::unknown};
    const auto old = memo != nullptr ? memo->known.find({id, name}) : fresh.known.end();
    const bool same = memo != nullptr && old != memo->known.end() && old->second.marks == now.marks;
    now.trend = same ? old->second.trend : trend_of(now.marks);
    const Trend trend = now.trend;
    fresh.known[{id, name}] = std::move(now);
    return trend;
  };
  std::vector<LearnerPractice> all;
  for (std::size_t n = 0; n < found->size();) {
    const std::string id = text((*found)[n][0]);
    std::map<std::string, std::vector<Practised>> cases;
    std::vector<std::string> by_time;  // the one that was practised last at the end
    for (; n < found->size() && text((*found)[n][0]) == id; ++n) {
      const Row& row = (*found)[n];
      const std::string name = text(row[1]);
      cases[name].push_back({day_here(whole(row[2])), static_cast<int>(whole(row[3])),
                             whole(row[4]) != 0,
                             is_null(row[5]) ? std::nullopt : std::optional(number(row[5]))});
      std::erase(by_time, name);
      by_time.push_back(name);
    }
    LearnerPractice& one = all.emplace_back(LearnerPractice{id, {}});
    for (auto name = by_time.rbegin(); name != by_time.rend(); ++name)
      one.cases.push_back(practice_of(*name, cases[*name], remembered(id, *name, cases[*name])));
  }
  if (memo != nullptr && learner.empty()) *memo = std::move(fresh);
  return all;
}

std::int64_t day_here(std::int64_t ms) {
  const auto seconds = static_cast<std::time_t>(ms / 1000);
  std::tm here = {};
  localtime_r(&seconds, &here);
  const chrono::year_month_day date(chrono::year(here.tm_year + 1900),
                                    chrono::month(static_cast<unsigned>(here.tm_mon + 1)),
                                    chrono::day(static_cast<unsigned>(here.tm_mday)));
  return chrono::sys_days(date).time_since_epoch().count();
}

std::string date_of(std::int64_t day) {
  const chrono::year_month_day date(
      chrono::sys_days(chrono::days(static_cast<chrono::days::rep>(day))));
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

}  // namespace burr::school
