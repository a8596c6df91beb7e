#include "burr/school/study/curve.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "burr/people/random_stream.h"
#include "burr/school/study/resample.h"

namespace burr::school::study {
namespace {

constexpr double kHuber = 1.345;
constexpr int kDraws = 1000;
constexpr double kLeastRate = 0.01, kMostRate = 3;  // of the exponential, per attempt

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

struct Points {
  Vector number, mark;
  std::vector<int> bone;
  int bones = 1;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5);
}

// Columns: 1, -shape(n), and one for each bone after the first.
template <class Shape>
Matrix design(const Points& points, const Shape& shape) {
  Matrix out = Matrix::Zero(points.number.size(), 1 + points.bones);
  for (Eigen::Index n = 0; n < points.number.size(); ++n) {
    out(n, 0) = 1;
    out(n, 1) = -shape(points.number[n]);
    const int bone = points.bone[static_cast<std::size_t>(n)];
    if (bone > 0) out(n, 1 + bone) = 1;
  }
  return out;
}

struct Fit {
  Vector coefficients, residuals, leverage;
  double scale = 0;
};

double scale_of(const Vector& residuals) {
  std::vector<double> sizes;
  for (const double r : residuals) sizes.push_back(std::abs(r));
  return median(sizes) / 0.6745;
}

// Iterated weighted least squares, from plain least squares.
Fit robust(const Matrix& x, const Vector& y) {
  Fit fit;
  Vector weights = Vector::Ones(y.size());
  for (int n = 0; n < 200; ++n) {
    const Vector root = weights.cwiseSqrt();
    const Matrix weighted = root.asDiagonal() * x;
    const auto solver = weighted.colPivHouseholderQr();
    const Vector next = solver.solve(root.cwiseProduct(y));
    const bool settled = n > 0 && (next - fit.coefficients).norm() <= 1e-12 * (1 + next.norm());
    fit.coefficients = next;
    fit.residuals = y - x * next;
    fit.scale = scale_of(fit.residuals);
    const double limit = kHuber * fit.scale;
    if (settled || !(fit.scale > 1e-12 * (1 + y.cwiseAbs().maxCoeff()))) break;
    for (Eigen::Index k = 0; k < y.size(); ++k) {
      const double size = std::abs(fit.residuals[k]);
      weights[k] = size <= limit ? 1 : limit / size;
    }
  }
  const Matrix q = x.colPivHouseholderQr().householderQ() * Matrix::Identity(x.rows(), x.cols());
  fit.leverage = q.rowwise().squaredNorm();
  return fit;
}

// Huber's loss with this scale; half the sum of squares where no residual is large.
double loss(const Vector& residuals, double scale) {
  double sum = 0;
  const double limit = kHuber * scale;
  for (const double r : residuals) {
    const double size = std::abs(r);
    sum += size <= limit ? 0.5 * r * r : limit * (size - 0.5 * limit);
  }
  return sum;
}

// parameters: those of the mean; the variance is one more.
double aicc(double loss, Eigen::Index count, Eigen::Index parameters) {
  const auto n = static_cast<double>(count), k = static_cast<double>(parameters + 1);
  return n * std::log(std::max(2 * loss / n, 1e-300)) + 2 * k + 2 * k * (k + 1) / (n - k - 1);
}

Fit inverse_fit(const Points& points) {
  return robust(design(points, [](double n) { return 1 / n; }), points.mark);
}

struct Rated {
  double rate = 0;
  Fit fit;
};

Rated at_rate(const Points& points, double rate) {
  return {rate,
          robust(design(points, [rate](double n) { return std::exp(-rate * n); }), points.mark)};
}

double badness(const Points& points, double log_rate, double scale) {
  return loss(at_rate(points, std::exp(log_rate)).fit.residuals, scale);
}

// The rate with the least loss between two, by golden section; both losses are taken with the same scale.
Rated best_between(const Points& points, double scale, double a, double b, int steps) {
  constexpr double kGolden = 0.6180339887498949;
  double c = b - kGolden * (b - a), d = a + kGolden * (b - a);
  double of_c = badness(points, c, scale), of_d = badness(points, d, scale);
  for (int n = 0; n < steps; ++n) {
    if (of_c < of_d) {
      b = d;
      d = c;
      of_d = of_c;
      c = b - kGolden * (b - a);
      of_c = badness(points, c, scale);
    } else {
      a = c;
      c = d;
      of_c = of_d;
      d = a + kGolden * (b - a);
      of_d = badness(points, d, scale);
    }
  }
  return at_rate(points, std::exp((a + b) / 2));
}

// From a grid over all rates.
Rated exponential_fit(const Points& points, double scale) {
  const double low = std::log(kLeastRate), high = std::log(kMostRate);
  constexpr int kSteps = 40;
  int best = 0;
  double least = 0;
  for (int n = 0; n <= kSteps; ++n) {
    const double here = badness(points, low + (high - low) * n / kSteps, scale);
    if (n == 0 || here < least) {
      best = n;
      least = here;
    }
  }
  const auto place = [&](int n) { return low + (high - low) * std::clamp(n, 0, kSteps) / kSteps; };
  return best_between(points, scale, place(best - 1), place(best + 1), 40);
}

// A bone counts from its first attempt without guidance: one on which every attempt was guided has no offset.
Points points_of(const std::vector<Attempt>& attempts, std::vector<std::string>& bones) {
  Points out;
  std::vector<const Attempt*> used;
  for (const Attempt& attempt : attempts) {
    if (attempt.guided) continue;
    used.push_back(&attempt);
    if (std::find(bones.begin(), bones.end(), attempt.bone) == bones.end())
      bones.push_back(attempt.bone);
  }
  out.number.resize(static_cast<Eigen::Index>(used.size()));
  out.mark.resize(out.number.size());
  for (std::size_t n = 0; n < used.size(); ++n) {
    out.number[static_cast<Eigen::Index>(n)] = used[n]->number;
    out.mark[static_cast<Eigen::Index>(n)] = used[n]->mark;
    out.bone.push_back(
        static_cast<int>(std::find(bones.begin(), bones.end(), used[n]->bone) - bones.begin()));
  }
  out.bones = std::max(1, static_cast<int>(bones.size()));
  return out;
}

std::optional<double> attempts_to_90(const Curve& curve) {
  if (!(curve.b > 0) || !(curve.a > 0)) return std::nullopt;
  if (curve.kind == CurveKind::inverse) return std::max(1.0, 10 * curve.b / curve.a);
  return std::max(1.0, std::log(10 * curve.b / curve.a) / curve.c);
}

void take(Curve& curve, CurveKind kind, const Fit& fit, double rate) {
  curve.kind = kind;
  curve.a = fit.coefficients[0];
  curve.b = fit.coefficients[1];
  curve.c = rate;
  curve.scale = fit.scale;
  curve.offsets.assign(1, 0);
  for (Eigen::Index n = 2; n < fit.coefficients.size(); ++n)
    curve.offsets.push_back(fit.coefficients[n]);
  curve.n90 = attempts_to_90(curve);
}

// A curve like this one through other marks. The rate is looked for from a quarter of the first one's to four times it.
Curve refit(const Points& points, const Curve& like) {
  Curve out;
  if (like.kind == CurveKind::inverse) {
    take(out, like.kind, inverse_fit(points), 0);
  } else {
    const Rated rated = best_between(points, like.scale, std::log(std::max(kLeastRate, like.c / 4)),
                                     std::log(std::min(kMostRate, like.c * 4)), 12);
    take(out, like.kind, rated.fit, rated.rate);
  }
  return out;
}

}  // namespace

