// Statistics of marks, against published worked examples and against R 4.2.2 (aov, MASS::rlm, nls, uniroot; the numbers
// are what R printed; tests/school/study.R prints them again).
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "burr/people/random_stream.h"
#include "burr/school/study/curve.h"
#include "burr/school/study/raters.h"
#include "burr/school/study/reliability.h"
#include "burr/school/study/standards.h"
#include "burr/school/study/table.h"

namespace burr::school::study {
namespace {

Balanced table_of(std::vector<std::vector<double>> values, int bones = 1) {
  Balanced out;
  out.bones = bones;
  out.occasions = static_cast<int>(values.front().size()) / bones;
  out.values = std::move(values);
  for (std::size_t n = 0; n < out.values.size(); ++n) out.persons.push_back(std::to_string(n));
  return out;
}

TEST(Study, ARaterWhoHasJustBegunTakesNoFiguresAway) {
  std::vector<Rating> ratings;
  for (int n = 0; n < 12; ++n)
    for (const char* rater : {"a", "b", "new"})
      for (const char* item : {"x", "y"})
        if (rater != std::string("new") || n < 3)
          ratings.push_back(
              {std::to_string(n), rater, item, (n + (*item == 'x' ? 1 : 0)) % 3 == 0});
  const auto out = study_raters(ratings);
  ASSERT_TRUE(out) << out.error().text;
  EXPECT_EQ(out->complete, 12);
  ASSERT_EQ(out->apart.size(), 1U);
  EXPECT_EQ(out->apart[0].first, "a");
  EXPECT_EQ(out->apart[0].second, "b");
}

TEST(Study, ReliabilityOfBrennansFirstData) {
  // Brennan, Generalizability Theory, 2001, tables 2.2 and 2.3: 10 persons, 12 items
  const Reliability out = reliability(table_of({{1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                                                {1, 1, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0},
                                                {1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0},
                                                {1, 1, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0},
                                                {1, 1, 1, 1, 1, 0, 1, 0, 0, 0, 0, 0},
                                                {1, 1, 1, 0, 1, 1, 1, 0, 0, 0, 0, 0},
                                                {1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0},
                                                {1, 1, 1, 1, 0, 1, 1, 1, 1, 1, 0, 0},
                                                {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0},
                                                {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}}));
  EXPECT_EQ(out.person.freedom, 9);
  EXPECT_EQ(out.occasion.freedom, 11);
  EXPECT_EQ(out.residual.freedom, 99);
  EXPECT_NEAR(out.person.mean_square, 0.8157, 5e-5);
  EXPECT_NEAR(out.occasion.mean_square, 0.8811, 5e-5);
  EXPECT_NEAR(out.residual.mean_square, 0.1269, 5e-5);
  EXPECT_NEAR(out.person.variance, 0.05740741, 1e-8);  // R; the book has .0574, .0754, .1269
  EXPECT_NEAR(out.occasion.variance, 0.07542088, 1e-8);
  EXPECT_NEAR(out.residual.variance, 0.1268519, 1e-7);
  EXPECT_NEAR(out.g(12), 0.84, 5e-3);    // the book, section 2.3: .84 for 12 items
  EXPECT_NEAR(out.phi(12), 0.77, 5e-3);  // .77
  EXPECT_EQ(out.enough(0.8), 9);         // .0574 / (.0574 + .1269 / 9) = 0.803
  EXPECT_NEAR(out.standard_error(12), std::sqrt(0.1268519 / 12), 1e-6);
}

// Gleser, Cronbach and Rajaratnam, Psychometrika 30:395, 1965, table 3: 12 patients, 6 symptoms, 2 judges within each.
TEST(Study, ReliabilityWithBonesOfGlesersData) {
  const Reliability out = reliability(table_of({{0, 0, 2, 1, 2, 0, 2, 1, 1, 1, 1, 2},
                                                {0, 0, 2, 1, 2, 0, 1, 2, 2, 1, 2, 1},
                                                {0, 0, 1, 1, 3, 3, 2, 1, 2, 1, 1, 2},
                                                {2, 0, 2, 1, 2, 2, 2, 1, 2, 1, 4, 1},
                                                {0, 0, 1, 2, 2, 0, 2, 3, 3, 3, 3, 3},
                                                {2, 0, 2, 1, 2, 0, 4, 1, 3, 3, 3, 1},
                                                {0, 1, 3, 1, 3, 1, 3, 4, 2, 2, 2, 3},
                                                {0, 0, 0, 1, 4, 3, 3, 4, 2, 3, 3, 3},
                                                {1, 2, 2, 1, 3, 6, 1, 3, 2, 3, 2, 1},
                                                {0, 1, 2, 4, 3, 3, 2, 2, 3, 5, 3, 1},
                                                {3, 4, 2, 2, 3, 2, 4, 5, 3, 3, 5, 5},
                                                {1, 1, 2, 4, 4, 4, 3, 3, 4, 6, 6, 6}},
                                               6));
  EXPECT_NEAR(out.person.mean_square, 7.6515152, 1e-7);  // R's aov
  EXPECT_NEAR(out.bone.mean_square, 12.9333333, 1e-7);
  EXPECT_NEAR(out.person_bone.mean_square, 1.4757576, 1e-7);
  EXPECT_NEAR(out.occasion.mean_square, 0.8888889, 1e-7);
  EXPECT_NEAR(out.residual.mean_square, 0.8131313, 1e-7);
  EXPECT_NEAR(out.person.variance, 0.51472, 2e-4);  // lme4's REML, which ends its search near there
  EXPECT_NEAR(out.bone.variance, 0.47436, 2e-4);
  EXPECT_NEAR(out.person_bone.variance, 0.33131, 2e-4);
  EXPECT_NEAR(out.occasion.variance, 0.00632, 2e-4);
  EXPECT_NEAR(out.residual.variance, 0.81311, 2e-4);
  EXPECT_NEAR(out.g(2, 6), 0.51472 / (0.51472 + 0.33131 / 6 + 0.81311 / 12), 2e-4);
}

TEST(Study, ReliabilityFindsTheVariancesThatMadeTheMarks) {
  people::RandomStream random(20261127);
  double person = 0, residual = 0;
  constexpr int kTimes = 200;
  for (int time = 0; time < kTimes; ++time) {
    std::vector<std::vector<double>> values(20, std::vector<double>(5));
    for (std::vector<double>& row : values) {
      const double able = 3 * random.normal();
      for (double& value : row) value = 50 + able + 2 * random.normal();
    }
    const Reliability out = reliability(table_of(values));
    person += out.person.raw / kTimes;
    residual += out.residual.raw / kTimes;
  }
  EXPECT_NEAR(person, 9, 0.7);  // standard error 0.22
  EXPECT_NEAR(residual, 4, 0.2);
}

TEST(Study, TheLastMarksOfThoseWithEnough) {
  std::vector<Mark> marks;
  for (int n = 0; n < 4; ++n) {
    marks.push_back({"a", "", 10.0 + n});
    marks.push_back({"b", "", 20.0 + n});
  }
  marks.push_back({"c", "", 1});
  const auto used = balance(marks, 3, false);
  ASSERT_TRUE(used.ok());
  EXPECT_EQ(used->left_out, 1);
  EXPECT_EQ(used->values, (std::vector<std::vector<double>>{{11, 12, 13}, {21, 22, 23}}));
  EXPECT_FALSE(balance(marks, 5, false).ok());
  marks.push_back({"a", "jaw", 1});  // nobody has 3 marks on both bones
  EXPECT_FALSE(balance(marks, 3, true).ok());
}

std::vector<std::vector<Pair>> pairs(int both, int first, int second, int neither) {
  std::vector<std::vector<Pair>> out;
  out.insert(out.end(), static_cast<std::size_t>(both), {{true, true}});
  out.insert(out.end(), static_cast<std::size_t>(first), {{true, false}});
  out.insert(out.end(), static_cast<std::size_t>(second), {{false, true}});
  out.insert(out.end(), static_cast<std::size_t>(neither), {{false, false}});
  return out;
}

TEST(Study, KappaAndAc1OfPublishedTables) {
  // Feinstein and Cicchetti, J Clin Epidemiol 43:543, 1990: the same agreement, and kappa .70 and .32
  const Agreement even = agreement(pairs(40, 9, 6, 45)), uneven = agreement(pairs(80, 10, 5, 5));
  EXPECT_NEAR(even.agreement, 0.85, 1e-12);
  EXPECT_NEAR(uneven.agreement, 0.85, 1e-12);
  EXPECT_NEAR(*even.kappa, 0.6995192308, 1e-9);  // psych::cohen.kappa
  EXPECT_NEAR(*uneven.kappa, 0.3181818182, 1e-9);
  EXPECT_NEAR(even.prevalence_index, 0.05, 1e-12);
  EXPECT_NEAR(uneven.prevalence_index, 0.75, 1e-12);
  // Gwet, Br J Math Stat Psychol 61:29, 2008: kappa -.02 where 118 of 125 agree, AC1 .94
  const Agreement gwet = agreement(pairs(118, 5, 2, 0));
  EXPECT_NEAR(*gwet.kappa, -0.0233918129, 1e-9);
  EXPECT_NEAR(gwet.ac1, 0.9408, 5e-5);
  EXPECT_LT(even.kappa_95.low, *even.kappa);
  EXPECT_GT(even.kappa_95.high, *even.kappa);
  // the large-sample error of kappa (Fleiss, Cohen, Everitt 1969) is 0.072: the interval is about 0.28 wide
  EXPECT_NEAR(even.kappa_95.high - even.kappa_95.low, 0.28, 0.04);
  EXPECT_FALSE(agreement(pairs(12, 0, 0, 0)).kappa.has_value());
}

TEST(Study, ItemsOfOneProductAreNotIndependent) {
  // the same marks for two items of each product tell no more than those for one
  std::vector<std::vector<Pair>> once = pairs(40, 9, 6, 45), twice = once;
  for (std::vector<Pair>& product : twice) product.push_back(product.front());
  const Agreement of_one = agreement(once), of_two = agreement(twice);
  EXPECT_EQ(of_two.products, 100);
  EXPECT_EQ(of_two.marks, 200);
  EXPECT_DOUBLE_EQ(*of_two.kappa, *of_one.kappa);
  EXPECT_DOUBLE_EQ(of_two.kappa_95.low, of_one.kappa_95.low);
  EXPECT_DOUBLE_EQ(of_two.kappa_95.high, of_one.kappa_95.high);
}

TEST(Study, IccOfShroutAndFleiss) {
  // Psychol Bull 86:420, 1979, table 2: ICC(2,1) = .29
  EXPECT_NEAR(
      icc_a1({{9, 2, 5, 8}, {6, 1, 3, 2}, {8, 4, 6, 8}, {7, 1, 2, 6}, {10, 5, 6, 9}, {6, 2, 4, 7}}),
      0.2897638, 1e-7);
}

TEST(Study, LimitsOfBlandAndAltman) {
  // Lancet i:307, 1986, table 1, first readings: mean -2.1 l/min, standard deviation 38.8
  const BlandAltman out = bland_altman({{494, 512},
                                        {395, 430},
                                        {516, 520},
                                        {434, 428},
                                        {476, 500},
                                        {557, 600},
                                        {413, 364},
                                        {442, 380},
                                        {650, 658},
                                        {433, 445},
                                        {417, 432},
                                        {656, 626},
                                        {267, 260},
                                        {478, 477},
                                        {178, 259},
                                        {423, 350},
                                        {427, 451}});
  EXPECT_EQ(out.products, 17);
  EXPECT_NEAR(out.mean, -2.1, 0.05);
  EXPECT_NEAR(out.deviation, 38.8, 0.05);
}

std::vector<Rating> ratings_of(int products) {
  std::vector<Rating> out;
  for (int n = 0; n < products; ++n)
    for (const char* rater : {"anna", "bert", "machine"})
      for (const char* item : {"wide", "nerve"}) {
        bool met = n % 2 == 0;
        if (std::string(rater) == "machine" && std::string(item) == "nerve" && n < 3) met = !met;
        out.push_back({"p" + std::to_string(n), rater, item, met});
      }
  return out;
}

TEST(Study, AnItemOnWhichTheMachineDiffersIsForAPerson) {
  const auto out = study_raters(ratings_of(20));
  ASSERT_TRUE(out.ok()) << out.error().text;
  EXPECT_EQ(out->ask_a_person, std::vector<std::string>{"nerve"});  // 85 % against 100 %
  EXPECT_EQ(out->complete, 20);
  ASSERT_EQ(out->apart.size(), 3U);
  EXPECT_EQ(out->apart[0].figures.mean, 0);
  EXPECT_NEAR(out->apart[1].figures.mean, 1.0 / 20, 1e-12);  // the machine: 2 items fewer, 1 more
  ASSERT_EQ(out->pairs.size(), 9U);  // 3 pairs of raters for 2 items and for all
  EXPECT_NEAR(out->pairs[4].figures.agreement, 0.85, 1e-12);
  EXPECT_EQ(out->pairs.back().figures.products, 20);  // all items together: still 20 products
  EXPECT_EQ(out->pairs.back().figures.marks, 40);
  EXPECT_FALSE(study_raters(ratings_of(9)).ok());
  std::vector<Rating> twice = ratings_of(20);
  twice.push_back(twice.front());
  EXPECT_FALSE(study_raters(twice).ok());
}

TEST(Study, CutBetweenContrastingGroups) {
  const std::vector<double> low = {41, 48, 52, 55, 57, 60, 61, 63, 66, 70},
                            high = {66, 70, 72, 74, 75, 78, 79, 80, 81, 85, 88};
  const auto out = contrasting_groups(low, high);
  ASSERT_TRUE(out.ok()) << out.error().text;
  EXPECT_NEAR(out->cut, 67.7985693403, 1e-8);  // R: uniroot on the two densities
  EXPECT_NEAR(out->pass_expected, 0.112893328, 1e-8);
  EXPECT_NEAR(out->fail_expected, 0.0765166147, 1e-8);
  EXPECT_NEAR(out->pass_seen, 0.1, 1e-12);
  EXPECT_NEAR(out->fail_seen, 1.0 / 11, 1e-12);
  EXPECT_LT(out->cut_95.low, out->cut);
  EXPECT_GT(out->cut_95.high, out->cut);
  // equal spreads: the middle
  std::vector<double> shifted = low;
  for (double& mark : shifted) mark += 20;
  EXPECT_NEAR(contrasting_groups(low, shifted)->cut, 67.3, 1e-9);
  EXPECT_FALSE(contrasting_groups(high, low).ok());
  EXPECT_FALSE(contrasting_groups(low, {66, 70, 72, 74, 75, 78, 79}).ok());
  EXPECT_FALSE(contrasting_groups(low, std::vector<double>(9, 80)).ok());
}

TEST(Study, CutsOfJudges) {
  const auto out =
      angoff({{0.5, 0.9, 0.7}, {0.6, 0.8, 0.7}, {0.4, 0.9, 0.6}, {0.5, 0.8, 0.9}, {0.7, 1.0, 0.8}});
  ASSERT_TRUE(out.ok());
  EXPECT_NEAR(out->cut, (2.1 + 2.1 + 1.9 + 2.2 + 2.5) / 5, 1e-12);
  EXPECT_NEAR(out->deviation, std::sqrt((3 * 0.0 + 2 * 0.0036 + 0.0676 + 0.0016 + 0.1156) / 4),
              1e-12);
  EXPECT_FALSE(angoff({{0.5}, {0.5}, {0.5}, {0.5}}).ok());
  EXPECT_FALSE(angoff({{0.5}, {0.5}, {0.5}, {0.5}, {0.5, 0.1}}).ok());
  // 0 to 99: the share below a cut c is c / 100; the line from (40, 0.9) to (80, 0.1) meets it at 56.67
  std::vector<double> marks(100);
  std::iota(marks.begin(), marks.end(), 0);
  const auto met = hofstee(std::vector<HofsteeJudge>(5, {40, 80, 0.1, 0.9}), marks);
  ASSERT_TRUE(met.ok());
  EXPECT_NEAR(met->cut, 56.67, 0.51);
  EXPECT_NEAR(met->fail, 0.567, 0.011);
  EXPECT_FALSE(hofstee(std::vector<HofsteeJudge>(5, {40, 80, 0.1, 0.2}), marks).ok());
}

std::vector<Attempt> attempts_of(const std::vector<double>& marks) {
  std::vector<Attempt> out;
  for (std::size_t n = 0; n < marks.size(); ++n)
    out.push_back({static_cast<int>(n) + 1, "", marks[n], false});
  return out;
}

TEST(Study, CurveWithABadDayAsInR) {
  // R: MASS::rlm(y ~ I(-1/n), psi = psi.huber, scale.est = "MAD", acc = 1e-13)
  const std::vector<double> marks = {41, 55, 62, 64, 30, 70, 69, 73, 71};
  const Curve nine = fit_curve(attempts_of(marks));
  ASSERT_EQ(nine.kind, CurveKind::inverse);  // too few for the exponential
  EXPECT_NEAR(nine.a, 73.9700639129, 1e-6);
  EXPECT_NEAR(nine.b, 34.2617951544, 1e-6);
  EXPECT_NEAR(*nine.n90, 10 * nine.b / nine.a, 1e-9);
  EXPECT_EQ(fit_curve(attempts_of({1, 2, 3, 4})).kind, CurveKind::points);
}

TEST(Study, CurveOnTwoBonesHasAnOffset) {
  std::vector<Attempt> attempts = attempts_of({41, 55, 62, 64, 30, 70, 69, 73, 71});
  const int bone[] = {1, 1, 2, 1, 2, 2, 1, 2, 1};
  for (std::size_t n = 0; n < attempts.size(); ++n)
    attempts[n].bone = bone[n] == 1 ? "left" : "right";
  const Curve out = fit_curve(attempts);
  ASSERT_EQ(out.kind, CurveKind::inverse);
  EXPECT_NEAR(out.a, 73.578850576656, 1e-5);
  EXPECT_NEAR(out.b, 33.879904409082, 1e-5);
  ASSERT_EQ(out.offsets.size(), 2U);
  EXPECT_NEAR(out.offsets[1], 0.891125525614, 1e-5);
}

TEST(Study, ExponentialWhereItFitsBetter) {
  // no residual is large, so the weights are 1 and R's nls gives the same
  const Curve out = fit_curve(attempts_of(
      {30.75, 43.45, 52.87, 60.24, 64.82, 67.22, 70.25, 71.01, 72.09, 73.65, 74.18, 73.75}));
  ASSERT_EQ(out.kind, CurveKind::exponential);
  EXPECT_NEAR(out.a, 75.0559856, 1e-4);
  EXPECT_NEAR(out.b, 63.6773244, 1e-4);
  EXPECT_NEAR(out.c, 0.3569599, 1e-6);
  EXPECT_NEAR(*out.aicc_exponential, -8.51038427, 1e-5);
  EXPECT_NEAR(out.at(*out.n90), 0.9 * out.a, 1e-9);
}

TEST(Study, GuidedAttemptsAreOutsideOfTheFit) {
  std::vector<Attempt> attempts = attempts_of({41, 55, 62, 64, 68, 70, 69});
  const Curve before = fit_curve(attempts);
  attempts.push_back({8, "", 100, true});
  attempts.push_back({9, "", 0, true});
  const Curve after = fit_curve(attempts);
  EXPECT_EQ(after.guided, 2);
  EXPECT_EQ(after.unguided, 7);
  EXPECT_DOUBLE_EQ(after.a, before.a);
  EXPECT_DOUBLE_EQ(after.b, before.b);
}

TEST(Study, BandHoldsTheTrueCurve) {
  // 95 % are meant to hold; of 100 curves through 9 attempts at least 86 must
  int held = 0;
  for (int time = 0; time < 100; ++time) {
    people::RandomStream random(7, static_cast<std::uint64_t>(time));
    std::vector<double> marks;
    for (int n = 1; n <= 9; ++n) marks.push_back(80 - 40.0 / n + 3 * random.normal());
    const std::vector<Attempt> attempts = attempts_of(marks);
    const std::vector<Interval> out = band(attempts, fit_curve(attempts), 9);
    ASSERT_EQ(out.size(), 9U);
    held += out[4].low <= 72 && 72 <= out[4].high ? 1 : 0;
  }
  RecordProperty("held", held);
  EXPECT_GE(held, 86);
}

TEST(Study, TablesSayWhatIsWrongAndWhere) {
  const auto good =
      parse_table("\"mark\", learner ,x\n# a remark\n\n3.5,\"Ann, the \"\"first\"\"\",1\n", "m.csv",
                  {"learner", "mark"}, {"bone"});
  ASSERT_TRUE(good.ok()) << good.error().text;
  ASSERT_EQ(good->rows.size(), 1U);
  EXPECT_EQ(good->rows[0][0], "Ann, the \"first\"");
  EXPECT_EQ(good->rows[0][2], "");
  EXPECT_EQ(
      parse_table("learner,mark\n\"#1\",2\n#1,2\n", "m.csv", {"learner", "mark"})->rows.size(), 1U);
  EXPECT_DOUBLE_EQ(*good->number(0, 1), 3.5);
  const std::pair<const char*, const char*> cases[] = {
      {"", "m.csv: is empty"},
      {"learner\nx\n", "m.csv: line 1: column mark is missing"},
      {"learner,mark,mark\n", "column mark appears twice"},
      {"learner,mark\n", "m.csv: has no rows"},
      {"learner,mark\na,1,2\n", "m.csv: line 2: 3 values, but the first line names 2 columns"},
      {"learner,mark\n\"a,1\n", "m.csv: line 2: a quote is opened and not closed"},
  };
  for (const auto& [text, sentence] : cases) {
    const auto bad = parse_table(text, "m.csv", {"learner", "mark"});
    ASSERT_FALSE(bad.ok()) << text;
    EXPECT_NE(bad.error().text.find(sentence), std::string::npos) << bad.error().text;
  }
  const auto words = parse_table("learner,mark\na,high\nb,inf\nc,\n", "m.csv", {"learner", "mark"});
  ASSERT_TRUE(words.ok());
  EXPECT_EQ(words->number(0, 1).error().text,
            "m.csv: line 2: column mark: \"high\" is not a number");
  EXPECT_FALSE(words->number(1, 1).ok());
  EXPECT_FALSE(words->number(2, 1).ok());
  EXPECT_FALSE(words->flag(0, 1).ok());
}

}  // namespace
}  // namespace burr::school::study
