// phantom/jaw.cpp - a piece of the left lower jaw with a gap for an implant, by formula.
//
// Frame: LPS around the ridge at the gap: x outwards (to the cheek), y backwards, z up. Cortex 2.2
// mm, nerve canal 16 mm under the ridge: middle values of cone-beam studies.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "burr/phantom/phantoms.h"
#include "burr/phantom/tooth_model.h"

namespace burr::phantom {
namespace {

using volume::TissueId;
using volume::TissueKind;

enum Id : TissueId {
  kAir,
  kCortex,
  kTrabecular,
  kEnamel,
  kDentine,
  kPulp,
  kNerve,
  kCanalWall,
  kMarrow
};

constexpr double kCanalRadius = 1.5 * kMm, kNerveRadius = 1.1 * kMm, kWall = 0.7 * kMm;

class Jaw {
 public:
  struct Parts {
    double hull = 0, marrow = 0, tooth = 0, enamel = 0, pulp = 0, nerve = 0;
  };

  [[nodiscard]] Parts parts(const Vec3& p) const {
    Parts s;
    const double mm = kMm;
    const double half_width =
        (5.4 + 0.9 * std::sin(0.11 * (p.z() / mm + 4)) - 0.05 * p.y() / mm) * mm;
    const double across = std::abs(row_.distance(Vec3(p.x(), p.y(), 0)));
    // upright rounded section, the ridge rounder than the base
    const double ox = across - (half_width - 4.4 * mm),
                 oz = std::abs(p.z() + 14 * mm) - (14 - 4.4) * mm;
    s.hull = 4.4 * mm - std::hypot(std::max(ox, 0.0), std::max(oz, 0.0)) -
             std::min(std::max(ox, oz), 0.0);
    s.hull += 0.25 * mm * noise(p, 6 * mm, 21) - 1.2 * mm * gap(p);
    s.hull = std::min(s.hull, 22 * mm - std::abs(p.y()));

    s.tooth = s.pulp = -1;
    for (const Tooth& tooth : teeth_) {
      const Vec3 q = tooth.place.inverse() * p;
      if (q.norm() > 26 * mm) {
        s.tooth = std::max(s.tooth, 18 * mm - q.norm());
        continue;
      }
      const double depth = tooth.model.depth(q);
      if (depth <= s.tooth) continue;
      s.tooth = depth;
      s.enamel = tooth.model.enamel(q);
      s.pulp = tooth.model.pulp(q);
    }
    s.nerve = nerve_.distance(p);

    // spongy inside: plates and struts around marrow
    const double inside = s.hull - (2.2 + 0.5 * noise(p, 8 * mm, 22)) * mm;
    const double keep = std::min({inside, s.nerve - kCanalRadius - kWall, -s.tooth - 0.5 * mm});
    s.marrow = keep > -1.5 * mm ? std::min(keep, foam(p, 2.3 * mm, 0.35, 23) - 0.22 * mm) : keep;
    return s;
  }

  [[nodiscard]] static double depth(const Parts& s) {
    const double bone = std::min({s.hull, -s.marrow, s.nerve - kCanalRadius});
    return std::max(bone, std::min(s.tooth, s.tooth > -3 * kMm ? -s.pulp : s.tooth));
  }
  [[nodiscard]] static double soft(const Parts& s) {
    return std::max({kNerveRadius - s.nerve, s.marrow, s.tooth > 0 ? s.pulp : s.tooth});
  }

  [[nodiscard]] std::vector<Landmark> landmarks() const {
    const std::vector<Vec3> nerve = nerve_.points();
    // the ridge in the gap lies 1.2 mm lower than beside it
    const Vec3 gap = at_mm(0, 0, -1.2);
    const auto axis = [](const Tooth& tooth) {
      return std::vector<Vec3>{tooth.place * at_mm(0, 0, 7), tooth.place * at_mm(0, 0, -13)};
    };
    return {{"gap", {gap}, {}},
            {"implant axis", {gap, gap - at_mm(0, 0, 10)}, {}},
            {"inferior alveolar nerve", nerve, {}},
            {"mental foramen", {nerve.back()}, {}},
            {"lower border", {at_mm(0, 0, -28)}, -Vec3::UnitZ()},
            {"lingual side", {at_mm(-5.4, 0, -14)}, -Vec3::UnitX()},
            {"cheek side", {at_mm(5.4, 0, -14)}, Vec3::UnitX()},
            {"first premolar", axis(teeth_[0]), {}},
            {"second premolar", axis(teeth_[1]), {}},
            {"second molar", axis(teeth_[2]), {}}};
  }

