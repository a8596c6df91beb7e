// surgeon/surgeon_work.h - one step of a case in a surgeon's eyes: how much of it is left, and where the next
// stroke begins, with which burr. step_work.h cuts bone away, fill_work.h adds material.
//
// Frame: world. Units: SI. Thread: the one that runs the ticks, between two of them.
#pragma once

#include <cstddef>
#include <optional>

#include "burr/people/random_stream.h"
#include "burr/surgeon/surgeon_hand.h"
#include "burr/tool/burr_tool.h"
#include "burr/volume/bone.h"

namespace burr::surgeon {

struct HeldBurr {
  double radius = 1e-3;  // [m]
  tool::BurrKind kind = tool::BurrKind::cutting;
  [[nodiscard]] bool operator==(const HeldBurr&) const = default;
};

struct NextStroke {
  Stroke stroke;  // its way is for a burr that is `held` already
  HeldBurr burr;
  math::Vec3 at = math::Vec3::Zero();   // of the bone's surface
  math::Vec3 out = math::Vec3::Zero();  // unit, the way out that is free
};

class Work {
 public:
  Work() = default;
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;
  virtual ~Work() = default;

  // Share of the plan that is still to be done; 0 for an empty plan.
  [[nodiscard]] virtual double left() const = 0;
  // Nodes that are still to be done.
  [[nodiscard]] virtual std::size_t remaining() const = 0;
  // Looks at the bone again around the hand.
  virtual void look(const volume::Bone& bone, const math::Vec3& hand) = 0;
  // True: no burr of this surgeon reaches what is left.
  [[nodiscard]] virtual bool exhausted() const = 0;
  // Nothing: exhausted(), or no place was found yet; ask again.
  [[nodiscard]] virtual std::optional<NextStroke> next(const volume::Bone& bone,
                                                       const math::Vec3& hand, const HeldBurr& held,
                                                       people::RandomStream& random) = 0;
};

}  // namespace burr::surgeon
