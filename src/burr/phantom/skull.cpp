// phantom/skull.cpp - a skull without lower jaw, by formula: vault of two tables with spongy bone
// between them, eye sockets, nose, cheekbones, upper teeth, base.
//
// Frame: LPS around the middle of the vault's widest level: x left, y backwards, z up. Modelled by
// eye to the size of a small adult (150 x 185 x 145 mm).
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "burr/phantom/phantoms.h"
#include "burr/phantom/sculpt.h"

namespace burr::phantom {
namespace {

using volume::TissueId;
using volume::TissueKind;

enum Id : TissueId { kAir, kTables, kDiploe, kTeeth, kFace };

RoundCone cone(const Vec3& a, double radius_a, const Vec3& b, double radius_b) {
  return {a, b, radius_a * kMm, radius_b * kMm};
}

// One piece of the shape, and how softly it joins.
struct Part {
  RoundCone cone;
  double width;
};

struct Tooth {
  RoundCone crown, socket;
};

// On an arch, from the middle to the left.
std::array<Tooth, 7> row_of_teeth() {
  const auto tooth = [](int n) -> Tooth {
    const double turn = 0.13 + 0.205 * n;
    const double x = 27 * std::sin(turn), y = -42 - 44 * std::cos(turn);
    const double wide = n < 3 ? 3.3 : n < 5 ? 3.6 : 4.7;
    return {cone(at_mm(x, y, -66), wide, at_mm(x, y, -73.5), n < 3 ? 2.0 : wide - 0.6),
            cone(at_mm(x, y, -52), 6.5, at_mm(x, y, -64), 5.2)};
  };
  return {tooth(0), tooth(1), tooth(2), tooth(3), tooth(4), tooth(5), tooth(6)};
}

struct Skull {
  double depth = 0, hull = 0, diploe = 0, teeth = 0, vault = 0;

