// phantom/spine.cpp - a third lumbar vertebra, by formula.
//
// Frame: LPS around the middle of the body: x left, y backwards, z up. Sizes: Panjabi et al. 1992,
// Spine 17(3) (body 46 x 34 x 28 mm, pedicle 10 mm wide, canal 23 x 18 mm).
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "burr/phantom/phantoms.h"
#include "burr/phantom/sculpt.h"

namespace burr::phantom {
namespace {

using volume::TissueId;
using volume::TissueKind;

enum Id : TissueId { kAir, kCortex, kTrabecular, kSac, kRoots, kMarrow };

// The ends of the upper and the lower of the two cones of a left pedicle, in front and behind.
struct Pedicle {
  static Vec3 upper_front() { return at_mm(13, 8, 7); }
  static Vec3 upper_back() { return at_mm(15.5, 26, 6.5); }
  static Vec3 lower_front() { return at_mm(13, 8, 2.5); }
  static Vec3 lower_back() { return at_mm(15.5, 26, 3); }
};

// side: 1 left, -1 right. From behind to the front.
std::vector<Vec3> pedicle_axis(double side) {
  const auto on_side = [side](const Vec3& p) { return Vec3(side * p.x(), p.y(), p.z()); };
  return {on_side(0.5 * (Pedicle::upper_back() + Pedicle::lower_back())),
          on_side(0.5 * (Pedicle::upper_front() + Pedicle::lower_front()))};
}

std::vector<Landmark> landmarks_of_spine() {
  return {{"left pedicle", pedicle_axis(1), {}},
          {"right pedicle", pedicle_axis(-1), {}},
          {"left entry", {at_mm(17, 34, 5)}, {}},
          {"right entry", {at_mm(-17, 34, 5)}, {}},
          {"canal", {at_mm(0, 24, 14), at_mm(0, 24, -14)}, {}},
          {"front wall", {at_mm(0, -17, 0)}, -Vec3::UnitY()},
          {"upper end plate", {at_mm(0, 0, 14)}, Vec3::UnitZ()},
          {"left upper facet", {at_mm(16.5, 30.5, 15)}, Vec3(-0.75, 0.66, 0.05).normalized()},
          {"left transverse process", {at_mm(16, 28, 4), at_mm(41, 34, 6)}, {}},
          {"spinous process", {at_mm(0, 39, -3), at_mm(0, 66, -13)}, {}}};
}

class Vertebra {
 public:
  // thinner: the pedicle's half width and half height, than usual [mm]
  explicit Vertebra(const Variant& variant) : Vertebra(0.5 * variant.mm("thin-pedicle", 2.4)) {}
  explicit Vertebra(double thinner)
      : pedicle_{
            cone(Pedicle::upper_front(), 4.6 - thinner, Pedicle::upper_back(), 4.8 - thinner),
            cone(Pedicle::lower_front(), 4.6 - thinner, Pedicle::lower_back(), 4.8 - thinner)} {}

  struct Parts {
    double hull = 0, marrow = 0, sac = 0, roots = 0;
  };

