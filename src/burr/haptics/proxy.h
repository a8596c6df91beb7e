// haptics/proxy.h - the burr head that stays outside the bone while the hand may press into it.
//
//     hand  x - - - spring - - - o  proxy     the hand may sink into the bone, the proxy may not;
//        (in the bone)      (on the surface)  force_law.h turns the stretch between them into force
//
// The bone consists of the small discs of volume/iso_vertices.h; the burr is an exact ball. A few
// times per tick: collect the discs that the next short move could reach, find the smallest
// correction of that move that keeps the ball off all of them (least_move.h), move. The distance to
// a disc is a convex function, so a straight move between two free places is free: the burr cannot
// fall through, at any speed. Mathematics: docs/understand/touch.md, "The proxy" and "Friction"
// (Harwin & Melder 2002).
//
// Thread: servo. Frame: world in arguments and results, p_grid inside. Memory: allocates nothing
// after construction. Cost: docs/understand/realtime.md.
#pragma once

#include <memory>
#include <vector>

#include "burr/haptics/least_move.h"
#include "burr/haptics/scan_kernel.h"
#include "burr/haptics/touch_method.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/volume/iso_vertices.h"

namespace burr::haptics {

class Proxy : public TouchMethod {
 public:
  Proxy(const volume::IsoVertices& surface, const ProxySettings& settings, const math::Vec3& hand);

  // True if the burr can be here without touching bone. p: world [m]
  [[nodiscard]] bool is_free(const math::Vec3& p) BURR_RT;

  // Puts the burr at a free place. Only for the start, a clutch, or a device that was lost.
  void place(const math::Vec3& p) BURR_RT override;

  // Moves the proxy towards the hand as far as the bone allows.
  [[nodiscard]] Touch step(const math::Vec3& hand) BURR_RT override;

  [[nodiscard]] const math::Vec3& position() const BURR_RT override { return proxy_; }
  [[nodiscard]] const ProxySettings& settings() const BURR_RT { return settings_; }
  void set_friction(double mu_static, double mu_kinetic) BURR_RT override;
  // Fewer moves per tick cost less time. The burr then lags behind a fast hand, but is never in
  // bone.
  void set_max_moves(int moves) BURR_RT { settings_.max_moves = moves; }
  // A larger burr may not fit at the present place: false then, and nothing changes.
  [[nodiscard]] bool set_radius(double radius) BURR_RT override;

 private:
  void look_around(const math::Vec3& centre, double reach, bool crowded) BURR_RT;
  void take_discs() BURR_RT;
  void scan_near(const math::Vec3& centre, double within, bool crowded) BURR_RT;
  void collect(const math::Vec3& centre, double within, bool crowded = false) BURR_RT;
  void be_gentle() BURR_RT;
  [[nodiscard]] LeastMove move_toward(const math::Vec3& from, const math::Vec3& wanted,
                                      double longest, double& guess, bool& cut_short) BURR_RT;
  [[nodiscard]] LeastMove settle(const math::Vec3& target, double guess, int moves,
                                 Touch& touch) BURR_RT;
  [[nodiscard]] math::Vec3 on_smooth_surface(const LeastMove& last, const math::Vec3& hand,
                                             double& pressing) const BURR_RT;
  [[nodiscard]] bool rest_softly(const math::Vec3& hand) BURR_RT;
  void limit_slip(const math::Vec3& hand, Touch& touch) BURR_RT;
  [[nodiscard]] math::Vec3 force_place(const LeastMove& last, const math::Vec3& hand,
                                       double& pressing) BURR_RT;

  const volume::IsoVertices& surface_;
  volume::Grid grid_;
  ProxySettings settings_;
  ScanKernel kernel_;
  static constexpr int kMostNear = 8192;  // blocks
  std::vector<NearBlock> near_;           // blocks found by the last look_around()
  int near_count_ = 0;
  std::unique_ptr<NearDiscs> discs_;             // the discs of these blocks, if not too many
  bool taken_ = false;                           // true: discs_ holds them
  math::Vec3 near_centre_ = math::Vec3::Zero();  // centre of that search  p_grid
  double near_reach_ = -1;                       // near_ holds all discs with a smaller gap [voxel]
  double near_radius_ = 0;                       // radius of the burr then [voxel]
  std::uint64_t near_revision_ = 0;              // revision of the surface then
  std::unique_ptr<Candidates> candidates_;
  std::unique_ptr<Candidates> smooth_;  // at most three planes of the smooth surface
  double radius_ = 0;                   // [voxel]
  math::Vec3 proxy_;                    // world [m]
  math::Vec3 c_;                        // the same place in p_grid [voxel]
  double first_move_ = 0;               // length of the first move of the last settle() [voxel]
  double last_move_ = 0;                // length of the last tick's first move [voxel]
  bool sliding_ = false;
  struct Stretch {
    math::Vec3 hand = math::Vec3::Zero(), stretch = math::Vec3::Zero();  // of the last tick [m]
    bool known = false;
  } last_stretch_;
  std::uint64_t revision_ = 0;  // of the surface, at the last tick
  struct {
    math::Vec3 place = math::Vec3::Zero();  // where the burr rests on the soft layer       p_grid
    math::Vec3 proxy = math::Vec3::Zero();  // where the proxy was at that time             p_grid
    double pressing = 0;                    // sum of the loads of the discs there      [voxel]
    double support = 0;                     // soft_support(), its mean                 [voxel]
    double share = 0;                       // of the soft layer in the force; 1 while cutting [-]
    bool known = false;                     // the values above are those of the last tick
    double move = 0;                        // how far `place` moved in the last tick   [voxel]
  } soft_;
};

}  // namespace burr::haptics
