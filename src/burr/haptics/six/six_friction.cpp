#include "burr/haptics/six/six_friction.h"

#include <algorithm>
#include <cmath>

namespace burr::haptics {
namespace {

constexpr int kShareRounds = 4;      // of the places that would have to pull, and are left out
constexpr int kWays = 3;             // directions of the slide that are tried, at most
constexpr int kSteps = 8;            // towards the root of one ellipsoid
constexpr double kRoot = 1e-5;       // of the size of what slides                            [-]
constexpr double kSameWay = 1e-4;    // square of the sine between two directions             [-]
constexpr double kDependent = 1e-6;  // share of a row that is square to those before, squared [-]
// The same of a row on which the tool rests: an edge that is rounded off touches with a normal that is
// tilted by some thousandths, and that is no wall across the slide.
constexpr double kTilted = 1e-3;
constexpr double kRidge = 1e-7;  // of a Gram matrix: directions in which nothing presses   [-]
constexpr double kStiff = 1e8;   // what is held so well does not creep                    [-]
constexpr double kSlow = 0.02;   // of the mean slide: a place near the axis of the turn    [-]
// A tool that slides sticks again below this share of the sliding cone, as the ball's does.
constexpr double kSticksAgain = 0.6;

struct Matrix {
  double at[6][6] = {};  // symmetric; the lower half is used
};

// z of (one * I + scale * m) z = b, by Cholesky: its pivots are at least `one`, but for rounding.
Six solve(const Matrix& m, double one, double scale, const Six& b) BURR_RT {
  double l[6][6], over[6], z[6];  // over: one over the diagonal
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      double sum = scale * m.at[i][j];
      for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = sum * over[j];
    }
    double pivot = scale * m.at[i][i] + one, sum = b[static_cast<std::size_t>(i)];
    for (int k = 0; k < i; ++k) {
      pivot -= l[i][k] * l[i][k];
      sum -= l[i][k] * z[k];
    }
    over[i] = 1 / std::sqrt(std::max(pivot, one));
    z[i] = sum * over[i];
  }
  Six out;
  for (int i = 5; i >= 0; --i) {
    double sum = z[i];
    for (int k = i + 1; k < 6; ++k) sum -= l[k][i] * z[k];
    out[static_cast<std::size_t>(i)] = z[i] = sum * over[i];
  }
  return out;
}

double trace(const Matrix& m) BURR_RT {
  double sum = 0;
  for (int i = 0; i < 6; ++i) sum += m.at[i][i];
  return sum;
}

double quadratic(const Matrix& m, const Six& z) BURR_RT {
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    double row = 0.5 * m.at[i][i] * z[i];
    for (std::size_t j = 0; j < i; ++j) row += m.at[i][j] * z[j];
    sum += 2 * row * z[i];
  }
  return sum;
}

// Without its parts along the rows on which the tool rests.
Six along_bone(const Pressed& pressed, const Six& z) BURR_RT {
  Six out = z;
  for (std::size_t i = 0; i < static_cast<std::size_t>(pressed.rows); ++i) {
    const double along = dot6(pressed.row[i], z);
    for (std::size_t k = 0; k < 6; ++k) out[k] -= along * pressed.row[i][k];
  }
  return out;
}

// Motion along the bone at a place, squared.
double slide2(const Pressed& pressed, std::size_t j, const Six& d) BURR_RT {
  const double x = pressed.arm[0][j], y = pressed.arm[1][j], z = pressed.arm[2][j];
  const double vx = d[0] + (d[4] * z - d[5] * y), vy = d[1] + (d[5] * x - d[3] * z),
               vz = d[2] + (d[3] * y - d[4] * x);
  const double along = dot6(pressed.a[j], d);
  return std::max(0.0, ((vx * vx + vy * vy) + vz * vz) - along * along);
}

