// render/wound.h - what milling leaves on bone for a while: freshly cut faces, and water.
//
//     Wound wound(voxel);
//     each frame:   wound.see({t, tip, radius, removed, irrigated});   // as the servo told it
//                   wound.dress(scene, patch);                         // patches made anew
//                   wound.dress(scene, now);                           // ... and all others, at
//                   times
//
// A coarse grid around the tool, 64 x 64 x 64 cells; bone outside of it looks as ever. What is cut
// is fresh and dulls within kDulls; what coolant reaches is wet and dries within kDries. Of the
// surface, vertices near the grid's cells are dressed in its values: nothing of the bone itself is
// asked or changed. The same ticks give the same dress. Going back in time, everything is
// forgotten. Thread: one at a time. Frame: world. Units: SI. Memory: 2 MiB.
#pragma once

#include <optional>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/render/scene.h"

namespace burr::render {

class Wound {
 public:
  static constexpr double kDulls = 20, kDries = 40;  // until nothing is left of it   [s]
  static constexpr double kSoaks = 0.25;             // under the coolant             [s]
  static constexpr double kSpray = 5e-3;             // from the head's surface       [m]

  explicit Wound(double voxel);

  struct Tick {
    double t = 0;                         // of the session                [s]
    math::Vec3 tip = math::Vec3::Zero();  // centre of the head
    double radius = 0;                    // of the head
    double removed = 0;                   // since the start               [m^3]
    bool irrigated = false;
  };
  void see(const Tick& tick);
  void forget();
  // It has seen something that may show.
  [[nodiscard]] bool any() const { return !cells_.empty(); }

  // 0..1 at a place, as the vertices get it.
  struct State {
    float fresh = 0, wet = 0;
  };
  [[nodiscard]] State at(const math::Vec3& p) const;

  // One patch as it should look now.
  void dress(Scene& scene, int patch) const;
  // All of them, at most every scene.quality.dress_s; now: any clock [s].
  void renew(Scene& scene, double now);
  // All of them at once, for a still.
  void dress(Scene& scene) const;

 private:
  void centre(const math::Vec3& p);
  void dull(double seconds);
  void soak_and_cut(const Tick& tick, double seconds, bool cut);
  template <class Change>
  void each_near(const math::Vec3& a, const math::Vec3& b, double reach, const Change& change);
  [[nodiscard]] std::size_t index(int i, int j, int k) const;
  [[nodiscard]] math::Aabb touched() const;

  double cell_ = 0;
  std::vector<State> cells_;             // (64 x 64 x 64), x fastest; empty: nothing yet
  math::Ijk first_ = math::Ijk::Zero();  // cell of the world that is cells_[0]
  math::Ijk low_ = math::Ijk::Zero(), high_ = math::Ijk::Zero();  // [low, high) may hold something
  std::optional<Tick> last_;
  double dressed_at_ = -1e9;
};

}  // namespace burr::render
