// school/study/curve.h - a learner's curve: marks over attempts, a fit where there are enough, and its band.
//
//     5 attempts without guidance    y = a - b / n                 plateau a; 90 % of it at n = 10 b / a
//                                                                  (Feldman et al., Surgery 146:381, 2009)
//     10 attempts without guidance   also y = a - b exp(-c n), where its AICc is lower (Hurvich and Tsai 1989)
//
// Guided attempts are shown and are outside of every fit. Attempts on several bones share the curve; each bone after the
// first has an offset of its own. Least squares with Huber's weights (1964; k = 1.345, scale by the median absolute
// residual / 0.6745, as rlm of R's MASS), so one bad day does not bend the curve. The band is the 2.5th and 97.5th of 1000
// curves through resampled residuals, each raised by 1 / sqrt(1 - h) for its leverage h (Davison and Hinkley 1997, 6.2.3).
// Thread: any.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/school/study/interval.h"

namespace burr::school::study {

constexpr int kFewestAttempts = 5;
constexpr int kFewestForExponential = 10;

struct Attempt {
  int number = 1;    // of all attempts of this learner at this operation, from 1
  std::string bone;  // empty: not distinguished
  double mark = 0;
  bool guided = false;
};

enum class CurveKind { points, inverse, exponential };  // points: too few for a fit

struct Curve {
  CurveKind kind = CurveKind::points;
  int unguided = 0, guided = 0;
  double a = 0, b = 0, c = 0;
  std::vector<std::string> bones;
  std::vector<double> offsets;  // of each bone; the first is 0
  double scale = 0;             // robust standard deviation of the marks around the curve
  double aicc_inverse = 0;      // of both curves, where they were fitted
  std::optional<double> aicc_exponential;
  std::optional<double> n90;  // attempts to 90 % of the plateau; none where the marks do not rise

  [[nodiscard]] double at(double number) const;  // on the first bone
};

[[nodiscard]] Curve fit_curve(const std::vector<Attempt>& attempts);

// The band of the fitted curve on the first bone, at each attempt from 1 to `last`. Empty without a fit.
[[nodiscard]] std::vector<Interval> band(const std::vector<Attempt>& attempts, const Curve& curve,
                                         int last, std::uint64_t seed = 1);

}  // namespace burr::school::study
