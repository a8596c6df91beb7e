#include "burr/haptics/least_move.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"

namespace burr::haptics {
namespace {

using math::Vec3;

// a plane violated by less than this is accepted; the gaps are floats  [voxel]
constexpr double kTolerance = 2e-6;
constexpr double kSlack = 1e-7;  // rounding at a corner of nearly parallel planes  [voxel]
constexpr int kPasses = 60;

struct Plane {
  Vec3 n;
  double b = 0;  // n . p >= b
  int index = -1;
};

// Projects `wanted` onto the planes of a subset (all with equality). False: singular, or one of
// them would have to pull. Neighbouring discs are nearly parallel, so everything is computed with
// cross products, never with 1 - cos^2.
bool project(const Plane* const* planes, int count, const Vec3& wanted, Vec3& p,
             double* push) BURR_RT {
  const Vec3& n0 = planes[0]->n;
  if (count == 1) {
    push[0] = (planes[0]->b - math::dot(n0, wanted)) / math::squared_norm(n0);
    p = wanted + push[0] * n0;
  } else if (count == 2) {
    const Vec3& n1 = planes[1]->n;
    const double det = math::squared_norm(n0.cross(n1));
    if (det < 1e-13) return false;
    const double c = math::dot(n0, n1), r0 = planes[0]->b - math::dot(n0, wanted),
                 r1 = planes[1]->b - math::dot(n1, wanted);
    push[0] = (r0 * math::squared_norm(n1) - c * r1) / det;
    push[1] = (r1 * math::squared_norm(n0) - c * r0) / det;
    p = wanted + push[0] * n0 + push[1] * n1;
  } else {
    const Vec3 &n1 = planes[1]->n, &n2 = planes[2]->n;
    const Vec3 c0 = n1.cross(n2), c1 = n2.cross(n0), c2 = n0.cross(n1);
    const double det = math::dot(n0, c0);
    if (std::abs(det) < 1e-10) return false;
    p = (planes[0]->b * c0 + planes[1]->b * c1 + planes[2]->b * c2) / det;
    push[0] = math::dot(p - wanted, c0) / det;
    push[1] = math::dot(p - wanted, c1) / det;
    push[2] = math::dot(p - wanted, c2) / det;
  }
  for (int i = 0; i < count; ++i)
    if (!(push[i] >= -1e-12)) return false;
  return true;
}

// The point nearest to `wanted` that up to four planes allow; keeps the planes that press.
bool project_all(Plane* planes, int& count, const Vec3& wanted, LeastMove& best) BURR_RT {
  bool found = false;
  double best_distance = 0;
  int best_members[3] = {0, 0, 0};
  for (int subset = 1; subset < (1 << count); ++subset) {
    if (__builtin_popcount(static_cast<unsigned>(subset)) > 3) continue;
    const Plane* chosen[3];
    int members[3], size = 0;
    for (int i = 0; i < count; ++i)
      if ((subset >> i & 1) != 0) {
        members[size] = i;
        chosen[size++] = &planes[i];
      }
    Vec3 p;
    double push[3] = {0, 0, 0};
    if (!project(chosen, size, wanted, p, push)) continue;
    bool allowed = true;
    for (int i = 0; i < count; ++i) allowed &= math::dot(planes[i].n, p) >= planes[i].b - kSlack;
    if (!allowed) continue;
    const double distance = math::squared_norm(p - wanted);
    if (found && distance >= best_distance) continue;
    found = true;
    best_distance = distance;
    best.p = p;
    best.active = size;
    for (int i = 0; i < size; ++i) {
      best_members[i] = members[i];
      best.push[i] = push[i];
      best.index[i] = chosen[i]->index;
    }
  }
  if (!found) return false;
  Plane kept[3];
  for (int i = 0; i < best.active; ++i) kept[i] = planes[best_members[i]];
  count = best.active;
  std::copy_n(kept, count, planes);
  return true;
}

}  // namespace

LeastMove least_move(const Candidates& candidates, const Vec3& wanted,
                     MostViolated most_violated) BURR_RT {
  LeastMove move;
  move.p = wanted;
  Plane planes[4];
  int count = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const float p[3] = {static_cast<float>(move.p.x()), static_cast<float>(move.p.y()),
                        static_cast<float>(move.p.z())};
    float worst = 0;
    const int j = most_violated(candidates, p, worst);
    if (j < 0 || static_cast<double>(worst) > -kTolerance) return move;
    for (int i = 0; i < count; ++i)
      if (planes[i].index == j) return move;  // as exact as floats allow
    const Vec3 n(static_cast<double>(candidates.nx[j]), static_cast<double>(candidates.ny[j]),
                 static_cast<double>(candidates.nz[j]));
    planes[count++] = {n, -static_cast<double>(candidates.gap[j]), j};
    if (!project_all(planes, count, wanted, move)) break;
  }
  // standing still is allowed by every plane that is not violated yet
  LeastMove still;
  still.solved = false;
  return still;
}

}  // namespace burr::haptics
