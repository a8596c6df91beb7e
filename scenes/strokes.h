// scenes/strokes.h - bones with known answers: the ground truths of touch.
//
//     for (const Stroke& stroke : strokes(r, h))
//       ... step to stroke.hand(s), compare with stroke.true_centre(hand)
//
// docs/understand/touch_truths.md, "Ground truths". The bones measure a few millimetres and are
// never smaller than the burr needs. Faces of a box go through voxel centres, because between them
// a field cannot represent a sharp edge. Frame: world. Units: SI.
#pragma once

#include <string>
#include <vector>

#include "burr/phantom/shapes.h"
#include "burr/volume/grid.h"

namespace burr::scenes {

using math::Vec3;

struct Stroke {
  std::string name;
  phantom::Depth depth;                            // of the bone: exact in the air around it
  volume::Grid grid;                               // holds everything that the burr can reach
  Vec3 start;                                      // in air, above the beginning of the stroke
  std::function<Vec3(double s)> hand;              // s = 0 .. 1; presses all the way
  std::function<Vec3(const Vec3& x)> true_centre;  // true centre of the burr for a hand at x
  // The hand that presses as deep for methods that test whether the hand's own point is in bone;
  // empty: hand(), one radius deeper.
  std::function<Vec3(double s)> centre_hand;
  // For a smooth convex bone, where one gradient is enough: its smallest radius of curvature  [m]
  double convex = 0;
  bool sharp = false;              // touched at an edge, which a field resolves only to a voxel
  double radius_error_factor = 1;  // factor by which an error of the radius counts
};

// r: radius of the burr; h: voxel; deep: how far the hand presses. [m]
[[nodiscard]] std::vector<Stroke> strokes(double r, double h, double deep);

}  // namespace burr::scenes
