// surgeon/step_work.h - one step of a case in which bone is cut away: what is still to be removed,
// where the next stroke begins, and with which burr.
//
// A node of the goal counts as long as its voxel is bone, its goal is at least kSkin, and the
// smallest burr of this surgeon gets there. Where that burr is too wide for nearly all of the plan,
// the surgeon takes a smaller one: nobody calls a groove done that no burr has touched. The next
// stroke begins where
//
//     goal, mean over 2 mm  +  saucer x height / 2  -  0.3 way  +  a bonus for the burr in the hand
//
// is largest (all in mm) among the nodes at the surface that lie open towards the surgeon; ties are
// broken at random.
//
// Frame: world. Units: SI. Thread: the one that cuts, between two ticks. Cost: some 0.3 ms a call
// for a mastoid, since only what lies near the burr is read again.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "burr/people/random_stream.h"
#include "burr/scenario/lesson.h"
#include "burr/surgeon/plan.h"
#include "burr/surgeon/skill.h"
#include "burr/surgeon/surgeon_work.h"
#include "burr/volume/bone.h"

namespace burr::surgeon {

inline constexpr double kSkin = 0.2e-3;  // what is left of the goal at the end counts as done [m]

class StepWork final : public Work {
 public:
  // goal: of this step. allowed: of this step and those before it, where the burr may go. Everything
  // but bone and goal must outlive this. case_diameter: of the case's burr [m].
  StepWork(const volume::Bone& bone, const scenario::Step& step, const scenario::CaseLesson& lesson,
           const FieldGrid& goal, const FieldGrid& allowed, const Spare& spare, const Skill& skill,
           double case_diameter);

  [[nodiscard]] double left() const override;
  [[nodiscard]] std::size_t remaining() const override { return left_; }
  void look(const volume::Bone& bone, const math::Vec3& hand) override;
  [[nodiscard]] bool exhausted() const override { return exhausted_; }
  // Nodes of the whole plan.
  [[nodiscard]] std::size_t count() const { return all_; }
  [[nodiscard]] std::optional<NextStroke> next(const volume::Bone& bone, const math::Vec3& hand,
                                               const HeldBurr& held,
                                               people::RandomStream& random) override;

 private:
  struct Node {
    math::Vec3f at;  // world [m]
    math::Ijk voxel;
    float goal, near;      // [m]
    std::uint32_t cell;    // of 2 mm
    std::uint32_t banned;  // until this call of next()
    std::uint32_t tries;   // strokes that began here with this burr
    bool there, surface;
  };
  void look(const volume::Bone& bone, Node& node) const;
  [[nodiscard]] HeldBurr burr_for(double near) const;
  [[nodiscard]] std::optional<math::Vec3> place_for(const math::Vec3& q, const math::Vec3& out,
                                                    double radius) const;
  [[nodiscard]] std::optional<NextStroke> stroke_at(const volume::Bone& bone, const Node& node,
                                                    const math::Vec3& hand, const HeldBurr& held,
                                                    people::RandomStream& random) const;
  [[nodiscard]] math::Vec3 direction(const math::Vec3& q, const math::Vec3& into,
                                     people::RandomStream& random) const;
  [[nodiscard]] math::Vec3 above_bone(const volume::Bone& bone, const math::Vec3& p,
                                      const math::Vec3& from, const math::Vec3& up,
                                      double radius) const;
  [[nodiscard]] bool is_way_out(const math::Vec3& p, const math::Vec3& out, double radius) const;
  void set_way(const volume::Bone& bone, const math::Vec3& hand, NextStroke& next) const;
  [[nodiscard]] std::size_t best(const math::Vec3& hand, const HeldBurr& held,
                                 people::RandomStream& random);
  void smooth();
  void take_nodes(const volume::Bone& bone, const FieldGrid& goal);

  const scenario::Step& step_;
  const scenario::CaseLesson& lesson_;
  const FieldGrid& allowed_;
  const Spare& spare_;
  Skill skill_;
  double case_diameter_, voxel_;
  double smallest_;  // the least burr of this surgeon over that of the case
  std::vector<math::Vec3> approach_;
  std::vector<Node> nodes_;
  std::vector<float> sum_;  // (cells) of the goal at the surface [m]
  std::vector<std::uint32_t> many_;
  double top_ = 0;  // of the plan, towards the surgeon [m]
  double fit_ = 1;  // share of the policy's burr that is taken now
  std::size_t all_ = 0, left_ = 0, left_then_ = 0;
  std::uint32_t calls_ = 0, calls_then_ = 0;
  bool exhausted_ = false;
};

}  // namespace burr::surgeon