// The ellipsoid {f: f^T A^-1 f <= 1} around all f with mu = 1, which touches them in the direction d.
// False: nothing slides.
bool ellipsoid(const Pressed& pressed, const Six& d, Matrix& out) BURR_RT {
  std::array<double, Pressed::kMost> slide;
  const auto count = static_cast<std::size_t>(pressed.count);
  double sum = 0, load = 0;
  for (std::size_t j = 0; j < count; ++j) {
    slide[j] = std::sqrt(slide2(pressed, j, d));
    sum += pressed.share[j] * slide[j];
    load += pressed.share[j];
  }
  if (!(sum > 0) || !(load > 0)) return false;
  const double least = kSlow * sum / load;
  // of q (J^T J - a a^T), J z: motion of the place
  double q = 0, w[3] = {}, ww[6] = {};
  double aa[6][6] = {};
  for (std::size_t j = 0; j < count; ++j) {
    const double weight = pressed.share[j] / std::max(slide[j], least);
    if (weight <= 0) continue;
    const double x = pressed.arm[0][j], y = pressed.arm[1][j], z = pressed.arm[2][j];
    q += weight;
    w[0] += weight * x;
    w[1] += weight * y;
    w[2] += weight * z;
    ww[0] += weight * x * x;
    ww[1] += weight * y * y;
    ww[2] += weight * z * z;
    ww[3] += weight * x * y;
    ww[4] += weight * x * z;
    ww[5] += weight * y * z;
    const Six& a = pressed.a[j];
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t k = 0; k <= r; ++k) aa[r][k] += weight * a[r] * a[k];
  }
  Matrix m;
  for (int k = 0; k < 3; ++k) m.at[k][k] = q;
  // rows of the turn: e_k x w
  m.at[3][1] = -w[2];
  m.at[3][2] = w[1];
  m.at[4][0] = w[2];
  m.at[4][2] = -w[0];
  m.at[5][0] = -w[1];
  m.at[5][1] = w[0];
  m.at[3][3] = ww[1] + ww[2];
  m.at[4][4] = ww[0] + ww[2];
  m.at[5][5] = ww[0] + ww[1];
  m.at[4][3] = -ww[3];
  m.at[5][3] = -ww[4];
  m.at[5][4] = -ww[5];
  // both sides without the parts along the rows
  Six full[6];
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t k = 0; k <= r; ++k) full[r][k] = full[k][r] = sum * (m.at[r][k] - aa[r][k]);
  for (Six& one : full) one = along_bone(pressed, one);
  for (std::size_t k = 0; k < 6; ++k) {
    const Six column = along_bone(
        pressed, {full[0][k], full[1][k], full[2][k], full[3][k], full[4][k], full[5][k]});
    for (std::size_t r = k; r < 6; ++r) out.at[r][k] = column[r];
  }
  return trace(out) > kDependent * sum * trace(m);
}

Six minus(const Six& a) BURR_RT {
  Six out;
  for (std::size_t k = 0; k < 6; ++k) out[k] = -a[k];
  return out;
}

Six plus(const Six& a, const Six& b) BURR_RT {
  Six out;
  for (std::size_t k = 0; k < 6; ++k) out[k] = a[k] + b[k];
  return out;
}

// The slide d = f - t to the ellipsoid mu^2 A, for a t outside it:
//     (u I + mu^2 A) d = -u t   with   g(u) = u / sqrt(mu^2 d^T A d) = 1
// g is nearly a straight line from its value at u = 0 on; inside: that value, below 1.
Six slide_onto(const Matrix& a, double mu, const Six& trial, double inside) BURR_RT {
  const double mu2 = mu * mu;
  const auto at = [&](double u, Six& d) BURR_RT {
    d = solve(a, u, mu2, trial);
    for (double& one : d) one *= -u;
    return u / std::sqrt(std::max(mu2 * quadratic(a, d), 1e-300));
  };
  Six d = minus(trial);
  double low = 0, of_low = inside - 1;
  double high =
      std::max(std::sqrt(std::max(mu2 * quadratic(a, trial), 0.0)), mu2 * trace(a) / kStiff);
  double of_high = at(high, d) - 1;
  for (int grow = 0; grow < 8 && of_high < 0; ++grow) {
    low = high;
    of_low = of_high;
    high *= 4;
    of_high = at(high, d) - 1;
  }
  for (int step = 0; step < kSteps && std::abs(of_high) > kRoot; ++step) {
    const double u = low + (high - low) * of_low / (of_low - of_high);
    const double of_u = at(u, d) - 1;
    if (std::abs(of_u) < kRoot) break;
    if (of_u < 0) {  // the Illinois rule: the end that stays counts half
      low = u;
      of_low = of_u;
      of_high *= 0.5;
    } else {
      high = u;
      of_high = of_u;
      of_low *= 0.5;
    }
  }
  return d;
}

}  // namespace

void rest_on(std::span<const Six> rows, Pressed& pressed) BURR_RT {
  pressed.rows = 0;
  for (const Six& row : rows) {
    // twice: the second time takes away what rounding left
    Six way = along_bone(pressed, along_bone(pressed, row));
    const double square = dot6(way, way);
    if (!(square > kTilted * dot6(row, row)) || pressed.rows == 6) continue;
    const double over = 1 / std::sqrt(square);
    for (double& one : way) one *= over;
    pressed.row[static_cast<std::size_t>(pressed.rows++)] = way;
  }
}

