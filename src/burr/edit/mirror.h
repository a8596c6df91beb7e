// edit/mirror.h - a plane through the bone: whatever is done on one side is done on the other side
// too.
//
// The plane is perpendicular to an axis of the grid and lies on a voxel or midway between two, so
// that the image of a voxel is a voxel: v along the axis has the image `twice` - v. Centres of
// balls are rounded to kStep: differences between a voxel and a centre are then exact in floats,
// and equal up to their sign on both sides, so that the results are equal to the bit.
//
// Each ball works only in the half space that is nearer to it: together they do what the union of
// both balls would do, and no voxel is cut twice. Voxels on the plane itself belong to the hand's
// side.
//
// The plane may lie anywhere inside a brick, so the image of a brick is usually not a brick. Where
// bricks take slices of time, a voxel on the image's side has the slice of the brick that holds its
// own image; this is decided per layer of a brick.
//
// Thread: any. Frame: p_grid [voxel].
#pragma once

#include <algorithm>
#include <climits>
#include <cmath>

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/volume/bone.h"

namespace burr::edit {

struct Mirror {
  static constexpr double kStep = 1.0 / 1024;  // [voxel]
  int axis = -1;                               // of the grid; below 0: no mirror
  int twice = 0;                               // the plane's place along the axis [half voxel]

  [[nodiscard]] bool on() const BURR_RT { return axis >= 0; }
  [[nodiscard]] double place() const BURR_RT { return 0.5 * twice; }  // [voxel]
  [[nodiscard]] math::Vec3 image_of(math::Vec3 p) const BURR_RT {
    p[axis] = twice - p[axis];
    return p;
  }
  [[nodiscard]] bool is_above(const math::Vec3& p) const BURR_RT { return 2 * p[axis] >= twice; }
  [[nodiscard]] bool operator==(const Mirror&) const = default;
};

// The nearest plane inside the grid that mirrors voxels onto voxels.
[[nodiscard]] inline Mirror mirror_at(int axis, double place, const math::Ijk& size) BURR_RT {
  const double most = size[axis] - 1.0;
  return {axis, static_cast<int>(std::lround(2 * std::clamp(place, 0.0, most)))};
}

// The part of the bone that a ball works in.
struct Half {
  Mirror mirror;                                    // off: the whole bone
  int lowest = INT_MIN / 2, highest = INT_MAX / 2;  // voxels along the axis
  bool is_image = false;                            // on the other side of the plane from the hand
};

// A ball's centre and half: one entry, or the hand's and the image's.
struct Sides {
  int count = 1;
  math::Vec3 centre[2];
  Half half[2];  // the hand's comes first
};

[[nodiscard]] inline math::Vec3 rounded(const math::Vec3& p) BURR_RT {
  return (p / Mirror::kStep).array().round().matrix() * Mirror::kStep;
}

[[nodiscard]] inline Sides sides_of(const math::Vec3& centre, const Mirror& mirror) BURR_RT {
  Sides sides;
  sides.centre[0] = centre;
  if (!mirror.on()) return sides;
  sides.count = 2;
  sides.centre[0] = rounded(centre);
  sides.centre[1] = mirror.image_of(sides.centre[0]);
  for (Half& half : sides.half) half.mirror = mirror;
  sides.half[1].is_image = true;
  const bool above = mirror.is_above(sides.centre[0]);
  const int edge = above ? (mirror.twice + 1) >> 1 : mirror.twice >> 1;  // the hand's last voxel
  if (above) {
    sides.half[0].lowest = edge;
    sides.half[1].highest = edge - 1;
  } else {
    sides.half[0].highest = edge;
    sides.half[1].lowest = edge + 1;
  }
  return sides;
}

// Of a ball's centre and its image, returns the one that lies in this half.
[[nodiscard]] inline math::Vec3 folded(const math::Vec3& p, const Half& half) BURR_RT {
  if (!half.mirror.on()) return p;
  const math::Vec3 at = rounded(p);
  const bool in = half.lowest > INT_MIN / 2 ? half.mirror.is_above(at)
                                            : 2 * at[half.mirror.axis] <= half.mirror.twice;
  return in ? at : half.mirror.image_of(at);
}

// Decides whether a brick is worked on in this slice. The odd steps put neighbouring bricks along
// every axis into different slices. slices: a power of two
[[nodiscard]] inline bool has_slice(int bi, int bj, int bk, int slices, int slice) BURR_RT {
  return static_cast<unsigned>(bi + 3 * bj + 5 * bk) % static_cast<unsigned>(slices) ==
         static_cast<unsigned>(slice);
}

inline constexpr unsigned kAllLayers = 0xFF;

// The layers of a brick across the mirror's axis that are in the half and whose slice it is: bit n
// for layer n. Without a mirror: all or none.
[[nodiscard]] inline unsigned layers_of(const math::Ijk& brick, const Half& half, int slices,
                                        int slice) BURR_RT {
  if (!half.is_image && !has_slice(brick.x(), brick.y(), brick.z(), slices, slice)) return 0;
  if (!half.mirror.on()) return kAllLayers;
  const int axis = half.mirror.axis;
  unsigned layers = 0;
  for (int n = 0; n < volume::kBrickEdge; ++n) {
    const int v = volume::kBrickEdge * brick[axis] + n;
    if (v < half.lowest || v > half.highest) continue;
    if (half.is_image) {
      math::Ijk of = brick;
      of[axis] = (half.mirror.twice - v) >> 3;
      if (!has_slice(of.x(), of.y(), of.z(), slices, slice)) continue;
    }
    layers |= 1U << n;
  }
  return layers;
}
static_assert(volume::kBrickEdge == 8);

// True if voxel x + 8 y + 64 z of a brick is in one of these layers.
[[nodiscard]] inline bool in_layers(int voxel, int axis, unsigned layers) BURR_RT {
  return layers == kAllLayers || (layers >> (voxel >> (3 * axis) & 7) & 1U) != 0;
}

}  // namespace burr::edit
