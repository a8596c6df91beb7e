// apps/burr/window/import/import_preview.h - three planes through a scan before it becomes bone, in
// the usual orientation of radiology. What would become bone is tinted and outlined.
//
// Thread: any. Cost: one read and a few operations per pixel.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "burr/importing/import.h"
#include "burr/io/scan.h"
#include "burr/volume/tissue.h"

namespace burr::app {

// Which axes of the scan lie along the sides of the picture. Each is the axis nearest to a
// direction of the patient: left to right; front at the top of an axial slice, head at the top of
// the others.
struct PlaneView {
  int across = 0, down = 1, through = 2;  // axes of the scan
  bool flip_across = false, flip_down = false;
  char left = 'R', right = 'L', top = 'A', bottom = 'P';  // the patient's right, left, anterior ...
};
// axial, coronal, sagittal
[[nodiscard]] std::array<PlaneView, 3> planes_of(const math::Mat3& axes);

// Width and height of the plane.  [mm]
[[nodiscard]] std::array<double, 2> extent_mm(const io::Scan& scan, const PlaneView& view);
// Converts between a position in the picture, 0..1 from its left or top, and voxels. Whole numbers
// are edges: voxel n lies from n to n + 1.
[[nodiscard]] double voxels_at(const io::Scan& scan, const PlaneView& view, bool down,
                               double place);
[[nodiscard]] double place_of(const io::Scan& scan, const PlaneView& view, bool down,
                              double voxels);

// The values of a plane at the pixels: greys are interpolated linearly between voxels, a label is
// that of the nearest voxel.
struct PlaneValues {
  int width = 0, height = 0;
  std::vector<float> values;  // (height x width)
};
void sample(const io::Scan& scan, const PlaneView& view, int slice, int width, int height,
            PlaneValues& out);

// Of each pixel 1 where it shows a part of the bone that is left out, else 0. level: as for
// draw_greys(); solid: of a label map.
using LeftOut = std::vector<std::uint8_t>;
[[nodiscard]] LeftOut left_out(const io::Scan& scan, const PlaneView& view, int slice,
                               const PlaneValues& plane, const importing::FoundParts& found,
                               const std::vector<bool>& kept);

// Writes four bytes per pixel, top row first. out: parts that are left out are hatched in blue and
// not outlined; empty: there are none.
void draw_greys(const PlaneValues& plane, double black, double white, std::optional<double> level,
                int line, const LeftOut& out, std::vector<std::uint8_t>& rgba);
// how a label is drawn, by its kind and colour; soft tissue is hatched, solid tissue outlined
struct LabelLook {
  volume::TissueKind kind = volume::TissueKind::air;
  std::array<float, 3> colour = {0, 0, 0};
};
void draw_labels(const PlaneValues& plane, const std::array<LabelLook, 256>& looks, int line,
                 const LeftOut& out, std::vector<std::uint8_t>& rgba);

}  // namespace burr::app