void share_load(const Rows& points, double layer, const Six& pushed, double load,
                Pressed& pressed) BURR_RT {
  pressed.count = 0;
  const int every = (points.count + Pressed::kMost - 1) / Pressed::kMost;
  for (int j = 0; j < points.count; j += every) {
    const auto at = static_cast<std::size_t>(pressed.count++);
    double n[3] = {static_cast<double>(points.n[0][j]), static_cast<double>(points.n[1][j]),
                   static_cast<double>(points.n[2][j])};
    // of length one to the last bit of a double: what lies across the bone must not rub
    const double length = std::sqrt((n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]);
    for (double& one : n) one /= length;
    const double w[3] = {static_cast<double>(points.m[0][j]), static_cast<double>(points.m[1][j]),
                         static_cast<double>(points.m[2][j])};
    pressed.a[at] = {n[0],
                     n[1],
                     n[2],
                     w[1] * n[2] - w[2] * n[1],
                     w[2] * n[0] - w[0] * n[2],
                     w[0] * n[1] - w[1] * n[0]};
    for (std::size_t k = 0; k < 3; ++k) pressed.arm[k][at] = w[k];
    pressed.share[at] = std::clamp(1 - static_cast<double>(points.gap[j]) / layer, 0.0, 1.0);
  }
  const auto count = static_cast<std::size_t>(pressed.count);
  // p_j = share_j max(0, a_j . y) with sum p_j a_j = pushed: a stiff layer that is tilted as the load
  // wants it
  Six y = {};
  std::array<bool, Pressed::kMost> pulls = {};
  for (int round = 0; round < kShareRounds; ++round) {
    Matrix gram;
    bool as_before = round > 0;
    for (std::size_t j = 0; j < count; ++j) {
      const Six& a = pressed.a[j];
      const bool would = round > 0 && dot6(a, y) <= 0;
      as_before = as_before && would == pulls[j];
      pulls[j] = would;
      if (would) continue;
      const double share = pressed.share[j];
      for (std::size_t r = 0; r < 6; ++r)
        for (std::size_t k = 0; k <= r; ++k) gram.at[r][k] += share * a[r] * a[k];
    }
    if (as_before) break;
    y = solve(gram, kRidge * trace(gram) + 1e-30, 1, pushed);
  }
  double sum = 0;
  for (std::size_t j = 0; j < count; ++j) {
    pressed.share[j] *= std::max(0.0, dot6(pressed.a[j], y));
    sum += pressed.share[j];
  }
  const double scale = sum > 0 && std::isfinite(sum) ? load / sum : 0;
  for (std::size_t j = 0; j < count; ++j) pressed.share[j] *= scale;
}

Grip hold(const Pressed& pressed, const Friction& friction, const Six& towards,
          const Grip& before) BURR_RT {
  Grip held;
  const Six trial = along_bone(pressed, towards);
  held.way = before.way;
  const bool was_stuck = before.stuck;
  const double border = was_stuck ? friction.sticks : kSticksAgain * friction.slides;
  held.way = along_bone(pressed, held.way);
  if (!(dot6(held.way, held.way) > 0)) held.way = trial;
  for (int round = 0; round < kWays; ++round) {
    Matrix a;
    if (!ellipsoid(pressed, held.way, a)) {
      if (round > 0 || !ellipsoid(pressed, trial, a)) break;
    }
    const double most = kStiff / trace(a);
    // what of the trial lies along the bone, and how far out in the ellipsoid it is
    const Six off = solve(a, 1, most, minus(trial));
    Six along = plus(trial, off);
    along = plus(along, solve(a, 1, most, minus(along)));  // a second time, against rounding
    const Six normal = solve(a, 1, most, along);
    const double out2 = most * most * quadratic(a, normal);
    held.stuck = out2 <= border * border;
    const double mu = friction.slides;
    Six way = normal;
    held.f = along;
    held.whole = true;
    if (!held.stuck && out2 > mu * mu) {
      if (!(mu > 0)) return {};
      way = slide_onto(a, mu, trial, mu / std::sqrt(out2));
      held.f = plus(trial, way);
      held.whole = false;
    }
    const double both = dot6(way, held.way);
    const bool same = both * both >= (1 - kSameWay) * dot6(way, way) * dot6(held.way, held.way);
    held.way = way;
    if (same) break;
  }
  // the nearest of a set that holds 0 is no farther away
  if (!(dot6(held.f, held.f) <= 1.01 * dot6(trial, trial))) return {};
  return held;
}

}  // namespace burr::haptics
