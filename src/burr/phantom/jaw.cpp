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
  kMarrow,
  kSheath,
  kMouthFloor
};

constexpr double kNoPulp = -3 * kMm;  // so far outside of a tooth its pulp does not matter
constexpr double kCanalRadius = 1.5 * kMm, kNerveRadius = 1.1 * kMm, kWall = 0.7 * kMm;

// Of the long jaw. The osteotomy in front of the mental foramen is a slab of kKerf that leans 8
// degrees, its top towards the nerve.
constexpr double kFront = -39 * kMm, kBack = 22 * kMm;       // ends of the piece, along y
constexpr double kMouthNear = 1 * kMm, kMouthFar = 4 * kMm;  // its floor, from the bone
constexpr double kKerf = 3 * kMm;
constexpr double kLean = 8 * M_PI / 180;
constexpr double kRaised = 2.5;  // of a high nerve [mm]

// The defect is a part of a ball about a point outside the bone: 8 mm wide and 2.5 mm deep.
constexpr double kDefectRadius = 4.45 * kMm, kDefectDepth = 2.5 * kMm;
const Vec3 kDefectFace = at_mm(5.3, 4, -20.5);                // where the bone's face was
const Vec3 kDefectOut = Vec3(0.986, -0.167, 0).normalized();  // across that face
const Vec3 kDefectMiddle = kDefectFace + (kDefectRadius - kDefectDepth) * kDefectOut;

class Jaw {
 public:
  explicit Jaw(const Variant& variant)
      : long_(variant.has("long")),
        defect_(variant.has("defect")),
        nerve_(nerve_curve(variant.mm("high-nerve", kRaised) * kMm), 5 * kMm) {}

  struct Parts {
    double hull = 0, marrow = 0, tooth = 0, enamel = 0, pulp = 0, nerve = 0;
    double mouth = -1;  // depth in the soft floor of the mouth
  };

  [[nodiscard]] Parts parts(const Vec3& p) const {
    Parts s;
    const double mm = kMm;
    const double half_width =
        (5.4 + 0.9 * std::sin(0.11 * (p.z() / mm + 4)) - 0.05 * p.y() / mm) * mm;
    const double narrower =
        long_ ? 2.4 * mm * std::clamp((-22 * mm - p.y()) / (6 * mm), 0.0, 1.0) : 0;
    const double across = narrower + std::abs(row_.distance(Vec3(p.x(), p.y(), 0)));
    // upright rounded section, the ridge rounder than the base
    const double ox = across - (half_width - 4.4 * mm),
                 oz = std::abs(p.z() + 14 * mm) - (14 - 4.4) * mm;
    s.hull = 4.4 * mm - std::hypot(std::max(ox, 0.0), std::max(oz, 0.0)) -
             std::min(std::max(ox, oz), 0.0);
    s.hull += 0.25 * mm * noise(p, 6 * mm, 21) - 1.2 * mm * gap(p);
    if (long_) {
      // in front no tooth is left, and the ridge has sunk by half its height
      const double below = -16 * mm - p.z();
      const double behind =
          (16 * (p.y() + 27 * mm) - 5 * (p.z() + 16 * mm)) / std::hypot(16.0, 5.0);
      s.hull = carve_soft(s.hull, blend(below, behind, 3 * mm), 3 * mm);
      s.hull = std::min({s.hull, kBack - p.y(), p.y() - kFront});
    } else {
      s.hull = std::min(s.hull, 22 * mm - std::abs(p.y()));
    }
    if (defect_) s.hull = std::min(s.hull, (p - kDefectMiddle).norm() - kDefectRadius);

    s.tooth = s.pulp = -1;
    for (const Tooth& tooth : teeth_) {
      const Vec3 q = tooth.into * p;
      if (q.norm() > 26 * mm) {
        s.tooth = std::max(s.tooth, 18 * mm - q.norm());
        continue;
      }
      const double depth = tooth.model.depth(q);
      if (depth <= s.tooth) continue;
      s.tooth = depth;
      if (depth <= kNoPulp) continue;
      s.enamel = tooth.model.enamel(q);
      s.pulp = tooth.model.pulp(q);
    }
    s.nerve = nerve_.distance(p);

    // spongy inside: plates and struts around marrow
    const double inside = s.hull - (2.2 + 0.5 * noise(p, 8 * mm, 22)) * mm;
    const double keep = std::min({inside, s.nerve - kCanalRadius - kWall, -s.tooth - 0.5 * mm});
    if (long_)
      s.mouth = std::min({-kMouthNear - s.hull, s.hull + kMouthFar, -24 * mm - p.y(),
                          p.y() - kFront, inner_side(p), -17.5 * mm - p.z(), p.z() + 27 * mm});
    s.marrow = keep > -1.5 * mm ? std::min(keep, foam(p, 2.3 * mm, 0.35, 23) - 0.22 * mm) : keep;
    return s;
  }

