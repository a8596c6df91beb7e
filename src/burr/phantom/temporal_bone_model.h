// phantom/temporal_bone_model.h - the shape of a right temporal bone, by formula: how deep a point lies in each of its parts.
// Which bone and tissue that makes is temporal_bone.cpp's.
//
// Frame: LPS around the opening of the ear canal; in a right ear x runs medially (deeper for the
// surgeon), y backwards, z up. Distances between landmarks follow Gulya & Schuknecht, Anatomy of
// the Temporal Bone, 3rd ed., to a millimetre or two; the outer shape is modelled by eye.
// Thread: any.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "burr/phantom/phantoms.h"
#include "burr/phantom/sculpt.h"

namespace burr::phantom::temporal {

using volume::TissueId;

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

}  // namespace burr::phantom::temporal
