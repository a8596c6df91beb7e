// surgeon/fill_work.h - one step of a case in which a gap is filled: what is still empty, and where the
// next stroke begins.
//
// A node of the gap counts as long as its voxel is empty and lies at least kSkin below the gap's
// border: what it is believed to be, less what must stay free. The next stroke begins on the
// surface under the deepest empty nodes, seen along the way out, at a short way from the hand; so the
// gap fills from its floor in layers. The hand lifts where the place at which the burr touches has
// come up to the border towards the surgeon (SurgeonHand::look_at): the floor and the walls of a gap
// are no border for that, so they are the gap's depth nearer to the surgeon, or 0. A place where the
// burr, let down, would rest on material that is level with the border is left to a smaller burr; a
// place that was tried waits twice as long each time, so that no pit keeps the hand from the rest.
//
// Frame: world. Units: SI. Thread: the one that runs the ticks, between two of them. Cost: a pass over
// the nodes of the gap a call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "burr/scenario/lesson.h"
#include "burr/surgeon/plan.h"
#include "burr/surgeon/skill.h"
#include "burr/surgeon/surgeon_work.h"

namespace burr::surgeon {

// What is to be filled in a step, as this surgeon believes it.
struct Filling {
  // depth below the border of the region and outside of all that must stay whole
  FieldGrid gap;
  // the largest such depth here and straight ahead on the way out: how far material may still rise
  FieldGrid rise;
};
// out: unit, to the surgeon.
[[nodiscard]] Filling filling_of(const scenario::CaseRegion& region, const Believed& believed,
                                 const Spare& spare, const math::Vec3& out);

class FillWork final : public Work {
 public:
  // plan must outlive this. out: unit, to the surgeon. case_diameter: of the case's burr [m].
  FillWork(const volume::Bone& bone, const scenario::Step& step, const Filling& plan,
           const math::Vec3& out, const Skill& skill, double case_diameter);

  [[nodiscard]] double left() const override;
  [[nodiscard]] std::size_t remaining() const override { return nodes_.size(); }
  void look(const volume::Bone& bone, const math::Vec3& hand) override;
  [[nodiscard]] bool exhausted() const override { return exhausted_; }
  [[nodiscard]] std::optional<NextStroke> next(const volume::Bone& bone, const math::Vec3& hand,
                                               const HeldBurr& held,
                                               people::RandomStream& random) override;

 private:
  struct Node {
    math::Vec3 at;  // world [m]
    math::Ijk voxel;
    std::uint32_t banned;  // until this call of next()
    std::uint32_t tries;
  };
  [[nodiscard]] bool on_surface(const volume::Bone& bone, const Node& node) const;
  [[nodiscard]] bool reaches(const volume::Bone& bone, const Node& node) const;
  [[nodiscard]] std::size_t best(const volume::Bone& bone, const math::Vec3& hand, double luck);
  bool take_smaller();
  [[nodiscard]] NextStroke stroke_at(const volume::Bone& bone, const Node& node,
                                     people::RandomStream& random) const;

  const Filling& plan_;
  Skill skill_;
  math::Vec3 out_;
  HeldBurr burr_;
  double smallest_ = 0;      // radius of the least burr that is taken [m]
  std::vector<Node> nodes_;  // empty still
  std::size_t all_ = 0, left_then_ = 0;
  std::uint32_t calls_ = 0, calls_then_ = 0;
  bool exhausted_ = false;
};

}  // namespace burr::surgeon
