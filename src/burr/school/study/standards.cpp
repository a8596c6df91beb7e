#include "burr/school/study/standards.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "burr/school/study/resample.h"

namespace burr::school::study {
namespace {

constexpr int kDraws = 2000;

double normal_below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values, double mean) {
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

// Where both densities are equal, between the means. None: nowhere.
std::optional<double> crossing(double m_l, double s_l, double m_h, double s_h) {
  const double a = 1 / (s_l * s_l) - 1 / (s_h * s_h);
  const double b = -2 * (m_l / (s_l * s_l) - m_h / (s_h * s_h));
  const double c = m_l * m_l / (s_l * s_l) - m_h * m_h / (s_h * s_h) + 2 * std::log(s_l / s_h);
  std::vector<double> roots;
  if (std::abs(a) < 1e-9 * (1 / (s_l * s_l) + 1 / (s_h * s_h))) {
    roots = {(m_l + m_h) / 2};
  } else {
    const double inside = b * b - 4 * a * c;
    if (inside < 0) return std::nullopt;
    const double q = -0.5 * (b + std::copysign(std::sqrt(inside), b));  // without loss of digits
    roots = {q / a, q != 0 ? c / q : 0};
  }
  for (const double root : roots)
    if (root >= m_l && root <= m_h) return root;
  return std::nullopt;
}

// Mean, spread, cut and expected shares. None: no cut.
std::optional<Contrast> contrast(const std::vector<double>& low, const std::vector<double>& high) {
  Contrast out;
  out.mean_low = mean_of(low);
  out.mean_high = mean_of(high);
  out.deviation_low = deviation_of(low, out.mean_low);
  out.deviation_high = deviation_of(high, out.mean_high);
  if (!(out.mean_low < out.mean_high) || !(out.deviation_low > 0) || !(out.deviation_high > 0))
    return std::nullopt;
  const auto cut = crossing(out.mean_low, out.deviation_low, out.mean_high, out.deviation_high);
  if (!cut) return std::nullopt;
  out.cut = *cut;
  out.pass_expected = 1 - normal_below((*cut - out.mean_low) / out.deviation_low);
  out.fail_expected = normal_below((*cut - out.mean_high) / out.deviation_high);
  return out;
}

std::vector<double> drawn_from(const std::vector<double>& values, people::RandomStream& random) {
  std::vector<double> out;
  for (std::size_t n = 0; n < values.size(); ++n)
    out.push_back(values[static_cast<std::size_t>(random.below(static_cast<int>(values.size())))]);
  return out;
}

}  // namespace

Result<Contrast> contrasting_groups(const std::vector<double>& low, const std::vector<double>& high,
                                    std::uint64_t seed) {
  if (low.size() < kFewestOfAGroup || high.size() < kFewestOfAGroup)
    return error(fmt::format(
        "contrasting groups need {} marks in each group; there are {} in the low one and {} in the "
        "high one",
        kFewestOfAGroup, low.size(), high.size()));
  if (!(mean_of(low) < mean_of(high)))
    return error(fmt::format(
        "the mean of the low group, {:.3g}, is not below that of the high group, {:.3g}: the marks "
        "do not tell the groups apart",
        mean_of(low), mean_of(high)));
  for (const auto* group : {&low, &high})
    if (!(deviation_of(*group, mean_of(*group)) > 0))
      return error(
          fmt::format("all marks of the {} group are {:.3g}: without spread there is no cut",
                      group == &low ? "low" : "high", group->front()));
  auto out = contrast(low, high);
  if (!out)
    return error(
        "the two groups' densities do not cross between their means: their spreads differ too "
        "much; a standard "
        "from these marks would be arbitrary");
  out->n_low = static_cast<int>(low.size());
  out->n_high = static_cast<int>(high.size());
  const auto share = [](const std::vector<double>& of, auto which) {
    return static_cast<double>(std::count_if(of.begin(), of.end(), which)) /
           static_cast<double>(of.size());
  };
  out->pass_seen = share(low, [&](double mark) { return mark >= out->cut; });
  out->fail_seen = share(high, [&](double mark) { return mark < out->cut; });
  const auto interval = [&](double Contrast::*what) {
    return resampled(kDraws, seed, [&](people::RandomStream& random) -> std::optional<double> {
      const std::vector<double> l = drawn_from(low, random), h = drawn_from(high, random);
      const auto again = contrast(l, h);
      if (!again) return std::nullopt;
      return (*again).*what;
    });
  };
  out->cut_95 = interval(&Contrast::cut);
  out->pass_95 = interval(&Contrast::pass_expected);
  out->fail_95 = interval(&Contrast::fail_expected);
  return *out;
}

Result<Angoff> angoff(const std::vector<std::vector<double>>& probabilities) {
  if (probabilities.size() < kFewestJudges)
    return error(fmt::format("Angoff's method needs {} judges; there are {}", kFewestJudges,
                             probabilities.size()));
  std::vector<double> sums;
  for (const std::vector<double>& judge : probabilities) {
    if (judge.size() != probabilities.front().size())
      return error(fmt::format(
          "judges judged different numbers of items: {} and {}; each judge judges all items",
          probabilities.front().size(), judge.size()));
    sums.push_back(std::accumulate(judge.begin(), judge.end(), 0.0));
  }
  Angoff out;
  out.judges = static_cast<int>(sums.size());
  out.items = static_cast<int>(probabilities.front().size());
  out.cut = mean_of(sums);
  out.deviation = deviation_of(sums, out.cut);
  const double half = 1.96 * out.deviation / std::sqrt(static_cast<double>(out.judges));
  out.cut_95 = {out.cut - half, out.cut + half};
  return out;
}

Result<Hofstee> hofstee(const std::vector<HofsteeJudge>& judges, const std::vector<double>& marks) {
  if (judges.size() < kFewestJudges)
    return error(fmt::format("Hofstee's method needs {} judges; there are {}", kFewestJudges,
                             judges.size()));
  if (marks.size() < kFewestOfAGroup)
    return error(fmt::format("Hofstee's method needs {} marks; there are {}", kFewestOfAGroup,
                             marks.size()));
  HofsteeJudge mean;
  for (const HofsteeJudge& judge : judges) {
    if (judge.cut_low > judge.cut_high || judge.fail_low > judge.fail_high)
      return error("a judge's lowest acceptable value is above the highest");
    const auto n = static_cast<double>(judges.size());
    mean.cut_low += judge.cut_low / n;
    mean.cut_high += judge.cut_high / n;
    mean.fail_low += judge.fail_low / n;
    mean.fail_high += judge.fail_high / n;
  }
  std::vector<double> sorted = marks;
  std::sort(sorted.begin(), sorted.end());
  const auto failing = [&](double cut) {  // share of marks below
    return static_cast<double>(std::lower_bound(sorted.begin(), sorted.end(), cut) -
                               sorted.begin()) /
           static_cast<double>(sorted.size());
  };
  const auto above = [&](double cut) {  // the curve over the line; grows with the cut
    const double width = mean.cut_high - mean.cut_low;
    const double along = width > 0 ? (cut - mean.cut_low) / width : 0;
    return failing(cut) - (mean.fail_high + along * (mean.fail_low - mean.fail_high));
  };
  if (above(mean.cut_low) > 0 || above(mean.cut_high) < 0)
    return error(
        fmt::format("the share of failures is {:.2f} at the lowest and {:.2f} at the highest "
                    "acceptable cut and "
                    "does not meet the judges' frame; ask them again",
                    failing(mean.cut_low), failing(mean.cut_high)));
  double low = mean.cut_low, high = mean.cut_high;
  for (int n = 0; n < 100; ++n) (above((low + high) / 2) > 0 ? high : low) = (low + high) / 2;
  return Hofstee{static_cast<int>(judges.size()), static_cast<int>(marks.size()), high,
                 failing(high)};
}

}  // namespace burr::school::study
