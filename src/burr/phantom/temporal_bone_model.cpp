#include "burr/phantom/temporal_bone_model.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace burr::phantom::temporal {

// The outer surface, as seen before the first cut.
double TemporalBone::outer(const Vec3& p, double canal_axis) const {
  const double mm = kMm;

  // vault: squama above and wall behind, one shell of the skull
  const double from_skull = (p - skull_).norm();
  const double thickness = (3.6 + 0.8 * noise(p, 14 * mm, 1)) * mm;
  double depth = std::min(70 * mm - from_skull, from_skull - (70 * mm - thickness));
  // it ends at the skull's base: in front above the jaw joint, behind at the occipital suture
  const double base = p.z() - (p.y() < 4 * mm ? 5 * mm : 5 * mm - 1.1 * (p.y() - 4 * mm));
  depth = carve_soft(depth, 0.65 * base, 3 * mm);

  // mastoid: broad above, tapering to a blunt tip that points down and slightly forwards
  static const RoundCone body{at_mm(12.5, 15, 2), at_mm(10.5, 12, -12), 14.2 * mm, 11.0 * mm};
  static const RoundCone tip{at_mm(10.5, 12.5, -10), tip_end(), 10.2 * mm, 4.6 * mm};
  depth = blend(depth, body, p, 7 * mm);
  depth = blend(depth, tip, p, 5 * mm);

  // pyramid: inwards and forwards; its top is the floor of the middle fossa
  static const RoundCone pyramid{at_mm(16, 3, 0), at_mm(54, -21, -1), 13 * mm, 7.5 * mm};
  depth = blend(depth, pyramid, p, 6 * mm);

  // root of the zygoma above the canal, running forwards as a bar; behind it the temporal line
  static const RoundCone root{at_mm(3.2, -3, 8.6), at_mm(-0.6, -15, 7.0), 4.4 * mm, 2.8 * mm};
  static const RoundCone bar{at_mm(-0.6, -15, 7.0), at_mm(-4.2, -34, 4.8), 2.8 * mm, 2.0 * mm};
  static const RoundCone line{at_mm(3.0, -1, 9.8), at_mm(8.6, 27, 16.5), 2.8 * mm, 1.6 * mm};
  depth = blend(depth, root, p, 5 * mm);
  depth = blend(depth, bar, p, 3 * mm);
  depth = blend(depth, line, p, 3.5 * mm);

  // between squama and pyramid: the roof of the jaw joint
  const double roof = 2.4 * mm - std::abs(p.z() - 8.4 * mm + 0.04 * (p.x() - 10 * mm));
  const double around = 17 * mm - (p - at_mm(15, -13, 8)).norm();
  depth = blend(depth, std::min({roof, around, 70 * mm - from_skull}), 4 * mm);

  // tubercle and socket of that joint
  static const RoundCone tubercle{at_mm(3, -19.5, 3.4), at_mm(15, -18, 2.8), 3.4 * mm, 3.4 * mm};
  depth = blend(depth, tubercle, p, 4 * mm);
  static const RoundCone socket{at_mm(3, -12.5, -2.6), at_mm(17, -12, -3.4), 4.9 * mm, 4.9 * mm};
  depth = carve_soft(depth, socket, p, 3 * mm);

  // tympanic bone: a gutter that forms the front, the floor and part of the back of the canal
  const double ring = 7.0 * mm - canal_axis;
  const double reach = std::min(p.x() - 1.6 * mm + 0.12 * p.z(), 19 * mm - p.x());
  depth = blend(depth, std::min({ring, reach, 3.0 * mm - p.z()}), 2.2 * mm);

  // its sheath, and the styloid process
  static const RoundCone styloid{at_mm(17.2, 0.5, -8), at_mm(20.0, -6.5, -34), 2.6 * mm, 0.7 * mm};
  depth = blend(depth, styloid, p, 2.5 * mm);

  // spine of Henle, behind and above the opening
  static const RoundCone spine{at_mm(2.2, 6.4, 1.6), henle(), 1.1 * mm, 0.8 * mm};
  depth = blend(depth, spine, p, 1.6 * mm);

  // groove of the digastric muscle, inside the tip
  static const RoundCone digastric{at_mm(17, 6, -24), at_mm(19, 30, -15), 4.2 * mm, 3.6 * mm};
  depth = carve_soft(depth, digastric, p, 2.5 * mm);

  if (depth < -3 * mm) return depth;  // too far away for details to matter

  // pits of the cribriform area over the antrum, and the hole of the emissary vein
  const double area = 5.0 * mm - (p - at_mm(-1.5, 11, 6)).norm();
  if (area > -3 * mm) {
    const double pits =
        std::min(0.35 * mm - 0.9 * mm + 0.9 * mm * noise(p, 1.5 * mm, 2), 0.3 * area);
    depth = carve_soft(depth, -pits, 0.5 * mm);
  }

  // real bone is less smooth than a formula
  return depth + 0.35 * mm * noise(p, 7 * mm, 3) + 0.10 * mm * noise(p, 2.2 * mm, 4);
}

