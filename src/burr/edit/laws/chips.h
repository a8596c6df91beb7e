// edit/laws/chips.h - a fluted burr cuts by its teeth: chip and edge forces on small pieces of edge.
//
//     dF_t = (K_tc t + K_te s(t)) db      along the cut           t = f cos(alpha)
//     dF_r = (K_rc t + K_re s(t)) db      out of the bone         s = 1 - exp(-t / onset)
//
// The mechanistic model of milling (Arbabtafti et al. 2011 for bone burrs; Altintas 2012, ch. 2;
// docs/cutting.md, "Chips"). Teeth run from the pole to the shaft; a piece of them cuts where it is
// in bone, a chip as thick as the feed per tooth f times the cosine of its angle to the push. The
// mean over a turn is an integral over the part of the ball that is in bone, with z / (2 pi rho)
// edges a metre across, rho: distance from the axis.
//
// f is what nobody knows beforehand: the hand pushes with F_n, so f is where the thrust of all
// pieces equals it (the spring's force is the thrust; nothing is added to it). From f follow the
// volume, MRR = z |w| f / 2 pi times the area that cuts seen along the push; the torque; the drag;
// and the power, u = P / MRR = K_tc + K_te s / t: thin chips cost more, which is what is measured
// on bone (James et al. 2013). The edge's part fades with t below `onset`, its bluntness: without
// that a light hand would cut nothing at all in a deep slot.
//
// Once per tooth the force along the surface swings by `ripple`: the first harmonic of the teeth in
// contact. A 1 kHz loop can carry it only for slow spindles.
//
// Thread: servo. Frame: world at the door, p_grid inside. Memory: none after construction. Cost:
// some 300 samples of the field.
#pragma once

#include <array>

#include "burr/edit/laws/removal.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/tool/burr_tool.h"
#include "burr/volume/bone.h"

namespace burr::edit {

class Chips {
 public:
  explicit Chips(const volume::Bone& bone);

  // centre: of the burr, world [m]; normal: of the contact, unit, out of the bone; push: normal
  // force [N]. Without ripple it stays 0, for a quarter of the time less. A burr without teeth, or
  // one that turns backwards, cuts nothing.
  [[nodiscard]] Cutting step(const tool::Burr& burr, const math::Vec3& centre,
                             const math::Vec3& normal, double push, const Spin& spin, double dt,
                             const RemovalSettings& settings, bool with_ripple = true) BURR_RT;

  // Of the last step.
  [[nodiscard]] double feed_per_tooth() const BURR_RT { return feed_; }  // f  [m]
  [[nodiscard]] double edge_length() const BURR_RT { return edge_; }     // in bone, mean [m]
  [[nodiscard]] double removal_rate() const BURR_RT { return rate_; }    // [m^3/s]

 private:
  static constexpr int kRings = 14;   // about the push, denser towards it
  static constexpr int kAround = 22;  // pieces of a ring
  // A ring's edges together: all have the same chip.
  struct Ring {
    double cosine = 0;                              // of alpha
    double edge = 0, arm = 0, area = 0, price = 0;  // sums over pieces; see gather()
    volume::CuttingForce force;                     // mean, by length of edge
    math::Vec3 drag = math::Vec3::Zero();           // sum of edge times its way
    double swing_re = 0, swing_im = 0;              // sum of edge times e^(i z phi)
  };
  // A direction on the ball: parts along the push and across it, and its share of the area over
  // r^2.
  struct Point {
    double cosine = 0, u = 0, v = 0, area = 0;
  };
  static constexpr int kPoints = kRings * kAround;
  void gather(const tool::Burr& burr, const math::Vec3& centre, const math::Vec3& normal,
              const math::Vec3& axis, double pole, bool with_ripple) BURR_RT;

  const volume::Bone& bone_;
  std::array<Point, kPoints> points_;
  std::array<Ring, kRings> rings_;
  double feed_ = 0, edge_ = 0, rate_ = 0;
};

}  // namespace burr::edit
