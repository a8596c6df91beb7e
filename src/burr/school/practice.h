// school/practice.h - when a learner might practise a case again: a proposal by a fixed rule, from the days of practice and
// the curve.
//
//     auto all = school::practice(*store, "");                     // of all learners, one reading of the store
//     for (const auto& one : *all) ... one.cases.front().next      // the case that was practised last
//
// The rule, for each case by itself:
//
//     fewer than 3 finished sessions                  nothing
//     curve still rises, falls, or is not known       2 days after the last day of practice, at most 2 sessions
//     curve is flat                                   14 days after it, 1 session, better on another bone
//
// The curve is that of study/curve.h over the points of the product, so there is one from 5 finished sessions without
// guidance on. It is flat where it gained less than 6 % of its plateau over the last three attempts, and falls where it
// lost at least as much. Where the numbers come from, and that nobody has tested them with burr:
// docs/teach/school.md. A proposal forbids nothing and decides nothing.
//
// Days are counted from 1970 in the calendar of this computer. Thread: as the Store. Errors: as school/database.h.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/store.h"

namespace burr::school {

constexpr int kFewestForProposal = 3;  // finished sessions of a case
constexpr int kDaysBetween = 2, kDaysWhenFlat = 14;
constexpr int kMostADay = 2;         // sessions of a proposal
constexpr double kFlatShare = 0.06;  // of the plateau, over kFlatAttempts
constexpr int kFlatAttempts = 3;

// A finished session of one case.
struct Practised {
  std::int64_t day = 0;
  int attempt = 1;  // among all sessions of this learner at this case, from 1
  bool guided = false;
  std::optional<double> points;  // of the product [0..100]
};

enum class Trend { unknown, rising, flat, falling };
[[nodiscard]] const char* word_of(Trend trend);  // "unknown", "rising", "flat", "falling"

struct NextPractice {
  Trend trend = Trend::unknown;
  std::int64_t day = 0;  // the first day that fits
  int sessions = 0;      // at most so many on that day
  bool other_bone = false;
};
// sessions: by time. None: too few of them.
[[nodiscard]] std::optional<NextPractice> next_practice(const std::vector<Practised>& sessions);

struct CasePractice {
  std::string case_name;
  int finished = 0, unguided = 0;  // sessions
  std::int64_t last_day = 0;
  int on_last_day = 0;  // sessions
  std::optional<NextPractice> next;
};
struct LearnerPractice {
  std::string learner;
  std::vector<CasePractice> cases;  // the one that was practised last comes first
};
// For a program that asks again and again: a curve is fitted once for the marks that it is of (a millisecond with 20 of
// them, so a fifth of a second for 200 learners). It holds what the store held when all were asked for last.
struct PracticeMemo {
  struct Known {
    std::vector<std::pair<int, double>> marks;  // attempt and points, without guidance
    Trend trend = Trend::unknown;
  };
  std::map<std::pair<std::string, std::string>, Known> known;  // by learner and case
};
// By learner; those without a finished session are left out. learner: empty for all. memo: may be nullptr.
[[nodiscard]] Result<std::vector<LearnerPractice>> practice(Store& store,
                                                            const std::string& learner,
                                                            PracticeMemo* memo = nullptr);

// The day of a moment here; and a day as "2026-12-03".
[[nodiscard]] std::int64_t day_here(std::int64_t ms);
[[nodiscard]] std::string date_of(std::int64_t day);

}  // namespace burr::school
