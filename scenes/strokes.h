// scenes/strokes.h - hands over bones whose answer is known by heart: the ground truths of touch.
//
//     for (const Stroke& stroke : strokes(r, h))
//       ... step to stroke.hand(s), compare with stroke.place(hand)
//
// docs/touch.md, "Ground truths". The bones' sizes are a few millimetres and never less than the
// burr needs; faces of a box go through voxel centres, since between them a field knows no sharp
// edge. Frame: world. Units: SI.
#pragma once

#include <string>
#include <vector>

#include "burr/phantom/shapes.h"
#include "burr/volume/grid.h"

namespace burr::scenes {

using math::Vec3;

struct Stroke {
  std::string name;
  phantom::Depth depth;                      // of the bone: exact in the air about it
  volume::Grid grid;                         // that holds all the burr can reach
  Vec3 start;                                // free, above the stroke's beginning
  std::function<Vec3(double s)> hand;        // s = 0 .. 1; presses all the way
  std::function<Vec3(const Vec3& x)> place;  // of the burr's centre for a hand at x
  // A hand that presses as deep for who asks whether its own centre is in bone; none: a radius
  // deeper.
  std::function<Vec3(double s)> centre_hand;
  // of a smooth convex bone, where one gradient is enough: its least radius of curvature  [m]
  double convex = 0;
  bool sharp = false;   // touched at an edge, which a field knows to a voxel only
  double leverage = 1;  // an error of the radius counts so many times
};

// r: of the burr; h: voxel; deep: how far the hand presses. [m]
[[nodiscard]] std::vector<Stroke> strokes(double r, double h, double deep);

}  // namespace burr::scenes
