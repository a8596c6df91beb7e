// haptics/six/two_tools.h - two tools in two hands that feel each other: one programme in twelve
// unknowns.
//
//     V = V_a + V_b of six_proxy.h     with the rows of the bone for each, and for each pair of parts
//     n . (p_a + theta_a x w_a) - n . (p_b + theta_b x w_b) >= -gap
//
// Each half is measured by its own stiffness, so the force of a pair on one tool is the opposite of
// that on the other, and no tool comes first. Two tools that rest on each other with a stretch delta
// between the hands along the normal push with
//
//     N = delta / (1 / k_a + l_a^2 / k_ra + 1 / k_b + l_b^2 / k_rb)       l: levers about the couplings
//
// Friction holds each tool on the bone as if it were alone (six_friction.h). Between the two tools there
// is none: docs/understand/touch_two_tools.md, "Two tools".
//
// A part that is a lattice, as a piece of bone in the other hand, gives a row for each of its points
// that may be reached (lattice_gap.h).
//
// While no pair can meet in this tick, each tool is solved alone, to the bit as without the other. Two
// tools that overlap when they are taken up are not felt until they have been apart once.
//
// Thread: servo. Frame: world in arguments and results. Memory: none after construction.
#pragma once

#include <array>

#include "burr/haptics/six/part_gap.h"
#include "burr/haptics/six/six_proxy.h"
#include "burr/math/pose.h"
#include "burr/rt/rt.h"
#include "burr/tool/tool.h"

namespace burr::haptics {

struct HeldTool {
  SixProxy& proxy;
  math::Pose hand;
  double stiffness = 0;  // k_t  [N/m]
};

class TwoTools {
 public:
  // Both are held, and may meet in this tick: then step() is to be called in place of their own.
  [[nodiscard]] bool near(const HeldTool& a, const HeldTool& b) BURR_RT;
  // One of them is not held.
  void part() BURR_RT {
    apart_ = false;
    rests_a_ = rests_b_ = {};
  }
  // One tick of both.
  void step(const HeldTool& a, const HeldTool& b, SixTouch& touch_a, SixTouch& touch_b) BURR_RT;

 private:
  static constexpr int kParts = tool::Tool::kMostParts;
  static constexpr int kMostPairs = 5 * kParts * kParts + 2048;  // 2048 points of a lattice
  struct Pair {                                                  // a row: a . z_a + b . z_b >= -gap
    Six a = {}, b = {};
    math::Vec3 normal = math::Vec3::Zero();  // p_grid
    double gap = 0, tolerance = 0;
  };
  struct Twist;  // the solution of one programme
  struct Rubbing;
  struct Guesses {  // how far a move goes: the next one, and the first of a search
    SixProxy::Limits a, b, first_a, first_b;
    int moves = 0;
  };

  // All pairs that moves within these limits may close. False: too many.
  [[nodiscard]] bool find_pairs(const SixProxy& a, const SixProxy& b,
                                const SixProxy::Limits& limits_a,
                                const SixProxy::Limits& limits_b) BURR_RT;
  void add_pair(const PartGap& gap, const SixProxy& a, const SixProxy& b, double tolerance) BURR_RT;
  template <class Use>
  static void each_pair(const SixProxy& a, const SixProxy& b, const Use& use) BURR_RT;
  // Of a lattice it is exact below `below` only.
  [[nodiscard]] double least_gap(const SixProxy& a, const SixProxy& b, double below) const BURR_RT;
  void solve(SixProxy& a, SixProxy& b, const Six& wanted_a, const Six& wanted_b,
             Twist& twist) BURR_RT;
  void least(const SixProxy& a, const SixProxy& b, const Six& wanted_a, const Six& wanted_b,
             Twist& twist) const BURR_RT;
  void move(SixProxy& a, SixProxy& b, const Six& wanted_a, const Six& wanted_b,
            SixProxy::Limits& guess_a, SixProxy::Limits& guess_b, Twist& twist, SixTouch& touch_a,
            SixTouch& touch_b) BURR_RT;
  double seek(SixProxy& a, SixProxy& b, const math::Pose& goal_a, const math::Pose& goal_b,
              int most, Guesses& guess, Twist& twist, SixTouch& touch_a, SixTouch& touch_b) BURR_RT;
  bool rub_alone(SixProxy& a, SixProxy& b, const math::Pose& before_a, const math::Pose& before_b,
                 const math::Pose& goal_a, const math::Pose& goal_b, const Twist& twist,
                 SixTouch& touch_a, SixTouch& touch_b) BURR_RT;
  void rub(Rubbing& one, Rubbing& other, Guesses& guess, Twist& twist, SixTouch& touch_a,
           SixTouch& touch_b) BURR_RT;

  std::array<Pair, kMostPairs> pairs_;
  std::array<PartGap, 2048> points_;
  int count_ = 0;
  double weight_ = 1;   // square root of k_b / k_a
  bool apart_ = false;  // they have been, since both are held
  // Where friction holds each tool, as long as it holds it whole and the tools are near.  p_grid
  struct Rest {
    math::Pose at;
    bool known = false;
  } rests_a_, rests_b_;
};

}  // namespace burr::haptics
