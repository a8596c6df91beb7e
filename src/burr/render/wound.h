// render/wound.h - what milling leaves on bone for a while: freshly cut faces, water, bone dust and
// blood.
//
//     Wound wound(voxel, bleeding_of(bone.tissues()));
//     each frame:   wound.see({t, tip, up, radius, removed, added, irrigated});  // a tick
//                   wound.stain(scene, patch);                       // new patches
//                   wound.renew(scene, now);                         // all patches, now and then
//
// A coarse grid around the tool, 64 x 64 x 64 cells; bone outside of it keeps its usual look.
//   fresh   bone that was just cut; fades within kDullTime
//   wet     bone that coolant reaches; dries within kDryTime
//   dust   bone that is cut dry goes into the air as dust and settles within kDustReach of the tool
//           on faces that point up; the burr sweeps its own cut clean. A tool that turns throws it to
//           all sides, a saw along its stroke (kAlong, kAcross); a chisel or curette makes chips
//           (render/chips.h), and no dust. Coolant makes a paste of it, which lies on steeper faces too and
//           runs down; coolant slowly rinses it away
//   ridges  fine parallel ridges where a fluted burr cut, across its way; a diamond burr polishes them
//           away. They stay
//   blood   comes where a bleeding tissue was opened, runs from cell to cell along the surface,
//           downwards rather than up, and dries; coolant washes it away and it comes again, less
//           and less (kClotTime). Wax or cement on it stops it
// These are for the eye, not for measurement: the rates are choices, and nothing in the bone is
// changed. Where blood runs depends on the patches it is shown on; all else is the same for the
// same ticks. Going back in time clears everything.
// When a stroke is undone, all this is as it was before that stroke, for the last kStrokes of them;
// older ones take everything with them but the water. A redo does not bring it again.
// Thread: one at a time. Frame: world. Units: SI. Memory: 12 MiB, and as much at most for strokes.
#pragma once

#include <optional>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/render/chips.h"
#include "burr/render/scene.h"
#include "burr/volume/tissue.h"

namespace burr::render {

// How strongly each tissue bleeds, per tissue id, 0..1.
[[nodiscard]] std::vector<float> bleeding_of(const volume::TissueTable& tissues);

class Wound {
 public:
  static constexpr double kDullTime = 20, kDryTime = 40;  // until it is gone completely [s]
  static constexpr double kSoakTime = 0.25;               // until wet under the coolant [s]
  static constexpr double kSprayReach = 5e-3;  // reach of the coolant from the head's surface
                                               // [m]
  static constexpr double kSolidShare = 0.4;   // solid share of dust at rest: the rest is air
  static constexpr double kSettleTime = 0.5;   // until 1/e of it is still in the air [s]
  static constexpr double kDustReach = 6e-3;   // reach of the dust from the head's surface
                                               // [m]
  static constexpr double kAlong = 1.8, kAcross = 0.45;  // of that reach: of a saw
  // thickness that hides all but 1/e of the bone [m]
  static constexpr double kCoverThickness = 0.05e-3;
  static constexpr double kWashTime = 0.3;    // until 1/e of blood is left under coolant [s]
  static constexpr double kRinseTime = 4;     // the same of dust, which is a paste then [s]
  static constexpr double kPasteShare = 0.4;  // of dust made under coolant; the rest goes with it
  static constexpr double kPasteTime = 1.5;   // until 1/e has run on where it is steep [s]
  static constexpr double kSuctionReach = 3e-3;  // reach of suction from the tube's mouth,
                                                 // beyond its radius [m]
  static constexpr double kSuctionTime = 0.15;   // until 1/e is left at the mouth [s]
  static constexpr double kFillTime = 0.4;       // time to fill a cell that contains an open
                                                 // vessel [s]
  static constexpr double kClotTime = 60;        // until the flow is 1/e [s]
  static constexpr std::size_t kStrokes = 32;    // whose traces an undo can take away
  static constexpr double kStrokePause = 0.25;   // a longer pause in the cut begins another [s]
  static constexpr double kClearTime = 90;       // until 1/e of the blood is left [s]

  explicit Wound(double voxel, std::vector<float> bleeding = {});

