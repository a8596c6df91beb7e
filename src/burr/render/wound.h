// render/wound.h - what milling leaves on bone for a while: freshly cut faces, water, bone dust and
// blood.
//
//     Wound wound(voxel, bleeding_of(bone.tissues()));
//     each frame:   wound.see({t, tip, up, radius, removed, added, irrigated});  // a tick
//                   wound.dress(scene, patch);                            // patches made anew
//                   wound.renew(scene, now);                              // ... and all, at times
//
// A coarse grid around the tool, 64 x 64 x 64 cells; bone outside of it looks as ever.
//   fresh   what is cut, dulls within kDulls
//   wet     what coolant reaches, dries within kDries
//   dust    of what is cut dry hangs in the air, settles within kStrews of the tool on what faces
//           up, and is washed away by coolant; the burr sweeps its own cut clean
//   blood   comes where a tissue that bleeds has been opened, runs from cell to cell along the
//           surface, downwards rather than up, dries; coolant washes it away and it comes again,
//           less and less (kClots). What is laid on it, wax or cement, stops it
// To be looked at, not measured: rates are choices, and nothing of the bone is asked or changed.
// Blood takes its way from the patches it is shown on; all else is the same for the same ticks.
// Going back in time, everything is forgotten.
// Thread: one at a time. Frame: world. Units: SI. Memory: 7 MiB.
#pragma once

#include <optional>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/render/scene.h"
#include "burr/volume/tissue.h"

namespace burr::render {

// Per tissue id, 0..1.
[[nodiscard]] std::vector<float> bleeding_of(const volume::TissueTable& tissues);

class Wound {
 public:
  static constexpr double kDulls = 20, kDries = 40;  // until nothing is left of it      [s]
  static constexpr double kSoaks = 0.25;             // under the coolant                [s]
  static constexpr double kSpray = 5e-3;             // from the head's surface          [m]
  static constexpr double kSolid = 0.4;              // of dust that lies: the rest is air
  static constexpr double kSettles = 0.5;            // e-th part of it still in the air [s]
  static constexpr double kStrews = 6e-3;            // from the head's surface          [m]
  static constexpr double kCovers = 0.05e-3;         // thick, it hides all but an e-th  [m]
  static constexpr double kWashes = 0.3;             // e-th part left under coolant     [s]
  static constexpr double kDraws = 3e-3;             // from the tube's mouth, beyond its radius [m]
  static constexpr double kSucks = 0.15;             // e-th part left at the mouth      [s]
  static constexpr double kFills = 0.4;              // a cell, from a vessel in it      [s]
  static constexpr double kClots = 60;               // e-th part of the flow left       [s]
  static constexpr double kClears = 90;              // e-th part of the blood left      [s]

  explicit Wound(double voxel, std::vector<float> bleeding = {});

  struct Tick {
    double t = 0;                         // of the session                 [s]
    math::Vec3 tip = math::Vec3::Zero();  // centre of the head
    math::Vec3 up = math::Vec3::UnitZ();  // where the shaft leaves to: the first that cuts counts,
                                          // as the side the wound is seen from
    double radius = 0;                    // of the head
    double removed = 0, added = 0;        // since the start                [m^3]
    bool irrigated = false;
  };
  void see(const Tick& tick);
  // A suction tube's mouth was there for so long: water, dust and blood near it go.
  void suck(const math::Vec3& mouth, double radius, double seconds);
  void forget();
  // It has seen something that may show.
  [[nodiscard]] bool any() const { return !cells_.empty(); }

  // 0..1 at a place, as the vertices get it; dust: on what faces up.
  struct State {
    float fresh = 0, wet = 0, dust = 0, blood = 0;
  };
  [[nodiscard]] State at(const math::Vec3& p) const;
  [[nodiscard]] double in_the_air() const { return airborne_; }  // dust that has not settled [m^3]

  // One patch as it should look now; what it shows of opened tissue bleeds from now on.
  void dress(Scene& scene, int patch);
  // All of them, at most every scene.quality.dress_s; now: any clock [s].
  void renew(Scene& scene, double now);
  // All of them at once.
  void dress(Scene& scene);
  // All of them for a still: nothing was dressed while it bled, so a few seconds of that come
  // first.
  void dress_still(Scene& scene);

 private:
  struct Cell {
    State look;
    // from the swept surface of the tool, below 0 inside; as long as it is fresh  [cell]
    float off = kFar;
    float open = 0;     // how much it bleeds
    bool skin = false;  // holds a piece of surface
  };
  static constexpr float kFar = 4;
  static constexpr int kEdge = 64;  // cells along a side

  void centre(const math::Vec3& p);
  void dull(double seconds);
  void cut(const Tick& tick, const math::Vec3& from, double removed);
  void cover(const Tick& tick, const math::Vec3& from);
  void soak(const Tick& tick, const math::Vec3& from, double seconds);
  void settle(const Tick& tick, double seconds);
  void bleed(double seconds);
  void flow(double seconds);
  void look_at(const SkinMesh& mesh);
  template <class Change>
  void each_near(const math::Vec3& a, const math::Vec3& b, double reach, const Change& change);
  [[nodiscard]] Cell mean_at(const math::Vec3& p) const;
  [[nodiscard]] std::size_t index(int i, int j, int k) const;
  [[nodiscard]] math::Aabb touched() const;
  [[nodiscard]] bool reached(const ScenePatch& patch) const;

  double cell_ = 0, voxel_ = 0;
  std::vector<float> bleeding_;          // by tissue
  std::vector<Cell> cells_;              // (64 x 64 x 64), x fastest; empty: nothing yet
  math::Ijk first_ = math::Ijk::Zero();  // cell of the world that is cells_[0]
  math::Ijk low_ = math::Ijk::Zero(), high_ = math::Ijk::Zero();  // [low, high) may hold something
  std::optional<Tick> last_;
  std::optional<math::Vec3> up_;
  double airborne_ = 0;               // [m^3]
  bool bleeds_ = false;               // some cell is open
  double flowed_ = 0;                 // time the blood has not flowed yet  [s]
  std::vector<std::size_t> running_;  // cells, for flow()
  double dressed_at_ = -1e9;
};

}  // namespace burr::render
