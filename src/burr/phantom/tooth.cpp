// phantom/tooth.cpp - a lower molar with a carious fissure, by formula. Sizes: Nelson, Wheeler's
// Dental Anatomy (crown 10 x 11 mm, 20 mm long).
#include <algorithm>
#include <vector>

#include "burr/phantom/phantoms.h"
#include "burr/phantom/tooth_model.h"

namespace burr::phantom {
namespace {

using volume::TissueId;
using volume::TissueKind;

enum Id : TissueId { kAir, kEnamel, kDentine, kPulp, kCaries, kLeathery, kFirm };

// What caries has taken, as one cone from its top to its floor.
struct Lesion {
  Vec3 top, floor;
  double top_radius, floor_radius;  // [m]
  double shell = 0;                 // thickness of the leathery and of the firm grade [m]
  [[nodiscard]] double depth(const Vec3& p) const {
    return RoundCone{top, floor, top_radius, floor_radius}.depth(p);
  }
};

// The lesions of a variant; the first is the one of the fissure.
std::vector<Lesion> lesions_of(const Variant& variant) {
  const double lower = variant.mm("deep", 0.4) - variant.mm("shallow", 0.8);
  if (!variant.has("graded"))
    return {{at_mm(-0.1, 0.6, 6.6), at_mm(0, 0.2, 4.6 - lower), 1.0 * kMm, 1.5 * kMm}};
  // farther back than the plain one, so that sound tooth stands between it and the pit in front
  return {{at_mm(0, 1.0, 6.6), at_mm(0, 1.0, 4.5 - lower), 1.1 * kMm, 1.6 * kMm, 0.35 * kMm},
          {at_mm(-0.1, -2.7, 6.6), at_mm(-0.1, -2.7, 5.3), 0.7 * kMm, 0.8 * kMm, 0.25 * kMm}};
}

// The grade of caries at p; kAir: none.
TissueId caries_at(const std::vector<Lesion>& lesions, const Vec3& p) {
  for (const Lesion& lesion : lesions) {
    const double depth = lesion.depth(p);
    if (depth <= 0) continue;
    if (lesion.shell <= 0 || depth > 2 * lesion.shell) return kCaries;
    return depth > lesion.shell ? kLeathery : kFirm;
  }
  return kAir;
}

std::vector<Landmark> landmarks_of(const std::vector<Lesion>& lesions) {
  std::vector<Landmark> all = {{"caries", {lesions[0].top, lesions[0].floor}, {}},
                               {"fissure", {at_mm(0, 0.6, 7.5)}, {}},
                               {"pulp chamber", {at_mm(0, 0, 0.9)}, {}},
                               {"roof of the pulp", {at_mm(0, 0, 2.2)}, Vec3::UnitZ()},
                               {"neck", {Vec3::Zero()}, Vec3::UnitZ()},
                               {"long axis", {at_mm(0, 0, 7), at_mm(0, 0, -13)}, {}}};
  if (lesions.size() > 1) all.push_back({"front pit", {lesions[1].top, lesions[1].floor}, {}});
  return all;
}

// Cutting energies of the grades are defaults: soft caries is spooned out by hand, firm caries
// resists a hand instrument almost like sound dentine (the grades of Innes et al. 2016, which give
// words and no energy).
volume::TissueTable tissues_of(bool graded) {
  volume::TissueTable table;
  table.tissues = {
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
  if (graded) {
    table.tissues[kCaries] = {
        .name = "soft caries", .colour = {0.36F, 0.23F, 0.13F}, .cutting_energy = 0.15e9};
    table.tissues.push_back(
        {.name = "leathery caries", .colour = {0.55F, 0.37F, 0.20F}, .cutting_energy = 0.5e9});
    table.tissues.push_back(
        {.name = "firm caries", .colour = {0.75F, 0.59F, 0.36F}, .cutting_energy = 1.0e9});
  }
  for (std::size_t id = 0; id < table.tissues.size(); ++id)
    table.tissues[id].label = static_cast<int>(id);
  return table;
}

}  // namespace

Phantom tooth(double voxel, const Variant& variant) {
  Phantom phantom;
  phantom.tissues = tissues_of(variant.has("graded"));
  const std::vector<Lesion> lesions = lesions_of(variant);
  const ToothModel molar;
  phantom.formula.depth = [molar](const Vec3& p) {
    return std::min(molar.depth(p), -molar.pulp(p));
  };
  phantom.formula.soft = [molar](const Vec3& p) { return molar.pulp(p); };
  phantom.formula.tissue = [molar, lesions, ramp = volume::kRamp * voxel](
                               const Vec3& p, double depth) -> TissueId {
    if (depth < -1e-4 * ramp && molar.pulp(p) > 0) return kPulp;
    if (depth < -ramp) return kAir;
    if (const TissueId grade = caries_at(lesions, p); grade != kAir) return grade;
    return molar.depth(p) < molar.enamel(p) ? kEnamel : kDentine;
  };
  phantom.lo = at_mm(-6.5, -7, -16);
  phantom.hi = at_mm(6.5, 7, 9.5);
  phantom.landmarks = landmarks_of(lesions);
  return phantom;
}

}  // namespace burr::phantom
