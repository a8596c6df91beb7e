// haptics/six/move_rows.h - what forbids a small move of a tool: one row for each point of bone that the
// move could reach.
//
//     n . p + m . t >= -gap        p: move of the coupling point c   t = L theta: turn, as a length
//     n: unit, from the bone to the tool     m = (w x n) / L,  w = (point of contact) - c
//
// Frame: p_grid. Units: voxel; m has none. Plain struct.
#pragma once

#include <cstdint>

namespace burr::haptics {

struct Rows {
  static constexpr int kMost = 8192;
  alignas(64) float n[3][kMost + 16];
  alignas(64) float m[3][kMost + 16];
  alignas(64) float gap[kMost + 16];
  int count = 0;
  bool full = false;
};

// Points of bone near one part, relative to the place where they were collected.  [voxel]
struct NearPoints {
  static constexpr int kMost = 16384;
  alignas(64) float x[kMost + 16], y[kMost + 16], z[kMost + 16];
  // normal and radius of the disc, for a ball and for a part that rests on planes only
  alignas(64) float mx[kMost + 16], my[kMost + 16], mz[kMost + 16];
  alignas(64) float rd[kMost + 16];
  // Of each 16 points that follow each other: their least distance to the part when they were last looked
  // at, plus the way of the part until then (times the steepest slope of its distance). While the part has not
  // gone far enough, none of them is near, and they are passed over.
  static constexpr int kGroup = 16;
  float clear[kMost / kGroup + 1];
  float way =
      0;  // of the part since the points were collected: of any place on it, at most  [voxel]
  int count = 0;
};

}  // namespace burr::haptics
