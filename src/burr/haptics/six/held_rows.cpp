#include "burr/haptics/six/held_rows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace burr::haptics::twelve {
namespace {

constexpr double kDependent = 1e-9;

double dot12(const Twelve& a, const Twelve& b) BURR_RT {
  double sum = 0;
  for (std::size_t k = 0; k < 12; ++k) sum += a[k] * b[k];
  return sum;
}

void over_rows(const Held& held, const Twelve& a, double* r) BURR_RT {
  double l[kMost][kMost];
  for (int i = 0; i < held.count; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = dot12(held.row[i], held.row[j]);
      for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(std::max(sum, 1e-14)) : sum / l[j][j];
    }
    double sum = dot12(held.row[i], a);
    for (int k = 0; k < i; ++k) sum -= l[i][k] * r[k];
    r[i] = sum / l[i][i];
  }
  for (int i = held.count - 1; i >= 0; --i) {
    double sum = r[i];
    for (int k = i + 1; k < held.count; ++k) sum -= l[k][i] * r[k];
    r[i] = sum / l[i][i];
  }
}

void drop(Held& held, int which) BURR_RT {
  for (int i = which; i + 1 < held.count; ++i) {
    held.row[i] = held.row[i + 1];
    held.push[i] = held.push[i + 1];
    held.name[i] = held.name[i + 1];
  }
  --held.count;
}

}  // namespace

bool take(Held& held, Twelve& y, const Twelve& a, double gap, const Name& name) BURR_RT {
  double push = 0;
  const double size = dot12(a, a);
  for (int round = 0; round < 2 * kMost + 2; ++round) {
    double r[kMost] = {};
    over_rows(held, a, r);
    Twelve way = a;
    for (int i = 0; i < held.count; ++i)
      for (std::size_t k = 0; k < 12; ++k) way[k] -= r[i] * held.row[i][k];
    const double square = dot12(way, way);
    double until_drop = std::numeric_limits<double>::infinity();
    int first = -1;
    for (int i = 0; i < held.count; ++i)
      if (r[i] > 1e-12 && held.push[i] / r[i] < until_drop) {
        until_drop = held.push[i] / r[i];
        first = i;
      }
    const bool free = square > kDependent * size && held.count < kMost;
    const double violated = -(dot12(a, y) + gap);
    if (violated <= 0) return true;  // what was dropped made room
    const double until_held = free ? violated / square : std::numeric_limits<double>::infinity();
    const double step = std::min(until_drop, until_held);
    if (!(step < std::numeric_limits<double>::infinity())) return false;
    if (free)
      for (std::size_t k = 0; k < 12; ++k) y[k] += step * way[k];
    for (int i = 0; i < held.count; ++i) held.push[i] -= step * r[i];
    push += step;
    if (until_held <= until_drop) {
      held.row[held.count] = a;
      held.push[held.count] = push;
      held.name[held.count++] = name;
      return true;
    }
    drop(held, first);
  }
  return false;
}

}  // namespace burr::haptics::twelve
