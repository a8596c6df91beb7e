// phantom/temporal_bone.cpp - a right temporal bone, by formula: its tissues, and where each of them is. Its shape is
// temporal_bone_model.h's.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

#include "burr/phantom/phantoms.h"
#include "burr/phantom/temporal_bone_model.h"

namespace burr::phantom {
namespace {

using volume::Tissue;
using volume::TissueId;
using volume::TissueKind;

enum Id : TissueId {
  kAir,
  kCortex,
  kCellWalls,
  kCanalWall,
  kDuraPlate,
  kSinusPlate,
  kLabyrinth,
  kFacialCanal,
  kMalleus,
  kIncus,
  kStapes,
  kFacialNerve,
  kChorda,
  kSinus,
  kDura,
  kSemicircular,
  kCochlea,
  kEardrum,
  kCarotid,
  kMeatusNerves,
  kEarCanal,
  kMiddleEar,
  kAntrum,
  kCells,
};

volume::TissueTable table() {
  using enum TissueKind;
  const double hard = 1.6e9, bone = 1.2e9, light = 0.8e9;  // specific cutting energy [J/m^3]
  volume::TissueTable t;
  t.tissues = {
      {.name = "air", .kind = air},
      {.name = "cortical bone",
       .kind = solid,
       .colour = {0.91F, 0.87F, 0.77F},
       .cutting_energy = bone},
      {.name = "mastoid bone",
       .kind = solid,
       .colour = {0.90F, 0.80F, 0.66F},
       .cutting_energy = light},
      {.name = "bony meatus wall",
       .kind = solid,
       .colour = {0.93F, 0.84F, 0.70F},
       .cutting_energy = bone,
       .spare = true},
      {.name = "bony dura plate (tegmen)",
       .kind = solid,
       .colour = {0.93F, 0.80F, 0.74F},
       .cutting_energy = bone,
       .spare = true},
      {.name = "bony sinus plate",
       .kind = solid,
       .colour = {0.80F, 0.79F, 0.84F},
       .cutting_energy = bone},
      {.name = "labyrinth (otic capsule)",
       .kind = solid,
       .colour = {0.97F, 0.95F, 0.88F},
       .cutting_energy = hard,
       .spare = true},
      {.name = "facial canal bone",
       .kind = solid,
       .colour = {0.94F, 0.86F, 0.62F},
       .cutting_energy = bone},
      {.name = "malleus",
       .kind = solid,
       .colour = {0.96F, 0.91F, 0.80F},
       .cutting_energy = bone,
       .spare = true},
      {.name = "incus",
       .kind = solid,
       .colour = {0.95F, 0.89F, 0.76F},
       .cutting_energy = bone,
       .spare = true},
      {.name = "stapes",
       .kind = solid,
       .colour = {0.97F, 0.93F, 0.84F},
       .cutting_energy = bone,
       .spare = true},
      {.name = "facial nerve", .kind = soft, .colour = {0.98F, 0.88F, 0.42F}, .spare = true},
      {.name = "chorda tympani", .kind = soft, .colour = {0.93F, 0.60F, 0.10F}, .spare = true},
      {.name = "sigmoid sinus",
       .kind = soft,
       .colour = {0.30F, 0.38F, 0.72F},
       .spare = true,
       .bleeds = 1},
      {.name = "dura", .kind = soft, .colour = {0.70F, 0.76F, 0.86F}, .spare = true},
      {.name = "semicircular canals", .kind = soft, .colour = {0.25F, 0.58F, 0.70F}, .spare = true},
      {.name = "cochlea (soft tissue)",
       .kind = soft,
       .colour = {0.33F, 0.56F, 0.42F},
       .spare = true},
      {.name = "eardrum (membrane)", .kind = soft, .colour = {0.84F, 0.66F, 0.68F}, .spare = true},
      {.name = "internal carotid artery",
       .kind = soft,
       .colour = {0.80F, 0.20F, 0.18F},
       .spare = true,
       .bleeds = 1},
      {.name = "internal meatus nerves",
       .kind = soft,
       .colour = {0.62F, 0.56F, 0.24F},
       .spare = true},
      {.name = "ear canal", .kind = air, .colour = {0.75F, 0.60F, 0.52F}},
      {.name = "middle ear", .kind = air, .colour = {0.70F, 0.55F, 0.60F}},
      {.name = "antrum air", .kind = air, .colour = {0.62F, 0.58F, 0.66F}},
      {.name = "mastoid air cells", .kind = air, .colour = {0.66F, 0.66F, 0.70F}},
  };
  for (std::size_t id = 0; id < t.tissues.size(); ++id) t.tissues[id].label = static_cast<int>(id);
  return t;
}

}  // namespace

namespace temporal {
namespace {

// tubes in the bone: the radius of the canal, and of what lies in it
constexpr double kFacialCanalRadius = 1.25 * kMm, kFacialNerveRadius = 0.85 * kMm;
constexpr double kChordaCanalRadius = 0.45 * kMm, kChordaRadius = 0.3 * kMm;
constexpr double kSinusRadius = 4.3 * kMm, kCarotidRadius = 2.7 * kMm, kMeatusRadius = 2.1 * kMm;
constexpr double kCochleaTube = 0.8 * kMm;

}  // namespace

double TemporalBone::bone(const Parts& s) const {
  const double mm = kMm;
  if (s.hull < -kSkin) return s.hull;

  // the whole bone, hollowed by cells, cavities and the ear canal
  double depth = std::min(s.hull, -s.cells);
  depth = carve_soft(depth, -s.antrum, 0.6 * mm);
  depth = carve_soft(depth, -s.middle, 0.6 * mm);

  // walls that remain between the cells and the structures they protect
  const double facial = std::max(kFacialCanalRadius + s.canal_bone - s.facial,
                                 kChordaCanalRadius + 0.5 * mm - s.chorda);
  double shells = std::max(s.capsule, facial);
  shells = std::max(shells, kSinusRadius + 1.0 * mm - s.sinus);
  shells = std::max(shells, kCarotidRadius + 1.0 * mm - s.carotid);
  shells = std::max(shells, std::min(s.canal + 1.5 * mm, -s.middle));
  shells = std::max(shells, std::min(s.tegmen, 0.0) + 1.3 * mm);
  depth = std::max(depth, std::min(shells, s.hull));

  // then the canals themselves
  depth = carve_soft(depth, -s.canal, 0.8 * mm);
  depth = std::min(depth, s.facial - kFacialCanalRadius);
  depth = std::min(depth, s.chorda - kChordaCanalRadius);
  depth = carve_soft(depth, s.sinus - kSinusRadius, 0.6 * mm);
  depth = carve_soft(depth, s.carotid - kCarotidRadius, 0.6 * mm);
  depth = std::min({depth, s.meatus - kMeatusRadius, s.semicircular, s.cochlea - kCochleaTube});

  return std::max({depth, s.malleus, s.incus, s.stapes});
}

// Depth in the nearest labelled structure that is not bone.
double TemporalBone::labelled(const Parts& s) {
  if (s.hull < -kSkin) return s.hull + 5.5 * kMm;
  const double in_bone = s.hull + 1.5 * kMm;  // the labelled part of a tube ends with the bone
  const double tubes = std::max({kFacialNerveRadius - s.facial, kSinusRadius - s.sinus,
                                 kCarotidRadius - s.carotid, kMeatusRadius - s.meatus});
  const double holes =
      std::max({s.canal, s.middle, s.antrum, s.cells, -s.semicircular, kCochleaTube - s.cochlea});
  const double dura = std::min(s.fossa, 1.5 * kMm - s.fossa);
  return std::max({std::min(std::max(tubes, holes), in_bone + 4 * kMm), kChordaRadius - s.chorda,
                   std::min(dura, s.dura - 0.5 * kMm), s.drum});
}

TissueId TemporalBone::tissue(const Vec3& p, double depth) const {
  const Parts& s = remembered(p);
  if (s.hull < -kSkin) return kAir;

  // soft structures fill their canals to the wall; the field is rounded, so start slightly below
  // the surface
  if (depth < -1e-4 * ramp_) {
    const TissueId soft = soft_tissue(s);
    if (soft != kAir) return soft;
  }
  return depth > -ramp_ ? solid_tissue(s, p) : air_tissue(s, p);
}

// Inside the bone and in the ramp above it: which kind of bone.
TissueId TemporalBone::solid_tissue(const Parts& s, const Vec3& p) const {
  const double mm = kMm;
  if (s.malleus > -ramp_ && s.malleus >= s.incus) return kMalleus;
  if (s.incus > -ramp_ && s.incus >= s.stapes) return kIncus;
  if (s.stapes > -ramp_) return kStapes;
  if (s.facial < kFacialCanalRadius + 0.8 * mm) return kFacialCanal;
  if (s.capsule > 0) return kLabyrinth;
  if (s.sinus < kSinusRadius + 1.0 * mm) return kSinusPlate;
  if (s.canal > -1.5 * mm && p.x() > 1 * mm) return kCanalWall;
  if (std::abs(s.tegmen) < 1.4 * mm && s.fossa > -2.4 * mm) return kDuraPlate;
  if ((sclerotic_ ? s.field : s.cells) > -0.9 * mm && s.hull > 1.6 * mm) return kCellWalls;
  return kCortex;
}

TissueId TemporalBone::soft_tissue(const Parts& s) {
  const double mm = kMm;
  if (s.facial < kFacialNerveRadius && s.hull > -4 * mm) return kFacialNerve;
  if (s.chorda < kChordaRadius) return kChorda;
  if (s.drum > 0) return kEardrum;
  const bool dura = s.fossa > 0 && s.fossa < 1.5 * mm && s.dura >= 0;
  if (s.hull < -2 * mm) return dura ? kDura : kAir;
  if (s.semicircular < 0) return kSemicircular;
  if (s.cochlea < kCochleaTube) return kCochlea;
  if (s.sinus < kSinusRadius) return kSinus;
  if (s.carotid < kCarotidRadius) return kCarotid;
  if (s.meatus < kMeatusRadius) return kMeatusNerves;
  return dura ? kDura : kAir;
}

TissueId TemporalBone::air_tissue(const Parts& s, const Vec3& p) {
  if (s.hull < -2 * kMm) return kAir;
  if (s.middle > 0) return kMiddleEar;
  if (s.antrum > 0) return kAntrum;
  if (s.canal > 0 && p.x() > -1 * kMm) return kEarCanal;
  return s.cells > 0 ? kCells : kAir;
}

}  // namespace temporal

Phantom temporal_bone(double voxel, const Variant& variant) {
  const auto model = std::make_shared<const temporal::TemporalBone>(voxel, variant);
  Phantom phantom;
  phantom.tissues = table();
  phantom.formula.depth = [model](const Vec3& p) { return model->depth(p); };
  phantom.formula.soft = [model](const Vec3& p) { return model->soft(p); };
  phantom.formula.tissue = [model](const Vec3& p, double depth) { return model->tissue(p, depth); };
  phantom.formula.lipschitz = 2.0;
  phantom.lo = temporal::TemporalBone::lo();
  phantom.hi = temporal::TemporalBone::hi();
  phantom.landmarks = model->landmarks();
  return phantom;
}

}  // namespace burr::phantom
