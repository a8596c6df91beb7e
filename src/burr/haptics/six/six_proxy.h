// haptics/six/six_proxy.h - a tool of several parts that stays outside the bone while the hand may
// press it in and turn it: a place and a turn, six unknowns.
//
//     V = k_t |c - x|^2 / 2 + k_r |log(R Q^T)|^2 / 2      x, Q: hand    c, R: the tool
//
// The tool rests at the minimum of V over the free poses that a chain of short free moves reaches.
// Moves are measured as (p, L theta) with L^2 = k_r / k_t: then the wrench on the hand is the sum of
// the forces of the contacts, and V never rises when bone goes. Each move is the projection of the
// wanted one on the rows of all points of bone that it could reach (least_twist.h). Parts are convex,
// so a straight move between two free places is free; a turn by theta errs by theta^2 l / 2 at the
// lever l, so a turn is kept below 10 mrad and what it errs is taken back by the next move.
//
// Balls touch discs, and other parts points of the bone. An edge would hop from point to point, so the
// convex ones also touch the planes of the discs (row_kernel.h).
//
// With friction the tool rests where friction holds it, as near as may be to where it was a tick ago
// (six_friction.h); without it V is least.
//
// The coupling point c is the origin of the tool. Thread: servo. Frame: world in arguments and
// results. Memory: taken at construction. Formulas: docs/understand/touch_tools.md, "Six unknowns".
// Method: a proxy as in Ortega, Redon & Coquillart 2007; the solver is Goldfarb & Idnani 1983.
#pragma once

#include <array>
#include <memory>

#include "burr/haptics/six/least_twist.h"
#include "burr/haptics/six/row_kernel.h"
#include "burr/haptics/six/six_friction.h"
#include "burr/haptics/tool_contact.h"
#include "burr/math/pose.h"
#include "burr/rt/rt.h"
#include "burr/tool/tool.h"
#include "burr/volume/iso_vertices.h"

namespace burr::haptics {

struct SixSettings {
  double lever = 60e-3;          // L = sqrt(k_r / k_t)                                     [m]
  int max_moves = 12;            // in a tick
  double close = 1e-7;           // a move shorter than this ends the search                [m]
  double longest = 1e-3;         // of a move                                               [m]
  double most_turn = 10e-3;      // of a move                                             [rad]
  double push_out_speed = 5e-3;  // of bone that grew under the tool                 [voxel/tick]
  // Friction counts at most so many times the spring's length, as ProxySettings::wedge; 0: no limit
  double wedge = 2;
  bool planes =
      true;  // convex parts, but for balls and capsules, also touch the planes of the discs
};

struct SixTouch {
  math::Pose world_from_tool;
  math::Vec3 stretch = math::Vec3::Zero();  // c - x; the force is k_t times it    [m]
  math::Vec3 turn = math::Vec3::Zero();     // log(R Q^T); the torque about c is k_t L^2 times it
                                            // [rad]
  int active = 0;
  std::array<SixContact, 6> contacts;
  // The part of `stretch` and of `turn` with which friction holds the tool.
  math::Vec3 held = math::Vec3::Zero(), held_turn = math::Vec3::Zero();  // [m], [rad]
  bool stuck = false;                                                    // friction holds it
  int candidates = 0;
  int moves = 0;
  bool lagging = false;   // did not catch up with the hand
  bool overflow = false;  // more points than the lists hold: shorter moves were made
  // The tool rests on another one (two_tools.h), which is not among the contacts.
  bool meets = false;
  math::Vec3 pushed = math::Vec3::Zero();  // the part of the stretch that it carries  [m]
};

class SixProxy {
 public:
  SixProxy(const volume::IsoVertices& surface, const tool::Tool& tool, const SixSettings& settings,
           const math::Pose& hand);

