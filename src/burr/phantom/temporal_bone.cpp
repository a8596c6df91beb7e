// phantom/temporal_bone.cpp - a right temporal bone, by formula.
//
// Frame: LPS around the opening of the ear canal; in a right ear x runs medially (deeper for the
// surgeon), y backwards, z up. Distances between landmarks follow Gulya & Schuknecht, Anatomy of
// the Temporal Bone, 3rd ed., to a millimetre or two; the outer shape is modelled by eye.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "burr/phantom/phantoms.h"
#include "burr/phantom/sculpt.h"

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

// Everything that the formula needs about one point; depths are positive inside each part [m]
struct Parts {
  double hull = 0;    // the bone as a whole, without holes
  double fossa = 0;   // the inside of the skull
  double dura = 0;    // where the dura may be: so near to the bone
  double tegmen = 0;  // height above the floor of the middle fossa
  double canal = 0;   // ear canal
  double middle = 0;  // tympanic cavity
  double antrum = 0;
  double cells = 0;               // air of the mastoid cells
  double field = 0;               // where the cells may be
  double facial = 0;              // distance to the nerve's centre line
  double canal_bone = 0.8 * kMm;  // thickness of the facial canal's wall
  double chorda = 0;              // the same for the chorda tympani
  double sinus = 0;               // distance to its centre line, jugular bulb included
  double carotid = 0;
  double meatus = 0;
  double semicircular = 0;  // distance to the nearest canal's circle
  double cochlea = 0;       // distance to the spiral minus its tube radius
  double capsule = 0;
  double malleus = 0, incus = 0, stapes = 0;
  double drum = 0;
};

// farther outside the bone than this nothing is labelled [m]
constexpr double kSkin = 6e-3;

class TemporalBone {
 public:
  TemporalBone(double voxel, const Variant& variant)
      : ramp_(volume::kRamp * voxel),
        forward_(variant.mm("forward-sinus", 4) * kMm),
        lower_(variant.mm("low-dura", 4) * kMm),
        dehiscent_(variant.has("dehiscent")),
        sclerotic_(variant.has("sclerotic")),
        ridge_dura_(variant.has("ridge-dura")) {}

  [[nodiscard]] double depth(const Vec3& p) const { return bone(remembered(p)); }
  [[nodiscard]] double soft(const Vec3& p) const { return labelled(remembered(p)); }
  [[nodiscard]] TissueId tissue(const Vec3& p, double depth) const;

  static Vec3 lo() { return at_mm(-9, -29, -31); }
  static Vec3 hi() { return at_mm(49, 35, 27); }
  [[nodiscard]] std::vector<Landmark> landmarks() const;

 private:
  [[nodiscard]] Parts parts(const Vec3& p) const;
  // Caches the last point, because it is needed twice: for its depth and for its tissue.
  [[nodiscard]] const Parts& remembered(const Vec3& p) const {
    struct Memory {
      Vec3 p = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
      std::uint64_t of = 0;
      double ramp = 0;
      Parts parts;
    };
    thread_local Memory last;
    // a model may lie where another one lay; its number does not come again
    if (last.p != p || last.of != number_ || last.ramp != ramp_)
      last = {p, number_, ramp_, parts(p)};
    return last.parts;
  }
  [[nodiscard]] double outer(const Vec3& p, double canal_axis) const;
  void ossicles(const Vec3& p, Parts& s) const;
  [[nodiscard]] double bone(const Parts& s) const;
  [[nodiscard]] static double labelled(const Parts& s);
  [[nodiscard]] TissueId solid_tissue(const Parts& s, const Vec3& p) const;
  [[nodiscard]] static TissueId soft_tissue(const Parts& s);
  [[nodiscard]] static TissueId air_tissue(const Parts& s, const Vec3& p);