  explicit Skull(const Vec3& p) {
    const double mm = kMm;
    const Vec3 q(std::abs(p.x()), p.y(), p.z());
    // brain case: an egg shape, broader behind, and the space inside it
    const double broad = 1 + 0.10 * std::clamp(p.y() / (90 * mm), -1.0, 1.0);
    const Vec3 egg(q.x() / broad, q.y(), q.z());
    const Vec3 middle = at_mm(0, 4, 12);
    vault = 0.93 * ellipsoid(egg, middle, at_mm(68, 88, 66));
    double room = 0.93 * ellipsoid(egg, middle + at_mm(0, 1, 0.5), at_mm(61.5, 80.5, 59.5));
    // its floor rises in three steps from back to front
    const double front = std::clamp((-p.y() - 5 * mm) / (30 * mm), 0.0, 1.0);
    const double floor = p.z() + (34 - 20 * front) * mm - 4 * mm * noise(p, 30 * mm, 41);
    room = carve_soft(room, floor, 8 * mm);

    // base and face
    hull = vault;
    hull = carve_soft(hull, p.z() + 48 * mm, 6 * mm);
    static const Part face[] = {
        {cone(at_mm(57, 22, -24), 13, at_mm(52, 14, -50), 6.5), 8 * mm},    // mastoids
        {cone(at_mm(10, 42, -42), 7, at_mm(12, 26, -49), 5), 6 * mm},       // condyles
        {cone(at_mm(0, -58, -30), 27, at_mm(0, -66, -50), 20), 14 * mm},    // maxilla
        {cone(at_mm(14, -86, 3), 9, at_mm(46, -70, 2), 6), 9 * mm},         // brow
        {cone(at_mm(52, -66, -2), 5, at_mm(48, -64, -24), 8), 7 * mm},      // outer rim
        {cone(at_mm(48, -66, -26), 9, at_mm(22, -76, -34), 8), 8 * mm},     // cheek
        {cone(at_mm(0, -88, -2), 4.5, at_mm(0, -97, -13), 2.6), 6 * mm},    // nose bridge
        {cone(at_mm(16, -30, -44), 4, at_mm(18, -34, -62), 2.5), 5 * mm}};  // pterygoids
    for (const Part& part : face) hull = blend(hull, part.cone, q, part.width);
    // the row of teeth, on an arch
    static const std::array<Tooth, 7> arch = row_of_teeth();
    double row = -1;
    for (const Tooth& tooth : arch) {
      row = std::max(row, tooth.crown.depth(q));
      hull = blend(hull, tooth.socket, q, 5 * mm);
    }
    teeth = row;
    // palate, eye sockets, nose, and openings
    static const Part openings[] = {
        {cone(at_mm(0, -74, -68), 13, at_mm(0, -44, -66), 17), 4 * mm},
        {cone(at_mm(33, -98, -12), 18.5, at_mm(17, -58, -13), 3), 4 * mm},
        {cone(at_mm(4.5, -104, -36), 8.5, at_mm(4.5, -40, -36), 8), 4 * mm},
        {cone(at_mm(3.0, -104, -24), 5, at_mm(3.0, -55, -20), 3.5), 3 * mm},
        {cone(at_mm(68, -30, -20), 13, at_mm(57, -44, -44), 10), 5 * mm}};  // temple
    static const Part cheek_bone[] = {
        {cone(at_mm(51, -60, -25), 5.5, at_mm(68, -26, -25), 3.2), 4 * mm},
        {cone(at_mm(68, -26, -25), 3.2, at_mm(66, 2, -22), 4.2), 4 * mm}};
    static const Part below[] = {
        {cone(at_mm(0, 36, -62), 15.5, at_mm(0, 36, -28), 15.5), 4 * mm},  // foramen magnum
        {cone(at_mm(80, 7, -26), 4, at_mm(42, 4, -25), 3), 2 * mm}};       // ear canals
    for (const Part& part : openings) hull = carve_soft(hull, part.cone, q, part.width);
    for (const Part& part : cheek_bone) hull = blend(hull, part.cone, q, part.width);
    for (const Part& part : below) hull = carve_soft(hull, part.cone, q, part.width);
    hull = carve_soft(hull, -room, 3 * mm);
    const double septum = std::min(
        {1.2 * mm - q.x(), -44 * mm - p.y(), p.y() + 88 * mm, p.z() + 56 * mm, -12 * mm - p.z()});
    hull = std::max(hull, septum);
    hull += 0.5 * mm * noise(p, 18 * mm, 42) + 0.15 * mm * noise(p, 4 * mm, 43);

    // spongy bone between the tables
    const double inside = std::min(hull - 1.9 * mm, std::min(vault, 9 * mm - vault) + 1 * mm);
    diploe = inside > -2 * mm ? std::min(inside, foam(p, 6.5 * mm, 0.3, 44) - 0.6 * mm) : inside;
    depth = std::max(std::min(hull, -diploe), teeth);
  }
};

// Caches the last point, because it is needed twice: for its depth and for its tissue.
const Skull& remembered(const Vec3& p) {
  thread_local Vec3 at = Vec3::Zero();
  thread_local Skull last(at);
  if (at != p) {
    last = Skull(p);
    at = p;
  }
  return last;
}

}  // namespace

Phantom skull(double voxel, const Variant&) {
  Phantom phantom;
  phantom.tissues.tissues = {
      {.name = "air", .kind = TissueKind::air},
      {.name = "vault", .colour = {0.91F, 0.87F, 0.77F}, .cutting_energy = 1.2e9},
      {.name = "diploe", .colour = {0.88F, 0.76F, 0.62F}, .cutting_energy = 0.7e9, .bleeds = 0.15},
      {.name = "teeth", .colour = {0.96F, 0.94F, 0.88F}, .cutting_energy = 3.0e9},
      {.name = "face and base", .colour = {0.90F, 0.85F, 0.74F}, .cutting_energy = 1.1e9},
  };
  for (std::size_t id = 0; id < phantom.tissues.tissues.size(); ++id)
    phantom.tissues.tissues[id].label = static_cast<int>(id);

  phantom.formula.lipschitz = 1.7;
  phantom.formula.depth = [](const Vec3& p) { return remembered(p).depth; };
  phantom.formula.tissue = [ramp = volume::kRamp * voxel](const Vec3& p, double depth) -> TissueId {
    if (depth < -ramp) return kAir;
    const Skull& s = remembered(p);
    if (s.teeth > std::min(0.0, depth)) return kTeeth;
    if (s.diploe > -1.0 * kMm && s.hull > 1.2 * kMm) return kDiploe;
    return s.vault < 9 * kMm && p.z() > -30 * kMm ? kTables : kFace;
  };
  phantom.lo = at_mm(-80, -112, -82);
  phantom.hi = at_mm(80, 98, 82);
  return phantom;
}

}  // namespace burr::phantom