  struct Tick {
    double t = 0;                         // of the session [s]
    math::Vec3 tip = math::Vec3::Zero();  // centre of the head
    math::Vec3 up = math::Vec3::UnitZ();  // direction of the shaft; that of the first cut is taken
                                          // as the side from which the wound is seen
    double radius = 0;                    // of the head
    double removed = 0, added = 0;        // since the start [m^3]
    bool irrigated = false;
    double undone = 0;                       // of `removed`, brought back since the start [m^3]
    bool diamond = false;                    // the burr has grit in place of flutes
    double others = 0;                       // of `removed`, by the tool of the other hand; may be
                                             // that of a later tick, of an earlier one not  [m^3]
    double dust = 1;                         // share of what it removes that flies as dust
    math::Vec3 stroke = math::Vec3::Zero();  // of a blade, unit; 0: it turns
    // What it removes comes off as chips: from the edge's middle to its end; and in which it cuts, unit
    bool chips = false;
    math::Vec3 edge = math::Vec3::Zero(), forward = math::Vec3::UnitZ();
  };
  void see(const Tick& tick);
  // The tool of the other hand at that time, after see(): what it cuts is fresh, and dust lies about
  // it. removed: by it alone; up, added, irrigated, undone, others are not used.
  void see_beside(const Tick& tick);
  // A suction tube's mouth was at this place for so long: water, dust and blood near it are
  // removed, and dust in the air if the tool is near.
  void suck(const math::Vec3& mouth, double radius, double seconds);
  void forget();
  // True: there may be something to show.
  [[nodiscard]] bool any() const { return !cells_.empty(); }

  // 0..1 at a place, as the vertices get it; dust: on faces that point up.
  struct State {
    float fresh = 0, wet = 0, dust = 0, blood = 0;
  };
  [[nodiscard]] State at(const math::Vec3& p) const;
  // dust that has not settled [m^3]
  [[nodiscard]] double in_the_air() const { return first_tool_.airborne + other_tool_.airborne; }

  // Gives a patch its present look; opened tissue that it shows bleeds from now on.
  void stain(Scene& scene, int patch);
  // All patches, at most every scene.quality.stain_s; now: any clock [s].
  void renew(Scene& scene, double now);
  // All patches at once.
  void stain(Scene& scene);
  // All patches for a still picture. No patch was stained while blood ran, so it first lets blood
  // run for a few seconds.
  void stain_still(Scene& scene);
  [[nodiscard]] const Chips& chips() const { return chips_; }

 private:
  struct Cell {
    State look;
    // distance from the swept surface of the tool, below 0 inside; while it is fresh [cell]
    float off = kFar;
    float open = 0;     // how much it bleeds
    bool skin = false;  // holds a piece of surface
    // ridges: their height, 0..1; how far along its path the burr was at p: along + way . p  [m]
    float ridges = 0, along = 0;
    math::Vec3f way = math::Vec3f::Zero();
  };
  [[nodiscard]] std::uint32_t ridges_at(const math::Vec3& p, float height) const;
  static constexpr float kFar = 4;
  static constexpr int kEdge = 64;  // cells along a side

  // What there was before a stroke.
  struct Before {
    double net = 0;           // removed and not undone at that time [m^3]
    double t = 0;             // [s]
    math::Ijk low, high;      // cells of the world, [low, high)
    std::vector<Cell> cells;  // of that box
  };

  // A tool, and what it throws.
  struct Source {
    std::optional<Tick> last;
    double along = 0;     // length of its path while it cut [m]
    double airborne = 0;  // [m^3]
  };

  void centre(const math::Vec3& p);
  [[nodiscard]] double own_cut(const Tick& tick);
  void begin_stroke();
  void undo(const Tick& tick);
  void dull(double seconds);
  void cut(Source& source, const Tick& tick, const math::Vec3& from, double removed);
  void cover(const Tick& tick, const math::Vec3& from);
  void soak(const Tick& tick, const math::Vec3& from, double seconds);
  void settle(Source& source, const Tick& tick, double seconds);
  void bleed(double seconds);
  void flow(double seconds);
  void run_paste(double seconds);
  void look_at(const SkinMesh& mesh);
  template <class Change>
  void each_near(const math::Vec3& a, const math::Vec3& b, double reach, const Change& change);
  [[nodiscard]] Cell mean_at(const math::Vec3& p) const;
  [[nodiscard]] std::size_t index(int i, int j, int k) const;
  [[nodiscard]] math::Aabb touched() const;
  [[nodiscard]] bool reached(const ScenePatch& patch) const;

  double cell_ = 0, voxel_ = 0;
  std::vector<float> bleeding_;          // by tissue
  std::vector<Cell> cells_;              // (64 x 64 x 64), x fastest; empty: nothing has happened
  math::Ijk first_ = math::Ijk::Zero();  // cell of the world that is cells_[0]
  math::Ijk low_ = math::Ijk::Zero(), high_ = math::Ijk::Zero();  // only [low, high) may hold
                                                                  // something
  Source first_tool_, other_tool_;
  Chips chips_;
  double own_ = 0;              // the most that the first tool removed so far [m^3]
  double cut_at_ = -1e9;        // when something was removed last [s]
  std::vector<Before> before_;  // strokes, the oldest first
  std::optional<math::Vec3> up_;
  bool bleeds_ = false;               // some cell is open
  bool pasty_ = false;                // some cell may hold a paste
  double flowed_ = 0;                 // time for which blood and paste must still be moved [s]
  std::vector<std::size_t> running_;  // cells, for flow()
  double stained_at_ = -1e9;
};

}  // namespace burr::render