 private:
  struct Tooth {
    math::Pose place;
    ToothModel model;
  };
  // the ridge is lower where a tooth was lost
  [[nodiscard]] static double gap(const Vec3& p) {
    const double y = p.y() / (5.5 * kMm), z = p.z() / (7 * kMm);
    return std::exp(-y * y - z * z);
  }
  static Tooth placed(double x, double y, bool molar, double turn) {
    Tooth tooth;
    tooth.place.p = at_mm(x, y, 1.2);
    tooth.place.q = math::Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
    tooth.model.molar = molar;
    return tooth;
  }

  Curve row_{
      {at_mm(-7, -40, 0), at_mm(-4.6, -20, 0), at_mm(0, 0, 0), at_mm(4.4, 20, 0), at_mm(9, 40, 0)},
      60 * kMm};
  Curve nerve_{{at_mm(9, 40, -14), at_mm(4.6, 22, -16), at_mm(1, 4, -17), at_mm(-2.6, -10, -15.5),
                at_mm(-2.0, -17, -12.5), at_mm(3.5, -21, -11)},
               5 * kMm};
  std::array<Tooth, 3> teeth_ = {placed(-4.2, -17.2, false, -0.1), placed(-2.3, -9.6, false, -0.1),
                                 placed(2.6, 11.6, true, -0.2)};
};

}  // namespace

Phantom jaw(double voxel) {
  Phantom phantom;
  phantom.tissues.tissues = {
      {.name = "air", .kind = TissueKind::air},
      {.name = "cortical bone", .colour = {0.91F, 0.87F, 0.77F}, .cutting_energy = 1.3e9},
      {.name = "trabecular bone",
       .colour = {0.90F, 0.79F, 0.64F},
       .cutting_energy = 0.7e9,
       .bleeds = 0.15},
      {.name = "enamel",
       .colour = {0.96F, 0.95F, 0.91F},
       .cutting_energy = 6.0e9,
       .friction = 0.2,
       .spare = true},
      {.name = "dentine", .colour = {0.92F, 0.83F, 0.60F}, .cutting_energy = 1.6e9, .spare = true},
      {.name = "pulp",
       .kind = TissueKind::soft,
       .colour = {0.82F, 0.34F, 0.34F},
       .spare = true,
       .bleeds = 0.3},
      {.name = "inferior alveolar nerve",
       .kind = TissueKind::soft,
       .colour = {0.98F, 0.85F, 0.25F},
       .spare = true},
      {.name = "nerve canal bone",
       .colour = {0.94F, 0.84F, 0.60F},
       .cutting_energy = 1.2e9,
       .spare = true},
      {.name = "marrow (soft tissue)",
       .kind = TissueKind::soft,
       .colour = {0.76F, 0.46F, 0.38F},
       .bleeds = 0.3},
  };
  for (std::size_t id = 0; id < phantom.tissues.tissues.size(); ++id)
    phantom.tissues.tissues[id].label = static_cast<int>(id);

  const auto model = std::make_shared<const Jaw>();
  phantom.formula.lipschitz = 1.4;
  phantom.formula.depth = [model](const Vec3& p) { return Jaw::depth(model->parts(p)); };
  phantom.formula.soft = [model](const Vec3& p) { return Jaw::soft(model->parts(p)); };
  phantom.formula.tissue = [model, ramp = volume::kRamp * voxel](const Vec3& p,
                                                                 double depth) -> TissueId {
    const Jaw::Parts s = model->parts(p);
    if (depth < -1e-4 * ramp) {  // outside, even after rounding
      if (s.nerve < kNerveRadius) return kNerve;
      if (s.tooth > 0 && s.pulp > 0) return kPulp;
      if (s.marrow > 0) return kMarrow;
    }
    if (depth < -ramp) return kAir;
    if (s.tooth > std::min(0.0, s.hull)) return s.tooth < s.enamel ? kEnamel : kDentine;
    if (s.nerve < kCanalRadius + kWall) return kCanalWall;
    return s.marrow > -0.9 * kMm && s.hull > 1.6 * kMm ? kTrabecular : kCortex;
  };
  phantom.lo = at_mm(-14, -23, -29.5);
  phantom.hi = at_mm(14, 23, 10.5);
  phantom.landmarks = model->landmarks();
  return phantom;
}

}  // namespace burr::phantom
