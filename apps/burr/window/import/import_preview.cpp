#include "window/import/import_preview.h"

#include <algorithm>
#include <cmath>

namespace burr::app {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour kOutline = {226, 88, 16}, kTint = {230, 159, 0}, kLeftOut = {86, 180, 233};

// Position of one pixel along an axis: two voxels, and the weight of the second.
struct Tap {
  std::size_t first = 0, second = 0;
  float share = 0;
};

std::vector<Tap> taps(const io::Scan& scan, const PlaneView& view, bool down, int pixels) {
  const int axis = down ? view.down : view.across;
  const double last = scan.size[axis] - 1;
  std::vector<Tap> out(static_cast<std::size_t>(pixels));
  for (int n = 0; n < pixels; ++n) {
    const double at = std::clamp(voxels_at(scan, view, down, (n + 0.5) / pixels) - 0.5, 0.0, last);
    const double from = std::floor(at);
    out[static_cast<std::size_t>(n)] = {static_cast<std::size_t>(from),
                                        static_cast<std::size_t>(std::min(from + 1, last)),
                                        static_cast<float>(at - from)};
  }
  return out;
}

void put(std::vector<std::uint8_t>& rgba, std::size_t pixel, const Colour& colour) {
  for (std::size_t c = 0; c < 3; ++c) rgba[4 * pixel + c] = colour[c];
  rgba[4 * pixel + 3] = 255;
}

bool is_hatch(const PlaneValues& plane, std::size_t pixel, int line) {
  constexpr int kHatch = 6;
  const int x = static_cast<int>(pixel % static_cast<std::size_t>(plane.width)),
            y = static_cast<int>(pixel / static_cast<std::size_t>(plane.width));
  return (x + y) % kHatch < std::max(2, line);
}

// Draws a line along the inner edge of the inside; inside() asks for a pixel.
template <class Inside>
void outline(const PlaneValues& plane, int line, std::vector<std::uint8_t>& rgba, Inside inside) {
  const int w = plane.width, h = plane.height;
  const auto at = [w](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (!inside(at(x, y))) continue;
      bool edge = false;
      for (int d = 1; d <= line && !edge; ++d)
        edge = (x >= d && !inside(at(x - d, y))) || (x + d < w && !inside(at(x + d, y))) ||
               (y >= d && !inside(at(x, y - d))) || (y + d < h && !inside(at(x, y + d)));
      if (edge) put(rgba, at(x, y), kOutline);
    }
}

}  // namespace

std::array<PlaneView, 3> planes_of(const math::Mat3& axes) {
  // each axis of the patient gets the nearest axis of the scan; the best match is assigned first
  std::array<int, 3> of_patient = {-1, -1, -1};
  std::array<bool, 3> taken = {false, false, false};
  for (int round = 0; round < 3; ++round) {
    int best_patient = 0, best_scan = 0;
    double best = -1;
    for (int p = 0; p < 3; ++p)
      for (int s = 0; s < 3; ++s)
        if (of_patient[static_cast<std::size_t>(p)] < 0 && !taken[static_cast<std::size_t>(s)] &&
            std::abs(axes(p, s)) > best) {
          best = std::abs(axes(p, s));
          best_patient = p;
          best_scan = s;
        }
    of_patient[static_cast<std::size_t>(best_patient)] = best_scan;
    taken[static_cast<std::size_t>(best_scan)] = true;
  }
  const auto [x, y, z] = of_patient;
  const bool flip_x = axes(0, x)<0, flip_y = axes(1, y) < 0, head_down = axes(2, z)> 0;
  return {PlaneView{x, y, z, flip_x, flip_y, 'R', 'L', 'A', 'P'},
          PlaneView{x, z, y, flip_x, head_down, 'R', 'L', 'S', 'I'},
          PlaneView{y, z, x, flip_y, head_down, 'A', 'P', 'S', 'I'}};
}

std::array<double, 2> extent_mm(const io::Scan& scan, const PlaneView& view) {
  return {scan.size[view.across] * scan.spacing_mm[view.across],
          scan.size[view.down] * scan.spacing_mm[view.down]};
}

double voxels_at(const io::Scan& scan, const PlaneView& view, bool down, double place) {
  const bool flip = down ? view.flip_down : view.flip_across;
  return (flip ? 1 - place : place) * scan.size[down ? view.down : view.across];
}

double place_of(const io::Scan& scan, const PlaneView& view, bool down, double voxels) {
  const bool flip = down ? view.flip_down : view.flip_across;
  const double place = voxels / scan.size[down ? view.down : view.across];
  return flip ? 1 - place : place;
}

