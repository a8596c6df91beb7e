#include "burr/haptics/six/least_twist.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burr::haptics {
namespace {

// a row violated by less than this is accepted; the gaps are floats                   [voxel]
constexpr double kTolerance = 2e-6;
// the same where nothing better is found: 1e-4 mm at a voxel of 0.25 mm               [voxel]
constexpr double kAccepted = 4e-4;
constexpr double kDependent = 1e-9;  // share of a row that is square to those in hand  [-]
constexpr int kPasses = 60;          // rows taken
constexpr int kMost = 6;

struct Hand {  // the rows in hand
  Six a[kMost];
  double push[kMost] = {};
  int index[kMost] = {};
  int count = 0;
};

Six row_of(const Rows& rows, int j) BURR_RT {
  return {static_cast<double>(rows.n[0][j]), static_cast<double>(rows.n[1][j]),
          static_cast<double>(rows.n[2][j]), static_cast<double>(rows.m[0][j]),
          static_cast<double>(rows.m[1][j]), static_cast<double>(rows.m[2][j])};
}

// Coefficients of `a` over the rows in hand (least squares), by Cholesky of their Gram matrix.
void over_rows(const Hand& hand, const Six& a, double* r) BURR_RT {
  double l[kMost][kMost];
  for (int i = 0; i < hand.count; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = dot6(hand.a[i], hand.a[j]);
      for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(std::max(sum, 1e-14)) : sum / l[j][j];
    }
    double sum = dot6(hand.a[i], a);
    for (int k = 0; k < i; ++k) sum -= l[i][k] * r[k];
    r[i] = sum / l[i][i];
  }
  for (int i = hand.count - 1; i >= 0; --i) {
    double sum = r[i];
    for (int k = i + 1; k < hand.count; ++k) sum -= l[k][i] * r[k];
    r[i] = sum / l[i][i];
  }
}

void drop(Hand& hand, int which) BURR_RT {
  for (int i = which; i + 1 < hand.count; ++i) {
    hand.a[i] = hand.a[i + 1];
    hand.push[i] = hand.push[i + 1];
    hand.index[i] = hand.index[i + 1];
  }
  --hand.count;
}

// Takes row j in hand, and lets go of those that would have to pull. False: no z satisfies both it
// and the rows in hand.
bool take(Hand& hand, Six& z, const Six& a, double gap, int j) BURR_RT {
  double push = 0;
  const double size = dot6(a, a);
  for (int round = 0; round < 2 * kMost + 2; ++round) {
    double r[kMost] = {};
    over_rows(hand, a, r);
    Six way = a;
    for (int i = 0; i < hand.count; ++i)
      for (std::size_t k = 0; k < 6; ++k) way[k] -= r[i] * hand.a[i][k];
    const double square = dot6(way, way);
    double until_drop = std::numeric_limits<double>::infinity();
    int first = -1;
    for (int i = 0; i < hand.count; ++i)
      if (r[i] > 1e-12 && hand.push[i] / r[i] < until_drop) {
        until_drop = hand.push[i] / r[i];
        first = i;
      }
    const bool free = square > kDependent * size && hand.count < kMost;
    const double violated = -(dot6(a, z) + gap);
    if (violated <= 0) return true;  // what was dropped made room
    const double until_held = free ? violated / square : std::numeric_limits<double>::infinity();
    const double step = std::min(until_drop, until_held);
    if (!(step < std::numeric_limits<double>::infinity())) return false;
    if (free)
      for (std::size_t k = 0; k < 6; ++k) z[k] += step * way[k];
    for (int i = 0; i < hand.count; ++i) hand.push[i] -= step * r[i];
    push += step;
    if (until_held <= until_drop) {
      hand.a[hand.count] = a;
      hand.push[hand.count] = push;
      hand.index[hand.count++] = j;
      return true;
    }
    drop(hand, first);
  }
  return false;
}

}  // namespace

LeastTwist least_twist(const Rows& rows, const Six& wanted, WorstRow worst) BURR_RT {
  LeastTwist twist;
  twist.z = wanted;
  Hand hand;
  double low = 0;
  bool fine = false;
  for (int pass = 0; pass < kPasses && !fine; ++pass) {
    float z[6];
    for (std::size_t k = 0; k < 6; ++k) z[k] = static_cast<float>(twist.z[k]);
    float value = 0;
    const int j = worst(rows, z, value);
    low = j < 0 ? 0 : -static_cast<double>(value);
    fine = low <= kTolerance;
    for (int i = 0; i < hand.count; ++i) fine |= hand.index[i] == j;  // as exact as floats allow
    if (fine) break;
    if (!take(hand, twist.z, row_of(rows, j), static_cast<double>(rows.gap[j]), j)) break;
  }
  if (!fine && low > kAccepted) {
    LeastTwist still;
    still.solved = false;
    return still;
  }
  // sums of many small steps: the pushes give the same move without their rounding
  twist.z = wanted;
  for (int i = 0; i < hand.count; ++i) {
    for (std::size_t k = 0; k < 6; ++k) twist.z[k] += hand.push[i] * hand.a[i][k];
    twist.index[i] = hand.index[i];
    twist.push[i] = hand.push[i];
  }
  twist.active = hand.count;
  return twist;
}

}  // namespace burr::haptics
