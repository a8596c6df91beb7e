// render/chips.h - chips of bone that an edge throws (chisel, gouge, curette), where dust is too fine to be
// what it makes. They fly a little way, lie on the bone, and go with suction, coolant and undo.
//
//     Chips chips;
//     chips.throw_from({t, place, forward, edge, up}, removed);   // each tick in which it cut
//     chips.lie(scene, t);                                        // before a picture
//
// For the eye, as all of render/wound.h: how many, how large and where is chosen, not measured. Together the
// chips have the volume that was removed, up to one chip; the oldest go when there are more than kMost.
// The same ticks give the same chips. Thread: one at a time. Frame: world. Units: SI. Memory: 0.5 MB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/math/pose.h"
#include "burr/math/vec3.h"
#include "burr/render/scene.h"

namespace burr::render {

class Chips {
 public:
  static constexpr double kVolume = 0.15e-9;  // of the usual chip [m^3]
  static constexpr std::size_t kMost = 80;
  static constexpr double kFlight = 0.35;  // until it lies [s]
  static constexpr double kRinse = 3;      // under coolant, until it is gone [s]

  struct Edge {
    double t = 0;
    math::Vec3 middle = math::Vec3::Zero();    // of the edge
    math::Vec3 forward = math::Vec3::UnitZ();  // in which it cuts
    math::Vec3 half = math::Vec3::Zero();      // from its middle to an end
    math::Vec3 up = math::Vec3::UnitZ();       // towards the hand
  };
  // What was removed since the last call, all of it chips. [m^3]
  void throw_from(const Edge& edge, double removed);
  // Chips within reach of a mouth, or of coolant for so long, go.
  void suck(const math::Vec3& mouth, double reach);
  void rinse(const math::Vec3& at, double reach, double seconds);
  // Chips that were thrown after t were never thrown.
  void back_to(double t);
  void forget() {
    chips_.clear();
    left_ = 0;
    count_ = 0;
  }

  // Puts them into the scene as they are at t: in the air, or on the surface of its patches under them.
  // A chip under which no surface is within kDeep has fallen out of the wound.
  void lie(Scene& scene, double t);
  static constexpr double kDeep = 12e-3;  // [m]

  struct Chip {
    double t = 0;                                                     // when it was thrown
    math::Vec3 from = math::Vec3::Zero(), over = math::Vec3::Zero();  // begins, comes down above
    math::Vec3 up = math::Vec3::UnitZ();
    math::Vec3 at = math::Vec3::Zero();     // now
    math::Quat q = math::Quat::Identity();  // its length along x, its thickness along z
    math::Vec3 size = math::Vec3::Zero();   // length, width, thickness [m]
    double turn = 0;                        // about up
    double rinsed = 0;                      // [s]
    bool lies = false;
  };
  [[nodiscard]] const std::vector<Chip>& all() const { return chips_; }

 private:
  std::vector<Chip> chips_;  // the oldest first
  double left_ = 0;          // removed, and not yet a chip [m^3]
  std::uint32_t count_ = 0;  // thrown so far
  bool shown_ = false;
};

}  // namespace burr::render