Parts TemporalBone::parts(const Vec3& p) const {
  const double mm = kMm;
  Parts s;

  // a specimen as it comes from the saw: a rounded block around the bone
  const Vec3 half = 0.5 * (hi() - lo()) - Vec3::Constant(1.2 * mm);
  const Vec3 out = (p - 0.5 * (lo() + hi())).cwiseAbs() - (half - Vec3::Constant(2 * mm));
  const double block = 2 * mm - out.cwiseMax(0.0).norm() - std::min(out.maxCoeff(), 0.0);

  // floor of the middle fossa: falls towards the apex, rises over the superior canal
  const double eminence =
      2.4 * mm * std::exp(-(p - superior_.centre).head<2>().squaredNorm() / (36e-6));
  s.tegmen =
      p.z() - (11.6 * mm - 0.09 * (p.x() - 14 * mm) + eminence + 0.5 * mm * noise(p, 8 * mm, 5));
  if (lower_ > 0) s.tegmen += lowered(p);
  const double within_skull = 66.6 * mm - (p - skull_).norm();
  const double behind = (p - at_mm(26, 10.5, 0)).dot(back_face_) + 0.4 * mm * noise(p, 9 * mm, 6);
  // the sinus lies in the corner and keeps a layer of bone in front of it
  s.sinus = std::min(sinus_.distance(p), (p - at_mm(24.4, 3.8, -10.6)).norm() - 0.6 * mm);
  const double over = std::min(s.tegmen, within_skull);
  const double back = std::min(behind, within_skull);
  s.fossa = blend(over, back, 1.5 * mm);

  const double canal_axis = canal_.distance(p);
  s.hull = std::min(carve_soft(outer(p, canal_axis), -s.fossa, 1.5 * mm), block);
  s.dura = ridge_dura_ ? std::min(s.hull + 3.5 * mm, block + 2 * mm) : s.hull + 2 * mm;

  if (s.hull < -kSkin) return s;  // nothing inside matters here

  s.canal = (4.1 * mm + 0.035 * (6 * mm - std::clamp(p.x(), -3 * mm, 17 * mm))) - canal_axis;
  static const Vec3 drum_normal = TemporalBone::drum_normal(),
                    drum_centre = TemporalBone::drum_centre();
  const double before_drum = (p - drum_centre).dot(drum_normal);
  s.drum = std::min(0.2 * mm - std::abs(before_drum), 4.6 * mm - (p - drum_centre).norm());

  s.facial = facial_.distance(p);
  if (dehiscent_)  // no bone over 3 mm
    s.canal_bone *= std::clamp(((p - dehiscence()).norm() - 1.5 * mm) / mm, 0.0, 1.0);
  s.chorda = chorda_.distance(p);
  s.carotid = carotid_.distance(p);
  s.meatus = meatus_.distance(p);
  s.semicircular = std::min({lateral_.distance(p), posterior_.distance(p), superior_.distance(p)});
  s.cochlea = cochlea_.distance(p);
  const double vestibule = ellipsoid(p, vestibule_, at_mm(1.7, 2.2, 2.4));

  // hard shell (otic capsule) around the canals of the inner ear
  s.capsule = blend(1.75 * mm - s.semicircular, vestibule + 1.9 * mm, 1.2 * mm);
  s.capsule = blend(s.capsule, 2.2 * mm - s.cochlea, 1.2 * mm);
  s.semicircular = std::min(s.semicircular - 0.55 * mm, -vestibule);

  // middle ear: tympanic cavity, attic above it, and the passage back to the antrum
  s.middle = ellipsoid(p, at_mm(19.9, -4.4, -0.2), at_mm(2.9, 5.6, 6.2));
  s.middle = blend(s.middle, ellipsoid(p, at_mm(19.2, -3.4, 6.2), at_mm(2.9, 4.8, 3.6)), 2 * mm);
  static const RoundCone aditus{at_mm(18.2, 0.5, 6.6), at_mm(16.0, 5.5, 6.6), 2.3 * mm, 2.8 * mm};
  s.middle = blend(s.middle, aditus, p, 1.5 * mm);
  static const RoundCone tube{at_mm(20.5, -8.5, -1), at_mm(33, -21, -5), 2.4 * mm, 1.3 * mm};
  s.middle = blend(s.middle, tube, p, 1.5 * mm);
  s.antrum = ellipsoid(p, antrum_centre(), at_mm(4.4, 4.6, 4.4)) + 0.3 * mm * noise(p, 3 * mm, 7);

  // air cells: the inside of the mastoid down to the tip, under a cortex; larger near the antrum
  const double cortex = (2.3 + 0.6 * noise(p, 9 * mm, 8)) * mm;
  const double field = std::min(
      s.hull - cortex, blend(ellipsoid(p, at_mm(10, 13, -1), at_mm(13, 15, 14)),
                             ellipsoid(p, at_mm(10, 11.5, -15), at_mm(8.5, 8.5, 11)), 4 * mm));
  s.field = field;
  if (sclerotic_) {
    s.cells = std::min(-2 * mm, field);
  } else if (field > -ramp_ - 1 * mm) {
    const double wall = 0.5 * (0.5 + 0.15 * noise(p, 5 * mm, 9)) * mm;
    // towards the edge of the field the cells are small
    const double deep = std::clamp((field - 2.5 * mm) / (3 * mm), 0.0, 1.0);
    const double big = deep > 0 ? foam(p, 4.4 * mm, 0.24, 11) - wall : 0;
    const double small = deep < 1 ? foam(p, 2.6 * mm, 0.14, 12) - wall : 0;
    s.cells = std::min(deep * big + (1 - deep) * small, field);
  } else {
    s.cells = field;
  }

  ossicles(p, s);
  return s;
}

