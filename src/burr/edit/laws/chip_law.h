// edit/laws/chip_law.h - the cutting law of a fluted burr: chip and edge forces on small pieces of its
// teeth.
//
//     dF_t = (K_tc t + K_te s(t)) db      along the cut           t = f cos(alpha)
//     dF_r = (K_rc t + K_re s(t)) db      out of the bone         s = 1 - exp(-t / onset)
//
// The mechanistic model of milling (Arbabtafti et al. 2011 for bone burrs; Altintas 2012, ch. 2;
// docs/understand/cutting.md, "Chips"). Teeth run from the pole to the shaft. A piece of a tooth
// cuts where it is in bone; its chip is as thick as the feed per tooth f times the cosine of its
// angle alpha to the push. The mean over one revolution is an integral over the part of the ball
// that is in bone, with z / (2 pi rho) edges per metre across them (z teeth; rho: distance from the
// axis).
//
// f is not known beforehand. The hand pushes with F_n, so f is the value at which the thrust of all
// pieces equals F_n (the spring's force is the thrust; nothing is added to it). From f follow the
// volume, MRR = z |w| f / 2 pi times the cutting area projected along the push; the torque; the
// drag; and the power, u = P / MRR = K_tc + K_te s / t: thin chips cost more energy, as measured on
// bone (James et al. 2013). The edge term fades when t is below `onset`, the bluntness of the edge;
// without that, a light hand would cut nothing at all in a deep slot.
//
// The force along the surface varies with amplitude `ripple` at the tooth frequency: the first
// harmonic of the teeth in contact. A 1 kHz loop can reproduce it only for slow spindles.
//
// Thread: servo. Frame: world in arguments and results, p_grid inside. Memory: none after
// construction. Cost: some 300 samples of the field.
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
  // force [N]. with_ripple = false: ripple stays 0, and the step takes a quarter less time. A burr
  // without teeth, or one that turns backwards, cuts nothing.
  [[nodiscard]] Cutting step(const tool::Burr& burr, const math::Vec3& centre,
                             const math::Vec3& normal, double push, const Spin& spin, double dt,
                             const RemovalSettings& settings, bool with_ripple = true) BURR_RT;

  // Values of the last step.
  [[nodiscard]] double feed_per_tooth() const BURR_RT { return feed_; }  // f  [m]
  [[nodiscard]] double edge_length() const BURR_RT { return edge_; }     // in bone, mean [m]
  [[nodiscard]] double removal_rate() const BURR_RT { return rate_; }    // [m^3/s]

 private:
  static constexpr int kRings = 14;          // around the push, denser near it
  static constexpr int kPiecesPerRing = 22;  // pieces per ring
  // The edges of one ring taken together: all have the same chip thickness.
  struct Ring {
    double cosine = 0;                              // of alpha
    double edge = 0, arm = 0, area = 0, price = 0;  // sums over its pieces; see gather()
    volume::CuttingForce force;                     // mean, by length of edge
    math::Vec3 drag = math::Vec3::Zero();           // sum of edge times its direction of motion
    double swing_re = 0, swing_im = 0;              // sum of edge times e^(i z phi)
  };
  // A direction on the ball: components along the push and across it, and its share of the area
  // over r^2.
  struct Point {
    double cosine = 0, u = 0, v = 0, area = 0;
  };
  static constexpr int kPoints = kRings * kPiecesPerRing;
  void gather(const tool::Burr& burr, const math::Vec3& centre, const math::Vec3& normal,
              const math::Vec3& axis, double pole, bool with_ripple) BURR_RT;

  const volume::Bone& bone_;
  std::array<Point, kPoints> points_;
  std::array<Ring, kRings> rings_;
  double feed_ = 0, edge_ = 0, rate_ = 0;
};

}  // namespace burr::edit
