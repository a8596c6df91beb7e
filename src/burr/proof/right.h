// proof/right.h - what an item of a rubric must say of a known bone, worked out from the shapes that cut it.
//
//     {"bed.width", 0, kWidth}                                        0 mm off, to the tolerance of a width
//     {"bed.cleared", share_gone("cap on implant_axis 0 0 0 on implant_axis 8 0 0 2"), kShare}
//     {"teeth.intact", kUnmet}                                        the verdict alone follows
//
// A value is in the unit that people read: mm, degrees, mm2, mm3, or a share. Where it lies farther from the item's threshold than
// its tolerance, the verdict follows from it. What a function here needs of the bone before the cut is which places were solid;
// it asks no region and no measure, and sums over a lattice of its own. Thread: any.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "burr/math/vec3.h"
#include "burr/proof/known_shape.h"
#include "burr/scoring/outcome.h"
#include "burr/volume/bone.h"

namespace burr::proof {

// A known bone, as the right values see it.
struct KnownScene {
  const volume::Bone& before;
  const Places& places;
  const Work& work;  // the shapes of its line

  [[nodiscard]] double voxel_mm() const { return before.grid().voxel * 1e3; }
};
// NaN: a line of the table cannot be read.
using RightValue = std::function<double(const KnownScene&)>;

// How far from the right value a measure may be: so much, and so many voxels; `stated`: or the error that the outcome states, if
// that is more. The figures are those of docs/teach/metrics_tests.md.
struct Tolerance {
  double fixed = 0, voxels = 0;
  bool stated = false;
};
inline constexpr Tolerance kWidth{0.05, 0.1};   // of an axis [mm]
inline constexpr Tolerance kEntry{0.05, 0.25};  // a place across an axis [mm]
inline constexpr Tolerance kDepth{
    0, 0.5};  // half a voxel: where an end lies, how near something is [mm]
inline constexpr Tolerance kGap{
    0.05, 0.5};  // least distance; 0.05 for the lattice of the right value [mm]
inline constexpr Tolerance kAngle{0.5, 0};     // [degrees]
inline constexpr Tolerance kPlane{0.02, 0.1};  // offset and evenness of a plane [mm]
inline constexpr Tolerance kPlaneAngle{0.2, 0};
inline constexpr Tolerance kCavity{0.05, 0.1};  // depth of a cavity [mm]
inline constexpr Tolerance kFloor{0.03, 0};     // rms of its floor [mm]
inline constexpr Tolerance kOutline{0.1, 0.3};  // its rim [mm]
inline constexpr Tolerance kShare{0.01, 0};     // of a region
inline constexpr Tolerance kTrace{0.003, 0};    // of a large region that the cut hardly reaches
inline constexpr Tolerance kBorder{0.02, 0,
                                   true};   // the same where the cut ends at the region's border
inline constexpr Tolerance kHole{0.35, 0};  // a hole in a plate [mm2]
inline constexpr Tolerance kWay{0, 0.75};   // radius of a way [mm]

inline constexpr Tolerance kVolume{
    0.05, 0.8};  // cut out of a structure by a ball of up to a millimetre [mm3]
inline constexpr Tolerance kBreach{0, 0.5};  // of a screw [mm]

// What an item must say.
struct Right {
  std::string item;
  std::optional<scoring::Verdict> verdict;  // none: it follows from the value, or not at all
  RightValue value;                         // empty: the verdict alone
  Tolerance tolerance = {};

  Right(std::string id, scoring::Verdict must) : item(std::move(id)), verdict(must) {}
  Right(std::string id, double must, Tolerance within)
      : item(std::move(id)), value([must](const KnownScene&) { return must; }), tolerance(within) {}
  Right(std::string id, RightValue must, Tolerance within)
      : item(std::move(id)), value(std::move(must)), tolerance(within) {}
};
inline constexpr scoring::Verdict kMet = scoring::Verdict::met, kUnmet = scoring::Verdict::unmet;

// The regions here are lines of known_shape.h: what they cut is the region.

// Share of the bone in a region that the shapes cut.
[[nodiscard]] RightValue share_gone(std::string region);
// Share of the air in a region that the shapes fill; share of what they fill that lies outside of a region.
[[nodiscard]] RightValue share_filled(std::string region);
[[nodiscard]] RightValue share_beside(std::string region);
// Volume of bone in a region that the shapes cut [mm3].
[[nodiscard]] RightValue volume_gone(std::string region);

// Distance of a place from a structure, by a formula that the table gives [mm].
using ApartMm = std::function<double(const Places&, const math::Vec3& p_mm)>;
// From a tube of that radius along the curve of a landmark.
[[nodiscard]] ApartMm from_tube(std::string landmark, double radius_mm);
// From an upright oval cylinder about (0, y) [mm].
[[nodiscard]] ApartMm from_oval(double y, double half_x, double half_y);
// The least of it over the border of what the shapes cut, in bone and in a region [mm]. far: no nearer place counts as this far.
[[nodiscard]] RightValue least_gap(std::string region, ApartMm apart, double far);

// Median over a region of how much bone lay along z over a floor at that height, less so much; above or below 0 counts alike [mm].
[[nodiscard]] RightValue median_above(std::string region, double floor_z, double less);

}  // namespace burr::proof