// The ossicles; from far away only a lower bound of their distance.
void TemporalBone::ossicles(const Vec3& p, Parts& s) const {
  const double mm = kMm;
  const double outside = (p - at_mm(20, -2.5, 3)).norm() - 6.6 * mm;
  if (outside > ramp_ + 0.5 * mm) {
    s.malleus = s.incus = s.stapes = -outside;
    return;
  }
  const auto rod = [](const Vec3& a, const Vec3& b, double ra, double rb) {
    return RoundCone(a, b, ra * kMm, rb * kMm);
  };
  static const Vec3 head = at_mm(19.4, -5.4, 6.0), neck = at_mm(18.9, -5.0, 2.8);
  static const RoundCone malleus[] = {rod(head, head, 1.25, 1.25), rod(head, neck, 0.7, 0.6),
                                      rod(neck, at_mm(18.0, -4.2, -0.8), 0.6, 0.4)};
  s.malleus = blend(malleus[0].depth(p), malleus[1].depth(p), 0.6 * mm);
  s.malleus = blend(s.malleus, malleus[2].depth(p), 0.4 * mm);

  static const Vec3 body = at_mm(19.4, -2.9, 6.2), long_end = at_mm(20.2, -2.2, 2.0);
  static const RoundCone incus[] = {rod(body, body, 1.3, 1.3), rod(body, short_process(), 0.9, 0.4),
                                    rod(body, long_end, 0.7, 0.4),
                                    rod(long_end, at_mm(20.8, -2.1, 1.9), 0.4, 0.4)};
  s.incus = blend(incus[0].depth(p), incus[1].depth(p), 0.5 * mm);
  s.incus = blend(s.incus, incus[2].depth(p), 0.5 * mm);
  s.incus = blend(s.incus, incus[3].depth(p), 0.2 * mm);

  static const Vec3 anvil = at_mm(21.1, -2.0, 1.9);
  static const RoundCone stapes[] = {
      rod(anvil, at_mm(22.7, -2.9, 2.2), 0.3, 0.25), rod(anvil, at_mm(22.7, -0.9, 2.2), 0.3, 0.25),
      rod(at_mm(22.8, -3.0, 2.2), at_mm(22.8, -0.8, 2.2), 0.35, 0.35)};
  s.stapes = blend(stapes[0].depth(p), stapes[1].depth(p), 0.1 * mm);
  s.stapes = blend(s.stapes, stapes[2].depth(p), 0.1 * mm);
}

