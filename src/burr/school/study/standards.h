// school/study/standards.h - where a centre may set its standard: a cut between marks. burr proposes, a person decides.
//
// Contrasting groups (Jorgensen, Konge, Subhi, Advances in Simulation 3:5, 2018): the marks of people who cannot yet (low)
// and of people who can (high) are each taken as normal; the cut is where both densities cross between the means,
//
//     (c - m_l)^2 / s_l^2 + 2 ln s_l = (c - m_h)^2 / s_h^2 + 2 ln s_h
//
// and a share 1 - Phi((c - m_l) / s_l) of the low group would pass, Phi((c - m_h) / s_h) of the high group would fail. The
// observed shares stand beside these. Angoff (1971): each judge gives for each item the probability that a candidate who
// just suffices meets it; the cut is the mean over judges of the sum over items. Hofstee (1983): judges give the lowest
// and highest cut and share of failures that they accept; the cut is where the curve of failures crosses the line from
// (lowest cut, highest share) to (highest cut, lowest share), each the mean over judges. Thread: any.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/study/interval.h"

namespace burr::school::study {

constexpr int kFewestOfAGroup = 8;
constexpr int kFewestJudges = 5;

struct Contrast {
  int n_low = 0, n_high = 0;
  double mean_low = 0, mean_high = 0, deviation_low = 0, deviation_high = 0;
  double cut = 0;
  // Shares. pass: of the low group that would pass; fail: of the high group that would fail.
  double pass_seen = 0, fail_seen = 0, pass_expected = 0, fail_expected = 0;
  Interval cut_95 = {}, pass_95 = {},
           fail_95 = {};  // of 2000 samples of both groups; of the expected shares
};
// Error: fewer than 8 in a group, the low group's mean is not below the other's, a group without spread, or densities
// that do not cross between the means.
[[nodiscard]] Result<Contrast> contrasting_groups(const std::vector<double>& low,
                                                  const std::vector<double>& high,
                                                  std::uint64_t seed = 1);

struct Angoff {
  int judges = 0, items = 0;
  double cut = 0;        // items met
  double deviation = 0;  // of the judges' sums
  Interval cut_95 = {};  // mean and 1.96 standard errors of the judges
};
// probabilities[judge][item]. Error: fewer than 5 judges, or judges with different numbers of items.
[[nodiscard]] Result<Angoff> angoff(const std::vector<std::vector<double>>& probabilities);

struct HofsteeJudge {
  double cut_low = 0, cut_high = 0;    // marks
  double fail_low = 0, fail_high = 0;  // shares, 0 to 1
};
struct Hofstee {
  int judges = 0, marks = 0;
  double cut = 0, fail = 0;
};
// Error: fewer than 5 judges or 8 marks, a judge whose lowest exceeds the highest, or a curve outside of the judges' frame.
[[nodiscard]] Result<Hofstee> hofstee(const std::vector<HofsteeJudge>& judges,
                                      const std::vector<double>& marks);

}  // namespace burr::school::study