  // True if no part that touches reaches into bone there.
  [[nodiscard]] bool is_free(const math::Pose& world_from_tool) BURR_RT;
  // Puts the tool there, free or not.
  void place(const math::Pose& world_from_tool) BURR_RT;
  // Takes another tool at the same pose, free or not.
  void take(const tool::Tool& tool) BURR_RT;
  // One tick: moves towards the hand as far as the bone allows.
  [[nodiscard]] SixTouch step(const math::Pose& hand) BURR_RT;
  [[nodiscard]] math::Pose pose() const BURR_RT;
  [[nodiscard]] const tool::Tool& tool() const BURR_RT { return tool_; }
  // Fewer moves take less time; the tool then lags behind a fast hand, but is never in bone.
  void set_max_moves(int moves) BURR_RT { settings_.max_moves = moves; }
  // Of the tool on the bone; 0: none.
  void set_friction(const Friction& friction) BURR_RT { friction_ = friction; }
  // Another spring of turning: L  [m]
  void set_lever(double lever) BURR_RT {
    settings_.lever = lever;
    lever_ = lever / grid_.voxel;
  }

 private:
  friend class TwoTools;
  // The points of bone near one part, valid as long as the tool moved little since.
  struct Near {
    std::unique_ptr<NearPoints> points;
    math::Vec3 centre = math::Vec3::Zero();    // c then  p_grid
    math::Quat turn = math::Quat::Identity();  // R then
    double reach = -1;                         // all points nearer than this are in it [voxel]
    math::Pose last;                           // c and R of the last look at them
    double way = 0;                            // NearPoints::way
    std::uint64_t revision = 0;
  };
  struct Limits {
    double move, turn;  // [voxel], [rad]
  };

  [[nodiscard]] static std::size_t index(int part) { return static_cast<std::size_t>(part); }
  [[nodiscard]] PartThere there(int part) const BURR_RT;
  [[nodiscard]] bool look_around(int part, double reach) BURR_RT;
  [[nodiscard]] bool look_into(int part, const PartThere& at, const math::Ijk& super,
                               double reach) BURR_RT;
  [[nodiscard]] bool still_holds(int part, double need) const BURR_RT;
  [[nodiscard]] double most_lever(int part) const BURR_RT;
  void note_way(int part) BURR_RT;
  // planes: false leaves out those of the discs
  [[nodiscard]] bool collect(const Limits& limits, bool planes = true) BURR_RT;
  [[nodiscard]] double plane_reach(int part) const BURR_RT;
  // Not while friction holds it: on rows whose normals differ by grains a box would creep down its slope.
  [[nodiscard]] bool touches_planes(int part) const BURR_RT {
    return planes_[index(part)] && !(friction_.sticks > 0);
  }
  [[nodiscard]] Six wanted(const math::Vec3& x, const math::Quat& q) const BURR_RT;
  [[nodiscard]] LeastTwist solve(const Six& wanted) BURR_RT;
  [[nodiscard]] LeastTwist move(const Six& wanted, Limits& guess, bool& cut_short,
                                SixTouch& touch) BURR_RT;
  [[nodiscard]] math::Vec3 arm_of(int part, const math::Vec3& normal, const math::Vec3& across,
                                  double gap) const BURR_RT;
  void go(const Six& z) BURR_RT;
  void rub(const LeastTwist& last, const math::Pose& before, const math::Vec3& x,
           const math::Quat& q, SixTouch& touch) BURR_RT;
  [[nodiscard]] bool press(const LeastTwist& last, const Six& wanted) BURR_RT;
  void report(const LeastTwist& last, const math::Vec3& x, const math::Quat& q,
              SixTouch& touch) const BURR_RT;

  const volume::IsoVertices& surface_;
  volume::Grid grid_;
  SixSettings settings_;
  RowKernel kernel_;
  tool::Tool tool_;
  std::array<tool::Shape, tool::Tool::kMostParts> shape_;  // [voxel]
  std::array<double, tool::Tool::kMostParts> far_{};       // reach of a part from c [voxel]
  std::array<bool, tool::Tool::kMostParts> planes_{};      // it touches planes
  bool any_planes_ = false;
  double lever_ = 0;  // L [voxel]
  Limits most_{};
  math::Vec3 c_ = math::Vec3::Zero();      // p_grid
  math::Quat r_ = math::Quat::Identity();  // grid_from_tool
  Limits last_{};                          // guess for the first move of the next tick
  std::array<Near, tool::Tool::kMostParts> near_;
  std::array<int, tool::Tool::kMostParts + 1> first_row_{};  // of each part
  std::unique_ptr<Rows> rows_;
  Friction friction_;
  Grip grip_;  // of the last tick
  std::unique_ptr<Rows> places_;
  std::unique_ptr<Pressed> pressed_;
};

}  // namespace burr::haptics