namespace {

// A part of a curve, from the corner nearest to one point to the corner nearest to another.
std::vector<Vec3> between(const std::vector<Vec3>& line, const Vec3& from, const Vec3& to) {
  const auto nearest = [&](const Vec3& p) {
    return std::min_element(line.begin(), line.end(), [&](const Vec3& a, const Vec3& b) {
      return (a - p).squaredNorm() < (b - p).squaredNorm();
    });
  };
  return std::vector<Vec3>(nearest(from), std::next(nearest(to)));
}

}  // namespace

std::vector<Landmark> TemporalBone::landmarks() const {
  const std::vector<Vec3> nerve = facial_.points(), vein = sinus_.points();
  // the bends of the nerve, as in the list of its points
  const Vec3 first_genu = at_mm(25.2, -9.0, 5.2), second_genu = at_mm(17.6, 4.0, 1.0),
             foramen = at_mm(15.6, 5.4, -18);
  // where the lateral canal bulges outwards
  const Vec3 outwards = -Vec3::UnitX();
  const Vec3 dome =
      lateral_.centre +
      lateral_.radius * (outwards - outwards.dot(lateral_.axis) * lateral_.axis).normalized();
  const std::vector<Vec3> mastoid_part = between(nerve, second_genu, foramen);
  const Vec3 forward = -forward_ * Vec3::UnitY();
  const auto lower = [this](const Vec3& p) { return Vec3(p - lowered(p) * Vec3::UnitZ()); };
  std::vector<Landmark> all = {
      {"spine of Henle", {henle()}, {}},
      {"temporal line", {at_mm(3.0, -1, 9.8), at_mm(8.6, 27, 16.5)}, {}},
      {"MacEwen's triangle", {at_mm(-2.0, 11.0, 5.0)}, {}},
      {"mastoid tip", {tip_end()}, {}},
      {"antrum", {antrum_centre()}, {}},
      {"way to the antrum", {at_mm(-2.0, 11.0, 5.0), antrum_centre()}, {}},
      {"aditus", {at_mm(16.0, 5.5, 6.6), at_mm(18.2, 0.5, 6.6)}, {}},
      {"tip of the short process", {short_process()}, {}},
      {"short process of the incus", {at_mm(19.4, -2.9, 6.2), short_process()}, {}},
      {"facial nerve", nerve, {}},
      {"facial nerve, tympanic part", between(nerve, first_genu, second_genu), {}},
      {"facial nerve, mastoid part", mastoid_part, {}},
      {"second genu", {mastoid_part.front()}, {}},
      {"stylomastoid foramen", {mastoid_part.back()}, {}},
      {"chorda tympani", chorda_.points(), {}},
      {"chorda tympani in the recess",
       between(chorda_.points(), at_mm(15.9, 3.0, -6), at_mm(18.2, -1.5, 2.6)),
       {}},
      {"sigmoid sinus", vein, {}},
      {"mastoid sinus",
       between(vein, at_mm(18.5, 33.5, 9.5) + forward, at_mm(19.5, 14, -14.5) + 0.5 * forward),
       {}},
      {"jugular bulb", {at_mm(24.4, 3.8, -10.6)}, {}},
      {"tegmen", {lower(at_mm(14, 9.2, 11.6))}, Vec3(0.09, 0, 1).normalized()},
      // where the roof and the back face meet before the sinus, from outside inwards
      {"sinodural angle",
       {lower(at_mm(6, 22.5, 9.5) + forward), lower(at_mm(14, 17, 9.5) + forward)},
       {}},
      {"back face of the pyramid", {at_mm(26, 10.5, 0)}, back_face_},
      {"digastric groove", {at_mm(17, 6, -24), at_mm(19, 30, -15)}, {}},
      {"ear canal", canal_.points(), {}},
      {"eardrum", {drum_centre()}, drum_normal()},
      {"lateral canal", {lateral_.centre}, lateral_.axis},
      {"dome of the lateral canal", {dome}, {}},
      {"posterior canal", {posterior_.centre}, posterior_.axis},
      {"superior canal", {superior_.centre}, superior_.axis},
      {"vestibule", {vestibule_}, {}},
      {"internal carotid artery", carotid_.points(), {}},
  };
  if (dehiscent_) all.push_back({"dehiscence of the facial canal", {dehiscence()}, {}});
  return all;
}

}  // namespace burr::phantom::temporal