  [[nodiscard]] static double depth(const Parts& s) {
    const double bone = std::min({s.hull, -s.marrow, s.nerve - kCanalRadius});
    return std::max(bone, std::min(s.tooth, s.tooth > kNoPulp ? -s.pulp : s.tooth));
  }
  [[nodiscard]] static double soft(const Parts& s) {
    return std::max({kNerveRadius - s.nerve, s.marrow, s.tooth > 0 ? s.pulp : s.tooth});
  }
  [[nodiscard]] static double soft_of_long(const Parts& s) {
    return std::max({soft(s), kCanalRadius - s.nerve, s.mouth});
  }
  [[nodiscard]] bool is_long() const { return long_; }

  [[nodiscard]] std::vector<Landmark> landmarks() const {
    const std::vector<Vec3> nerve = nerve_.points();
    // the ridge in the gap lies 1.2 mm lower than beside it
    const Vec3 gap = at_mm(0, 0, -1.2);
    const auto axis = [](const Tooth& tooth) {
      return std::vector<Vec3>{tooth.place * at_mm(0, 0, 7), tooth.place * at_mm(0, 0, -13)};
    };
    std::vector<Landmark> all = {{"gap", {gap}, {}},
                                 {"implant axis", {gap, gap - at_mm(0, 0, 10)}, {}},
                                 {"inferior alveolar nerve", nerve, {}},
                                 {"mental foramen", {nerve.back()}, {}},
                                 {"lower border", {at_mm(0, 0, -28)}, -Vec3::UnitZ()},
                                 {"lingual side", {at_mm(-5.4, 0, -14)}, -Vec3::UnitX()},
                                 {"cheek side", {at_mm(5.4, 0, -14)}, Vec3::UnitX()},
                                 {"first premolar", axis(teeth_[0]), {}},
                                 {"second premolar", axis(teeth_[1]), {}},
                                 {"second molar", axis(teeth_[2]), {}}};
    if (defect_) {
      all.push_back({"middle of the defect", {kDefectMiddle}, {}});
      all.push_back({"face over the defect", {kDefectFace}, kDefectOut});
      all.push_back({"floor of the defect", {kDefectFace - kDefectDepth * kDefectOut}, {}});
    }
    if (long_) {
      // forwards, across the slab; and its middle
      const Vec3 across = Vec3(0, -std::cos(kLean), std::sin(kLean));
      const Vec3 middle = at_mm(-5.7, -29.45, -18);
      all.push_back({"osteotomy", {middle}, across});
      // down the middle of the slab, half-way through the bone
      const Vec3 down = Vec3(0, -std::sin(kLean), -std::cos(kLean));
      const Vec3 half_way = middle + 2 * kMm * Vec3::UnitX();
      all.push_back(
          {"line of the osteotomy", {half_way - 5 * kMm * down, half_way + 11 * kMm * down}, {}});
      all.push_back({"back face of the osteotomy", {middle - 0.5 * kKerf * across}, across});
      all.push_back({"front face of the osteotomy", {middle + 0.5 * kKerf * across}, -across});
    }
    return all;
  }

 private:
  struct Tooth {
    math::Pose place, into;  // of the tooth; from the jaw into the tooth
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
    tooth.into = tooth.place.inverse();
    tooth.model.molar = molar;
    return tooth;
  }

