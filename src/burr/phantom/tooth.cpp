// phantom/tooth.cpp - a lower molar with a carious fissure, by formula. Sizes: Nelson, Wheeler's
// Dental Anatomy (crown 10 x 11 mm, 20 mm long).
#include <algorithm>

#include "burr/phantom/phantoms.h"
#include "burr/phantom/tooth_model.h"

namespace burr::phantom {
namespace {

using volume::TissueId;
using volume::TissueKind;

enum Id : TissueId { kAir, kEnamel, kDentine, kPulp, kCaries };

Vec3 caries_top() { return at_mm(-0.1, 0.6, 6.6); }
Vec3 caries_floor() { return at_mm(0, 0.2, 4.6); }

double caries(const Vec3& p) {
  return RoundCone{caries_top(), caries_floor(), 1.0 * kMm, 1.5 * kMm}.depth(p);
}

}  // namespace

Phantom tooth(double voxel) {
  Phantom phantom;
  phantom.tissues.tissues = {
      {.name = "air", .kind = TissueKind::air},
      {.name = "enamel", .colour = {0.96F, 0.95F, 0.91F}, .cutting_energy = 6.0e9, .friction = 0.2},
      {.name = "dentine", .colour = {0.92F, 0.83F, 0.60F}, .cutting_energy = 1.6e9},
      {.name = "pulp",
       .kind = TissueKind::soft,
       .colour = {0.82F, 0.34F, 0.34F},
       .spare = true,
       .bleeds = 0.3},
      {.name = "caries", .colour = {0.48F, 0.33F, 0.20F}, .cutting_energy = 0.5e9},
  };
  for (std::size_t id = 0; id < phantom.tissues.tissues.size(); ++id)
    phantom.tissues.tissues[id].label = static_cast<int>(id);

  const ToothModel molar;
  phantom.formula.depth = [molar](const Vec3& p) {
    return std::min(molar.depth(p), -molar.pulp(p));
  };
  phantom.formula.soft = [molar](const Vec3& p) { return molar.pulp(p); };
  phantom.formula.tissue = [molar, ramp = volume::kRamp * voxel](const Vec3& p,
                                                                 double depth) -> TissueId {
    if (depth < -1e-4 * ramp && molar.pulp(p) > 0) return kPulp;
    if (depth < -ramp) return kAir;
    if (caries(p) > 0) return kCaries;
    return molar.depth(p) < molar.enamel(p) ? kEnamel : kDentine;
  };
  phantom.lo = at_mm(-6.5, -7, -16);
  phantom.hi = at_mm(6.5, 7, 9.5);
  phantom.landmarks = {{"caries", {caries_top(), caries_floor()}, {}},
                       {"fissure", {at_mm(0, 0.6, 7.5)}, {}},
                       {"pulp chamber", {at_mm(0, 0, 0.9)}, {}},
                       {"roof of the pulp", {at_mm(0, 0, 2.2)}, Vec3::UnitZ()},
                       {"neck", {Vec3::Zero()}, Vec3::UnitZ()},
                       {"long axis", {at_mm(0, 0, 7), at_mm(0, 0, -13)}, {}}};
  return phantom;
}

}  // namespace burr::phantom