double Curve::at(double number) const {
  if (kind == CurveKind::points) return std::nan("");
  return a - b * (kind == CurveKind::inverse ? 1 / number : std::exp(-c * number));
}

Curve fit_curve(const std::vector<Attempt>& attempts) {
  Curve out;
  const Points points = points_of(attempts, out.bones);
  out.unguided = static_cast<int>(points.number.size());
  out.guided = static_cast<int>(attempts.size()) - out.unguided;
  // the attempts must also hold more than the curve's numbers, and must not all have the same number
  const Eigen::Index parameters = 1 + points.bones;
  if (out.unguided < std::max<Eigen::Index>(kFewestAttempts, parameters + 3) ||
      points.number.minCoeff() == points.number.maxCoeff())
    return out;
  const Fit inverse = inverse_fit(points);
  take(out, CurveKind::inverse, inverse, 0);
  const double scale = inverse.scale;
  out.aicc_inverse = aicc(loss(inverse.residuals, scale), points.number.size(), parameters);
  if (out.unguided < std::max<Eigen::Index>(kFewestForExponential, parameters + 4)) return out;
  const Rated rated = exponential_fit(points, scale);
  out.aicc_exponential =
      aicc(loss(rated.fit.residuals, scale), points.number.size(), parameters + 1);
  if (*out.aicc_exponential < out.aicc_inverse)
    take(out, CurveKind::exponential, rated.fit, rated.rate);
  return out;
}

std::vector<Interval> band(const std::vector<Attempt>& attempts, const Curve& curve, int last,
                           std::uint64_t seed) {
  if (curve.kind == CurveKind::points) return {};
  std::vector<std::string> bones;
  const Points points = points_of(attempts, bones);
  const Fit fit =
      curve.kind == CurveKind::inverse ? inverse_fit(points) : at_rate(points, curve.c).fit;
  const Vector fitted = points.mark - fit.residuals;
  Vector spread = fit.residuals;
  for (Eigen::Index n = 0; n < spread.size(); ++n)
    spread[n] /= std::sqrt(std::max(1e-3, 1 - fit.leverage[n]));
  spread.array() -= spread.mean();
  std::vector<std::vector<double>> drawn(static_cast<std::size_t>(last));
  for (int draw = 0; draw < kDraws; ++draw) {
    people::RandomStream random(seed, static_cast<std::uint64_t>(draw));
    Points again = points;
    for (Eigen::Index n = 0; n < spread.size(); ++n)
      again.mark[n] = fitted[n] + spread[random.below(static_cast<int>(spread.size()))];
    const Curve one = refit(again, curve);
    for (int n = 1; n <= last; ++n) drawn[static_cast<std::size_t>(n - 1)].push_back(one.at(n));
  }
  std::vector<Interval> out;
  for (std::vector<double>& values : drawn) {
    std::sort(values.begin(), values.end());
    out.push_back({quantile(values, 0.025), quantile(values, 0.975)});
  }
  return out;
}

}  // namespace burr::school::study