  double ramp_;             // [m]
  double forward_, lower_;  // of the sinus and of the dura, from their usual places [m]
  bool dehiscent_, sclerotic_, ridge_dura_;
  std::uint64_t number_ = next_number();
  static std::uint64_t next_number() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
  }

  // How much lower the roof is here: over the mastoid alone, for the attic has no room to spare.
  [[nodiscard]] double lowered(const Vec3& p) const {
    const auto rise = [](double t) {
      const double c = std::clamp(t, 0.0, 1.0);
      return c * c * (3 - 2 * c);
    };
    return lower_ > 0
               ? lower_ * rise((p.y() - 3 * kMm) / (7 * kMm)) * rise((24 * kMm - p.x()) / (8 * kMm))
               : 0.0;
  }
  // Middle of a dehiscence, on the tympanic part of the nerve
  static Vec3 dehiscence() { return at_mm(21.8, -2.4, 4.4); }
  // The descending part lies farther forward; the bulb stays.
  static std::vector<Vec3> sinus_curve(double forward) {
    const Vec3 by = -forward * Vec3::UnitY();
    return {at_mm(27, 44, 12) + by,        at_mm(18.5, 33.5, 9.5) + by,
            at_mm(13.6, 26.5, 3.5) + by,   at_mm(12.2, 22.5, -4.5) + by,
            at_mm(14.5, 19.5, -11.5) + by, at_mm(19.5, 14, -14.5) + 0.5 * by,
            at_mm(23.6, 7.5, -13),         at_mm(24.6, 3.6, -11)};
  }

  // ends and middles of parts that landmarks name too
  static Vec3 henle() { return at_mm(1.1, 4.6, 4.8); }
  static Vec3 tip_end() { return at_mm(9.0, 7.2, -23); }
  static Vec3 antrum_centre() { return at_mm(13.6, 9.2, 6.0); }
  static Vec3 short_process() { return at_mm(17.8, 1.4, 6.4); }
  static Vec3 drum_centre() { return at_mm(17.4, -4.0, -0.2); }
  static Vec3 drum_normal() { return Vec3(-0.84, 0.30, -0.45).normalized(); }  // towards the canal

  // inside of the skull: a ball, cut off below by the floor of the middle fossa and in front by the
  // back face of the pyramid
  Vec3 skull_ = at_mm(70, 6, 30);
  Vec3 back_face_ = Vec3(0.62, 0.77, 0.14).normalized();

  Curve canal_{{at_mm(-9, 1, -1), at_mm(0, 0, 0), at_mm(7, -1.2, 0.6), at_mm(17.2, -4, -0.4)},
               14 * kMm};
  Curve facial_{
      {at_mm(37, -3.2, 4.6), at_mm(31, -4.4, 4.4), at_mm(27.5, -7.2, 5.0), at_mm(25.2, -9.0, 5.2),
       at_mm(23.4, -6.4, 5.0), at_mm(21.8, -2.4, 4.4), at_mm(19.6, 1.4, 3.4), at_mm(17.6, 4.0, 1.0),
       at_mm(16.8, 4.8, -3), at_mm(16.2, 5.2, -10), at_mm(15.6, 5.4, -18), at_mm(14.5, 4.0, -25)},
      4 * kMm};
  Curve chorda_{{at_mm(16.1, 5.0, -12.5), at_mm(15.9, 3.0, -6), at_mm(16.6, 0.8, -0.5),
                 at_mm(18.2, -1.5, 2.6), at_mm(18.8, -4.6, 3.0), at_mm(18.6, -8.2, 1.6),
                 at_mm(19.2, -11.5, -1.0)},
                3 * kMm};
  Curve sinus_{sinus_curve(forward_), 8 * kMm};
  Curve carotid_{
      {at_mm(29, -6, -34), at_mm(28.5, -8.6, -17), at_mm(28.4, -11.2, -9), at_mm(31, -13.4, -6),
       at_mm(38, -16.6, -3.6), at_mm(46, -21, -3.2), at_mm(56, -27, -3)},
      6 * kMm};
  Curve meatus_{{at_mm(30.5, -3.6, 3.6), at_mm(36, -2.6, 4), at_mm(50, 0.5, 4.5)}, 5 * kMm};
  Curve cochlea_ = spiral();
  Circle lateral_{at_mm(22.0, 2.6, 4.4), Vec3(0.06, 0.42, 0.9).normalized(), 3.0 * kMm};
  Circle posterior_{at_mm(24.8, 5.6, 1.6), Vec3(0.62, 0.76, 0.2).normalized(), 2.9 * kMm};
  Circle superior_{at_mm(25.4, -0.4, 7.0), Vec3(0.76, -0.62, -0.16).normalized(), 3.1 * kMm};
  Vec3 vestibule_ = at_mm(24.0, -1.2, 2.6);

  // two and a half turns, the tip pointing forwards and outwards
  static Curve spiral() {
    const Vec3 base = at_mm(27.8, -9.2, -0.4);
    const Vec3 axis = Vec3(-0.52, -0.78, -0.34).normalized();
    const Vec3 u = axis.cross(Vec3::UnitZ()).normalized(), v = axis.cross(u);
    std::vector<Vec3> through;
    for (int n = 0; n <= 30; ++n) {
      const double turn = 2 * std::numbers::pi * n / 12.0;
      const double shrink = 1 - 0.72 * n / 30.0;
      through.push_back(base + kMm * (3.4 * shrink * (std::cos(turn) * u + std::sin(turn) * v) +
                                      (3.2 * n / 30.0 - 1.2) * axis));
    }
    return Curve(through, 5 * kMm, 2);
  }
};

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

// tubes in the bone: the radius of the canal, and of what lies in it
constexpr double kFacialCanalRadius = 1.25 * kMm, kFacialNerveRadius = 0.85 * kMm;
constexpr double kChordaCanalRadius = 0.45 * kMm, kChordaRadius = 0.3 * kMm;
constexpr double kSinusRadius = 4.3 * kMm, kCarotidRadius = 2.7 * kMm, kMeatusRadius = 2.1 * kMm;
constexpr double kCochleaTube = 0.8 * kMm;

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

// A part of a curve, from the corner nearest to one point to the corner nearest to another.
std::vector<Vec3> between(const std::vector<Vec3>& line, const Vec3& from, const Vec3& to) {
  const auto nearest = [&](const Vec3& p) {
    return std::min_element(line.begin(), line.end(), [&](const Vec3& a, const Vec3& b) {
      return (a - p).squaredNorm() < (b - p).squaredNorm();
    });
  };
  return std::vector<Vec3>(nearest(from), std::next(nearest(to)));
}

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

}  // namespace

Phantom temporal_bone(double voxel, const Variant& variant) {
  const auto model = std::make_shared<const TemporalBone>(voxel, variant);
  Phantom phantom;
  phantom.tissues = table();
  phantom.formula.depth = [model](const Vec3& p) { return model->depth(p); };
  phantom.formula.soft = [model](const Vec3& p) { return model->soft(p); };
  phantom.formula.tissue = [model](const Vec3& p, double depth) { return model->tissue(p, depth); };
  phantom.formula.lipschitz = 2.0;
  phantom.lo = TemporalBone::lo();
  phantom.hi = TemporalBone::hi();
  phantom.landmarks = model->landmarks();
  return phantom;
}

}  // namespace burr::phantom