  // Depth on the tongue's side of the row of teeth
  [[nodiscard]] static double inner_side(const Vec3& p) {
    return (-5.2 * kMm - 0.12 * (-p.y() - 24 * kMm)) - p.x();
  }
  static std::vector<Vec3> nerve_curve(double raised) {
    std::vector<Vec3> points = {at_mm(9, 40, -14),       at_mm(4.6, 22, -16),
                                at_mm(1, 4, -17),        at_mm(-2.6, -10, -15.5),
                                at_mm(-2.0, -17, -12.5), at_mm(3.5, -21, -11)};
    for (Vec3& point : points) point.z() += raised;
    return points;
  }

  bool long_, defect_;
  Curve row_{
      {at_mm(-7, -40, 0), at_mm(-4.6, -20, 0), at_mm(0, 0, 0), at_mm(4.4, 20, 0), at_mm(9, 40, 0)},
      60 * kMm};
  Curve nerve_;
  std::array<Tooth, 3> teeth_ = {placed(-4.2, -17.2, false, -0.1), placed(-2.3, -9.6, false, -0.1),
                                 placed(2.6, 11.6, true, -0.2)};
};

}  // namespace

Phantom jaw(double voxel, const Variant& variant) {
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
       .colour = {0.98F, 0.88F, 0.42F},
       .spare = true},
      {.name = "nerve canal bone",
       .colour = {0.94F, 0.84F, 0.60F},
       .cutting_energy = 1.2e9,
       .spare = true},
      {.name = "marrow (soft tissue)",
       .kind = TissueKind::soft,
       .colour = {0.50F, 0.26F, 0.16F},
       .bleeds = 0.3},
  };
  const auto model = std::make_shared<const Jaw>(variant);
  if (model->is_long()) {
    phantom.tissues.tissues.push_back({.name = "nerve sheath",
                                       .kind = TissueKind::soft,
                                       .colour = {0.95F, 0.90F, 0.62F},
                                       .spare = true});
    phantom.tissues.tissues.push_back({.name = "floor of the mouth (soft tissue)",
                                       .kind = TissueKind::soft,
                                       .colour = {0.80F, 0.45F, 0.44F},
                                       .spare = true,
                                       .bleeds = 0.3});
  }
  for (std::size_t id = 0; id < phantom.tissues.tissues.size(); ++id)
    phantom.tissues.tissues[id].label = static_cast<int>(id);

  phantom.formula.lipschitz = 1.4;
  phantom.formula.depth = [model](const Vec3& p) { return Jaw::depth(model->parts(p)); };
  phantom.formula.soft = [model](const Vec3& p) {
    return model->is_long() ? Jaw::soft_of_long(model->parts(p)) : Jaw::soft(model->parts(p));
  };
  phantom.formula.tissue = [model, ramp = volume::kRamp * voxel](const Vec3& p,
                                                                 double depth) -> TissueId {
    const Jaw::Parts s = model->parts(p);
    if (depth < -1e-4 * ramp) {  // outside, even after rounding
      if (s.nerve < kNerveRadius) return kNerve;
      if (s.tooth > 0 && s.pulp > 0) return kPulp;
      if (s.marrow > 0) return kMarrow;
      if (model->is_long() && s.nerve < kCanalRadius) return kSheath;
      if (s.mouth > 0) return kMouthFloor;
    }
    if (depth < -ramp) return kAir;
    if (s.tooth > std::min(0.0, s.hull)) return s.tooth < s.enamel ? kEnamel : kDentine;
    if (s.nerve < kCanalRadius + kWall) return kCanalWall;
    return s.marrow > -0.9 * kMm && s.hull > 1.6 * kMm ? kTrabecular : kCortex;
  };
  phantom.lo = model->is_long() ? at_mm(-18.5, -40, -29.5) : at_mm(-14, -23, -29.5);
  phantom.hi = at_mm(14, 23, 10.5);
  phantom.landmarks = model->landmarks();
  return phantom;
}

}  // namespace burr::phantom