  [[nodiscard]] Parts parts(const Vec3& p) const {
    const double mm = kMm;
    Parts s;
    // left and right are equal, except for the noise
    const Vec3 q(std::abs(p.x()), p.y(), p.z());
    // body: an oval drum with a waist, slightly raised rims, slightly hollow end plates
    const double waist = 1 - 0.10 * (1 - std::pow(std::min(std::abs(q.z()) / (14 * mm), 1.0), 2));
    const double round =
        ellipsoid(Vec3(q.x(), q.y(), 0), Vec3::Zero(), at_mm(23 * waist, 17 * waist, 23));
    const double middle =
        std::clamp(1 - (q.x() * q.x() + q.y() * q.y()) / (15e-3 * 15e-3), 0.0, 1.0);
    double hull = carve_soft(round, 14 * mm - 1.3 * mm * middle - std::abs(q.z()), 3 * mm);

    // arch: pedicles, laminae, spine, transverse and joint processes
    static const RoundCone laminae[] = {cone(at_mm(15, 28.5, 3), 4.2, at_mm(3, 39.5, -5), 3.6),
                                        cone(at_mm(13, 31, -5), 3.4, at_mm(2, 40.5, -9), 3.4)};
    static const RoundCone upper_edge = cone(at_mm(0, 39, -3), 3.4, at_mm(0, 64, -5), 2.8),
                           lower_edge = cone(at_mm(0, 39, -11), 3.2, at_mm(0, 66, -13), 3.8),
                           end = cone(at_mm(0, 52, -3), 2.4, at_mm(0, 54, -12), 2.4),
                           transverse = cone(at_mm(16, 28, 4), 4.6, at_mm(41, 34, 6), 3.0);
    static const RoundCone joints[] = {cone(at_mm(16.5, 29.5, 6), 5.0, at_mm(17.5, 30.5, 18), 4.6),
                                       cone(at_mm(12.5, 36, -6), 4.8, at_mm(12.5, 36.5, -19), 4.8)};
    hull = blend(hull, std::max(pedicle_[0].depth(q), pedicle_[1].depth(q)), 4 * mm);
    for (const RoundCone& lamina : laminae) hull = blend(hull, lamina, q, 4 * mm);
    hull = blend(hull, std::max(upper_edge.depth(q), lower_edge.depth(q)), 3.5 * mm);
    hull = blend(hull, end, q, 4 * mm);
    hull = blend(hull, transverse, q, 4 * mm);
    for (const RoundCone& joint : joints) hull = blend(hull, joint, q, 3 * mm);
    // facets: flat; the upper ones face inwards and back, the lower ones outwards and forwards
    const Vec3 upper = Vec3(-0.75, 0.66, 0.05).normalized(),
               lower = Vec3(0.8, -0.6, 0).normalized();
    if (q.z() > 8 * mm && q.y() > 20 * mm)
      hull = carve_soft(hull, 2.4 * mm - (q - at_mm(16.5, 30.5, 15)).dot(upper), 1.5 * mm);
    if (q.z() < -10 * mm && q.y() > 28 * mm)
      hull = carve_soft(hull, 2.8 * mm - (q - at_mm(12.5, 36.5, -16)).dot(lower), 1.5 * mm);

    // canal: a rounded triangle
    double canal = ellipsoid(Vec3(q.x(), q.y(), 0), at_mm(0, 23.5, 0), at_mm(11.6, 7.4, 12));
    canal = blend(canal, 6.5 * mm - std::hypot(q.x(), q.y() - 27 * mm), 3 * mm);
    hull = carve_soft(hull, -canal, 1.5 * mm);
    s.hull = hull + 0.3 * mm * noise(p, 9 * mm, 31) + 0.08 * mm * noise(p, 2.5 * mm, 32);

    s.sac = ellipsoid(Vec3(q.x(), q.y(), 0), at_mm(0, 24, 0), at_mm(8.6, 6.4, 9));
    static const RoundCone near_root = cone(at_mm(7.5, 23, 4), 1.7, at_mm(13, 20, -9), 1.9),
                           far_root = cone(at_mm(13, 20, -9), 1.9, at_mm(24, 15, -21), 2.0);
    s.roots = std::max(near_root.depth(q), far_root.depth(q));

    // spongy inside; the shell is thicker in the arch than around the body
    const double shell =
        (q.y() > 17 * mm ? 2.0 : 1.1 + 0.9 * std::clamp((q.y() - 8 * mm) / (9 * mm), 0.0, 1.0)) *
        mm;
    const double inside = s.hull - shell;
    s.marrow =
        inside > -1.5 * mm ? std::min(inside, foam(p, 3.0 * mm, 0.35, 33) - 0.27 * mm) : inside;
    return s;
  }

 private:
  // radii in mm
  static RoundCone cone(const Vec3& a, double radius_a, const Vec3& b, double radius_b) {
    return {a, b, radius_a * kMm, radius_b * kMm};
  }

  RoundCone pedicle_[2];
};

double solid(const Vertebra::Parts& s) { return std::min(s.hull, -s.marrow); }

}  // namespace

Phantom spine(double voxel, const Variant& variant) {
  Phantom phantom;
  phantom.tissues.tissues = {
      {.name = "air", .kind = TissueKind::air},
      {.name = "cortical bone", .colour = {0.91F, 0.87F, 0.77F}, .cutting_energy = 1.2e9},
      {.name = "trabecular bone",
       .colour = {0.90F, 0.79F, 0.64F},
       .cutting_energy = 0.6e9,
       .bleeds = 0.15},
      {.name = "dural sac",
       .kind = TissueKind::soft,
       .colour = {0.70F, 0.76F, 0.86F},
       .spare = true},
      {.name = "nerve roots",
       .kind = TissueKind::soft,
       .colour = {0.98F, 0.88F, 0.42F},
       .spare = true},
      {.name = "marrow (soft tissue)",
       .kind = TissueKind::soft,
       .colour = {0.50F, 0.26F, 0.16F},
       .bleeds = 0.3},
  };
  for (std::size_t id = 0; id < phantom.tissues.tissues.size(); ++id)
    phantom.tissues.tissues[id].label = static_cast<int>(id);

  const auto model = std::make_shared<const Vertebra>(variant);
  phantom.formula.lipschitz = 2.0;
  phantom.formula.depth = [model](const Vec3& p) { return solid(model->parts(p)); };
  phantom.formula.soft = [model](const Vec3& p) {
    const Vertebra::Parts s = model->parts(p);
    return std::max({s.sac, s.roots, s.marrow});
  };
  phantom.formula.tissue = [model, ramp = volume::kRamp * voxel](const Vec3& p,
                                                                 double depth) -> TissueId {
    const Vertebra::Parts s = model->parts(p);
    if (depth < -1e-4 * ramp) {  // outside, even after rounding
      if (s.sac > 0) return kSac;
      if (s.roots > 0) return kRoots;
      if (s.marrow > 0) return kMarrow;
    }
    if (depth < -ramp) return kAir;
    return s.marrow > -0.9 * kMm && s.hull > 1.0 * kMm ? kTrabecular : kCortex;
  };
  phantom.lo = at_mm(-46, -19, -26);
  phantom.hi = at_mm(46, 72, 26);
  phantom.landmarks = landmarks_of_spine();
  return phantom;
}

}  // namespace burr::phantom
