// proof/known_shape.h - shapes by their own formulas, and the line of text that cuts a bone with them. They share nothing with the
// regions and measures of burr, so what a bone cut by them must score follows from the numbers in the line.
//
//     auto work = proof::read_work("cyl 0 0 5 0 0 -11.2 2 ; - ball 3 0 -4 1", places);
//     work->gone(p_mm)      // how deep p lies in what is cut away
//
// A shape is one of
//     cyl A B r      flat ends        cap A B r    round ends       ball A r
//     box A sx sy sz edges along the axes of the world              half nx ny nz d   all p with n . p > d
//     plane NAME d   all that lies more than d beyond the plane of a landmark, where its normal points
//     slab NAME a b  from a to b beyond that plane                  tube NAME r       along the curve of a landmark
// or several of them joined by "&": what lies in all of them. A point A is
//     x y z                  in the world
//     at NAME x y z          so far from the first point of a landmark, along the axes of the world
//     of NAME t x y z        so far from the place at t (0..1) of the length of its curve
//     on NAME s u v          s along the line from its first point to its last, u and v to the sides (Frame)
// In NAME "_" stands for a space. Shapes stand between ";": all are cut. Before a shape "-": kept, whatever is cut; "!": cut,
// whatever is kept; "+": bone is added there after the cut.
//
// Units: mm, LPS, as people type them. Every depth is positive inside and changes by at most 1 mm a millimetre. Thread: any.
// Errors: one sentence with the shape, what is wrong and what it needs.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/scenario/lesson.h"

namespace burr::proof {

using DepthMm = std::function<double(const math::Vec3& p_mm)>;  // positive inside

// A landmark as the shapes need it.
struct PlaceMm {
  std::vector<math::Vec3> points;    // [mm]
  std::optional<math::Vec3> normal;  // unit
};
using Places = std::map<std::string, PlaceMm, std::less<>>;
// lesson: with its landmarks placed.
[[nodiscard]] Places places_of(const scenario::CaseLesson& lesson);

// The line from the first point of a landmark to its last. u: the world's x axis made square to it, or the y axis where the line
// runs along x; v = u x along.
struct Frame {
  math::Vec3 from = math::Vec3::Zero();  // [mm]
  math::Vec3 along, u, v;                // unit
  [[nodiscard]] math::Vec3 at(double s, double side_u, double side_v) const {
    return from + s * along + side_u * u + side_v * v;
  }
};
[[nodiscard]] Frame frame_of(const math::Vec3& from_mm, const math::Vec3& to_mm);

[[nodiscard]] double to_segment_mm(const math::Vec3& p, const math::Vec3& a, const math::Vec3& b);
[[nodiscard]] DepthMm cylinder(const math::Vec3& a, const math::Vec3& b, double radius);
[[nodiscard]] DepthMm ball(const math::Vec3& at, double radius);
[[nodiscard]] DepthMm box(const math::Vec3& middle, const math::Vec3& size);
[[nodiscard]] DepthMm half_space(const math::Vec3& unit_normal, double d);
// Round ends; two points: a capsule.
[[nodiscard]] DepthMm tube(std::vector<math::Vec3> course, double radius);

struct Work {
  std::vector<DepthMm> cut, kept, holes, added;
  // How deep a point lies in what is cut away, and in what is added; far below 0 where there is nothing of the kind.
  [[nodiscard]] double gone(const math::Vec3& p_mm) const;
  [[nodiscard]] double grown(const math::Vec3& p_mm) const;
};

// An empty text cuts nothing.
[[nodiscard]] Result<Work> read_work(std::string_view text, const Places& places);

}  // namespace burr::proof