void sample(const io::Scan& scan, const PlaneView& view, int slice, int width, int height,
            PlaneValues& out) {
  out.width = width;
  out.height = height;
  out.values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const std::array<std::size_t, 3> stride = {
      1, static_cast<std::size_t>(scan.size.x()),
      static_cast<std::size_t>(scan.size.x()) * static_cast<std::size_t>(scan.size.y())};
  const auto step = [&stride](int axis) { return stride[static_cast<std::size_t>(axis)]; };
  const std::size_t across = step(view.across), down = step(view.down),
                    base = step(view.through) * static_cast<std::size_t>(std::clamp(
                                                    slice, 0, scan.size[view.through] - 1));
  const std::vector<Tap> columns = taps(scan, view, false, width),
                         rows = taps(scan, view, true, height);
  const bool labels = scan.values.empty();
  std::size_t pixel = 0;
  for (const Tap& row : rows) {
    const std::size_t upper = base + row.first * down, lower = base + row.second * down;
    for (const Tap& column : columns) {
      const std::size_t left = column.first * across, right = column.second * across;
      if (labels) {
        out.values[pixel++] = static_cast<float>(
            scan.labels[(row.share < 0.5F ? upper : lower) + (column.share < 0.5F ? left : right)]);
        continue;
      }
      const float above = scan.values[upper + left] +
                          column.share * (scan.values[upper + right] - scan.values[upper + left]),
                  below = scan.values[lower + left] +
                          column.share * (scan.values[lower + right] - scan.values[lower + left]);
      out.values[pixel++] = above + row.share * (below - above);
    }
  }
}

LeftOut left_out(const io::Scan& scan, const PlaneView& view, int slice, const PlaneValues& plane,
                 const importing::FoundParts& found, const std::vector<bool>& kept) {
  if (std::find(kept.begin(), kept.end(), false) == kept.end()) return {};
  LeftOut out(plane.values.size());
  const importing::Place& place = found.place;
  const math::Vec3 from = place.axes.transpose() * (place.origin_mm - scan.origin_mm);
  const auto centres = [&](bool down, int count) {
    std::vector<int> all;
    const int axis = down ? view.down : view.across;
    for (int n = 0; n < count; ++n)
      all.push_back(static_cast<int>(std::lround(
          ((voxels_at(scan, view, down, (n + 0.5) / count) - 0.5) * scan.spacing_mm[axis] -
           from[axis]) /
          place.voxel_mm[axis])));
    return all;
  };
  const std::vector<int> columns = centres(false, plane.width), rows = centres(true, plane.height);
  math::Ijk at;
  at[view.through] = static_cast<int>(std::lround(
      (slice * scan.spacing_mm[view.through] - from[view.through]) / place.voxel_mm[view.through]));
  std::size_t pixel = 0;
  for (const int row : rows) {
    at[view.down] = row;
    for (const int column : columns) {
      at[view.across] = column;
      // the parts were found in smoothed values: at their rim they differ by a voxel
      auto part = found.parts.part_at(at);
      for (int n = 0; n < 6 && !part; ++n)
        part = found.parts.part_at(at + (n % 2 == 0 ? 1 : -1) * math::Ijk::Unit(n / 2));
      out[pixel++] = part && !kept[*part] ? 1 : 0;
    }
  }
  return out;
}

void draw_greys(const PlaneValues& plane, double black, double white, std::optional<double> level,
                int line, const LeftOut& out, std::vector<std::uint8_t>& rgba) {
  rgba.resize(4 * plane.values.size());
  const auto from = static_cast<float>(black);
  const float scale = 255.0F / static_cast<float>(std::max(white - black, 1e-30));
  const bool any = level.has_value();
  const auto iso = static_cast<float>(level.value_or(0));
  for (std::size_t n = 0; n < plane.values.size(); ++n) {
    const float grey = std::clamp((plane.values[n] - from) * scale, 0.0F, 255.0F);
    Colour colour;
    const bool bone = any && plane.values[n] >= iso, left = bone && !out.empty() && out[n] != 0;
    const Colour& tint = left ? kLeftOut : kTint;
    const float share = !bone ? 0 : !left ? 0.38F : is_hatch(plane, n, line) ? 0.75F : 0.25F;
    for (std::size_t c = 0; c < 3; ++c)
      colour[c] =
          static_cast<std::uint8_t>((1 - share) * grey + share * static_cast<float>(tint[c]));
    put(rgba, n, colour);
  }
  if (any)
    outline(plane, line, rgba,
            [&](std::size_t n) { return plane.values[n] >= iso && (out.empty() || out[n] == 0); });
}

void draw_labels(const PlaneValues& plane, const std::array<LabelLook, 256>& looks, int line,
                 const LeftOut& out, std::vector<std::uint8_t>& rgba) {
  rgba.resize(4 * plane.values.size());
  const auto look = [&looks](float value) -> const LabelLook& {
    return looks[static_cast<std::size_t>(value)];
  };
  for (std::size_t n = 0; n < plane.values.size(); ++n) {
    const LabelLook& one = look(plane.values[n]);
    if (one.kind == volume::TissueKind::solid && !out.empty() && out[n] != 0) {
      Colour left = kLeftOut;
      if (!is_hatch(plane, n, line))
        for (std::uint8_t& part : left) part = static_cast<std::uint8_t>(part / 4);
      put(rgba, n, left);
      continue;
    }
    float strength = 0.12F;
    if (one.kind == volume::TissueKind::solid) strength = 1;
    if (one.kind == volume::TissueKind::soft) strength = is_hatch(plane, n, line) ? 1.0F : 0.35F;
    Colour colour;
    for (std::size_t c = 0; c < 3; ++c)
      colour[c] = static_cast<std::uint8_t>(12 + strength * 235 * one.colour[c]);
    put(rgba, n, colour);
  }
  outline(plane, line, rgba, [&](std::size_t n) {
    return look(plane.values[n]).kind == volume::TissueKind::solid && (out.empty() || out[n] == 0);
  });
}

}  // namespace burr::app
