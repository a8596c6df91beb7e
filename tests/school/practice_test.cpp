// When to practise again: the rule against examples that were computed by hand, and read from the store.
#include "burr/school/practice.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "burr/school/sessions.h"
#include "school/made.h"

namespace burr::school {
namespace {

// Attempts 1 .. n without guidance, one a day, with exactly the points of y = a - b / n.
std::vector<Practised> on_curve(double a, double b, int count, std::int64_t first_day = 20'000) {
  std::vector<Practised> out;
  for (int n = 1; n <= count; ++n) out.push_back({first_day + n, n, false, a - b / n});
  return out;
}

TEST(Practice, NothingIsProposedForTooFewSessions) {
  EXPECT_FALSE(next_practice({}));
  EXPECT_FALSE(next_practice(on_curve(80, 40, 2)));
  EXPECT_TRUE(next_practice(on_curve(80, 40, 3)));
}

// Of fewer than five attempts without guidance there is no curve, whoever many there are with it.
TEST(Practice, WithoutACurveItIsTwoDaysLaterAndAtMostTwoSessions) {
  std::vector<Practised> sessions = on_curve(80, 40, 4);
  for (int n = 5; n <= 9; ++n) sessions.push_back({20'010, n, true, 99});
  const auto next = next_practice(sessions);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->trend, Trend::unknown);
  EXPECT_EQ(next->day, 20'012);
  EXPECT_EQ(next->sessions, 2);
  EXPECT_FALSE(next->other_bone);
}

// y = 80 - 40 / n. At the sixth attempt 40 / 3 - 40 / 6 = 6.67 points in three attempts, 8.3 % of 80: it rises. At the
// eighth 40 / 5 - 40 / 8 = 3 points, 3.75 %: flat.
TEST(Practice, ARisingCurveMeansSoonAndAFlatOneLater) {
  const auto rising = next_practice(on_curve(80, 40, 6));
  ASSERT_TRUE(rising);
  EXPECT_EQ(rising->trend, Trend::rising);
  EXPECT_EQ(rising->day, 20'006 + 2);
  EXPECT_EQ(rising->sessions, 2);
  const auto flat = next_practice(on_curve(80, 40, 8));
  ASSERT_TRUE(flat);
  EXPECT_EQ(flat->trend, Trend::flat);
  EXPECT_EQ(flat->day, 20'008 + 14);
  EXPECT_EQ(flat->sessions, 1);
  EXPECT_TRUE(flat->other_bone);
}

// y = 60 + 60 / n: from the third to the sixth attempt 20 - 10 = 10 points are lost, 17 % of 60.
TEST(Practice, AFallingCurveMeansSoon) {
  const auto next = next_practice(on_curve(60, -60, 6));
  ASSERT_TRUE(next);
  EXPECT_EQ(next->trend, Trend::falling);
  EXPECT_EQ(next->day, 20'006 + 2);
}

TEST(Practice, GuidedSessionsAreDaysOfPracticeAndOutsideOfTheCurve) {
  std::vector<Practised> sessions = {{20'000, 1, true, 5}, {20'000, 2, true, 5}};
  for (int n = 3; n <= 10; ++n) sessions.push_back({20'000 + n, n, false, 80 - 40.0 / n});
  sessions.push_back({20'020, 11, true, 5});
  const auto next = next_practice(sessions);
  ASSERT_TRUE(next);
  // 80 - 40 / n: 40 / 7 - 40 / 10 = 1.7 points in the last three; with the guided ones it would be another curve
  EXPECT_EQ(next->trend, Trend::flat);
  EXPECT_EQ(next->day, 20'034);
}

TEST(Practice, DaysAreThoseOfTheCalendarHere) {
  const char* set = std::getenv("TZ");
  const std::string before = set != nullptr ? set : "";
  ::setenv("TZ", "Europe/Stockholm", 1);
  ::tzset();
  // 2026-03-28 22:59:59 UTC is still the 28th there, a second later it is the 29th
  EXPECT_EQ(date_of(day_here(1'774'738'799'000)), "2026-03-28");
  EXPECT_EQ(date_of(day_here(1'774'738'800'000)), "2026-03-29");
  EXPECT_EQ(date_of(day_here(1'774'738'800'000) + 3), "2026-04-01");
  EXPECT_EQ(date_of(0), "1970-01-01");
  if (set != nullptr)
    ::setenv("TZ", before.c_str(), 1);
  else
    ::unsetenv("TZ");
  ::tzset();
}

TEST(Practice, IsReadFromTheStoreCaseByCase) {
  const test::Folder folder;
  auto store = Store::open(test::place_in(folder));
  ASSERT_TRUE(store) << store.error().text;
  constexpr std::int64_t kDay = 86'400'000, kNoon = 1'700'000'000'000 / kDay * kDay + kDay / 2;
  const auto put = [&](const std::string& learner, const std::string& name, int day, int n,
                       double points, bool guided, bool finished) {
    SessionRecord one = test::made_session(learner, name + std::to_string(n),
                                           kNoon + day * kDay + n * std::int64_t{1000});
    one.work_case.name = name;
    one.work_case.hash = name == "block" ? "0x00000000000000aa" : "0x00000000000000ab";
    one.guided = guided;
    one.finished = finished;
    one.scores[0].total = 10 * n;  // by this burr it would still rise
    const auto entered = enter(**store, one);
    ASSERT_TRUE(entered) << entered.error().text;
    one.scored_by = "0.2.0";  // and by a newer burr, whose points count
    one.scores[0].total = points;
    one.scores[0].made_ms += 1000;
    ASSERT_TRUE(enter(**store, one));
  };
  for (const char* id : {"kestrel-27", "otter-5", "heron-1"}) {
    Learner learner;
    learner.id = id;
    ASSERT_TRUE(add(**store, learner, {}));
  }
  for (int n = 1; n <= 8; ++n) put("kestrel-27", "block", n, n, 80 - 40.0 / n, false, true);
  put("kestrel-27", "jaw", 8, 20, 50, true, true);
  put("kestrel-27", "jaw", 9, 21, 50, true, true);
  put("kestrel-27", "jaw", 30, 22, 50, true, false);  // not finished: no day of practice
  put("otter-5", "block", 3, 1, 50, false, true);
  const auto all = practice(**store, "");
  ASSERT_TRUE(all) << all.error().text;
  ASSERT_EQ(all->size(), 2U);  // nobody proposes anything to heron-1
  const LearnerPractice& one = all->front();
  EXPECT_EQ(one.learner, "kestrel-27");
  ASSERT_EQ(one.cases.size(), 2U);
  EXPECT_EQ(one.cases[0].case_name, "jaw");
  EXPECT_EQ(one.cases[0].finished, 2);
  EXPECT_EQ(one.cases[0].unguided, 0);
  EXPECT_FALSE(one.cases[0].next);
  EXPECT_EQ(one.cases[0].last_day, day_here(kNoon) + 9);
  EXPECT_EQ(one.cases[1].case_name, "block");
  EXPECT_EQ(one.cases[1].unguided, 8);
  ASSERT_TRUE(one.cases[1].next);
  EXPECT_EQ(one.cases[1].next->trend, Trend::flat);
  EXPECT_EQ(one.cases[1].next->day, day_here(kNoon) + 8 + 14);
  const auto alone = practice(**store, "otter-5");
  ASSERT_TRUE(alone);
  ASSERT_EQ(alone->size(), 1U);
  EXPECT_EQ(alone->front().cases[0].on_last_day, 1);
  EXPECT_TRUE(practice(**store, "nobody-1")->empty());
  // what is remembered is the same, until marks change
  PracticeMemo memo;
  ASSERT_TRUE(practice(**store, "", &memo));
  EXPECT_EQ(memo.known.size(), 3U);
  memo.known[{"kestrel-27", "block"}].trend = Trend::falling;  // so that it shows which one is used
  EXPECT_EQ(practice(**store, "", &memo)->front().cases[1].next->trend, Trend::falling);
  put("kestrel-27", "block", 10, 9, 80 - 40.0 / 9, false, true);
  EXPECT_EQ(practice(**store, "kestrel-27", &memo)->front().cases[0].next->trend, Trend::flat);
  const auto again = practice(**store, "", &memo);
  EXPECT_EQ(again->front().cases[0].next->trend, Trend::flat);
  EXPECT_EQ(again->front().cases[0].next->day, day_here(kNoon) + 10 + 14);
  ASSERT_TRUE((*store)->database().run("DELETE FROM item"));
  ASSERT_TRUE((*store)->database().run("DELETE FROM score"));
  EXPECT_EQ(practice(**store, "", &memo)->front().cases[0].next->trend, Trend::unknown);
}

}  // namespace
}  // namespace burr::school
