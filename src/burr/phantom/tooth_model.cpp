#include "burr/phantom/tooth_model.h"

#include <algorithm>
#include <cmath>

namespace burr::phantom {
namespace {

RoundCone cone(const Vec3& a, double radius_a, const Vec3& b, double radius_b) {
  return {a, b, radius_a * kMm, radius_b * kMm};
}

double rounded_box(const Vec3& p, const Vec3& centre, const Vec3& half, double round) {
  const Vec3 out = (p - centre).cwiseAbs() - (half - Vec3::Constant(round));
  return round - out.cwiseMax(0.0).norm() - std::min(out.maxCoeff(), 0.0);
}

}  // namespace

double ToothModel::depth(const Vec3& p) const {
  const double mm = kMm;
  if (!molar) {
    static const RoundCone cusps[] = {cone(at_mm(-2.0, 0, 5.4), 1.9, at_mm(-1.9, 0, 6.4), 1.1),
                                      cone(at_mm(2.0, 0, 5.4), 1.9, at_mm(1.9, 0, 6.4), 1.1)};
    static const RoundCone fissure = cone(at_mm(0, -1.6, 7.4), 0.7, at_mm(0, 1.6, 7.4), 0.7);
    static const RoundCone root = cone(at_mm(0, 0, 0.5), 3.1, at_mm(0, 0.7, -13.5), 0.9);
    double depth = rounded_box(p, at_mm(0, 0, 3.4), at_mm(4.0, 3.4, 3.8), 2.8 * mm);
    for (const RoundCone& cusp : cusps) depth = blend(depth, cusp, p, 1.0 * mm);
    depth = carve_soft(depth, fissure, p, 0.8 * mm);
    return blend(depth, root, p, 1.5 * mm);
  }
  const auto cusp = [](const Vec3& at) {
    return cone(at + at_mm(0, 0, 5.2), 2.1, at * 0.92 + at_mm(0, 0, 6.5), 1.0);
  };
  static const RoundCone cusps[] = {cusp(at_mm(-2.6, -2.8, 0)), cusp(at_mm(-2.6, 2.6, 0)),
                                    cusp(at_mm(2.6, -3.2, 0)), cusp(at_mm(2.9, 0.3, 0)),
                                    cusp(at_mm(2.4, 3.3, 0))};
  static const RoundCone fissures[] = {
      cone(at_mm(-0.2, -3.2, 7.3), 0.7, at_mm(0.2, 3.2, 7.3), 0.7),
      cone(at_mm(-3.4, -0.2, 7.6), 0.6, at_mm(0.4, -0.2, 7.2), 0.6),
      cone(at_mm(0.2, 1.7, 7.2), 0.6, at_mm(3.8, 1.9, 7.6), 0.6)};
  const auto root = [](double side, double end) {
    return cone(at_mm(side * 1.7, end * 2.5, -1.5), 1.9, at_mm(side * 0.9, end * 3.5 + 0.6, -13.5),
                0.8);
  };
  static const RoundCone roots[] = {root(-1, -1), root(1, -1), root(-1, 1), root(1, 1)};
  double depth = rounded_box(p, at_mm(0, 0, 3.3), at_mm(4.9, 5.4, 3.7), 3.0 * mm);
  // cusps, and the fissure between them
  for (const RoundCone& one : cusps) depth = blend(depth, one, p, 1.0 * mm);
  for (const RoundCone& one : fissures) depth = carve_soft(depth, one, p, 0.9 * mm);
  // waist, and two roots, each flat from front to back
  depth = blend(depth, rounded_box(p, at_mm(0, 0, -0.8), at_mm(4.1, 4.5, 2.0), 1.9 * mm), 1.5 * mm);
  for (const RoundCone& one : roots) depth = blend(depth, one, p, 1.6 * mm);
  return depth;
}

double ToothModel::pulp(const Vec3& p) const {
  const double mm = kMm;
  if (!molar) {
    static const RoundCone chamber = cone(at_mm(0, 0, 2.6), 0.8, at_mm(0, 0, 0), 0.9);
    static const RoundCone canal = cone(at_mm(0, 0, 0), 0.75, at_mm(0, 0.7, -13.0), 0.2);
    return blend(chamber.depth(p), canal, p, 0.6 * mm);
  }
  static const RoundCone in_front[] = {
      cone(at_mm(-1.2, -2.0, 0.3), 0.6, at_mm(-0.9, -2.9, -13.0), 0.22),
      cone(at_mm(1.2, -2.0, 0.3), 0.6, at_mm(0.9, -2.9, -13.0), 0.22)};
  static const RoundCone behind = cone(at_mm(0, 2.0, 0.3), 0.75, at_mm(0, 4.0, -13.0), 0.25);
  double pulp = rounded_box(p, at_mm(0, 0, 0.9), at_mm(2.1, 2.6, 1.3), 1.0 * mm);
  for (const RoundCone& canal : in_front) pulp = blend(pulp, canal, p, 0.5 * mm);
  return blend(pulp, behind, p, 0.5 * mm);
}

double ToothModel::enamel(const Vec3& p) const {
  // thins out to zero at the neck
  const double t = std::clamp((p.z() / kMm + 0.2) / 3.5, 0.0, 1.0);
  return 1.7 * kMm * t * (2 - t);
}

}  // namespace burr::phantom
