#include "burr/io/read/geometry.h"

#include <fmt/core.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>

#include "burr/io/read/samples.h"

namespace burr::io {
namespace {

using math::Mat3;
using math::Vec3;

template <class T>
void reverse_slices(Voxels<T>& voxels, std::size_t slice) {
  if (voxels.empty()) return;
  const std::size_t n = voxels.size() / slice;
  for (std::size_t k = 0; k < n / 2; ++k)
    std::swap_ranges(voxels.begin() + static_cast<std::ptrdiff_t>(k * slice),
                     voxels.begin() + static_cast<std::ptrdiff_t>((k + 1) * slice),
                     voxels.begin() + static_cast<std::ptrdiff_t>((n - 1 - k) * slice));
}

std::size_t slice_voxels(const Scan& scan) {
  return static_cast<std::size_t>(scan.size.x()) * static_cast<std::size_t>(scan.size.y());
}

float air_of(const Scan& scan) {
  if (scan.hounsfield) return -1024.0F;
  return scan.values.empty() ? 0.0F : *std::min_element(scan.values.begin(), scan.values.end());
}

// Catmull-Rom weights for a position t in 0..1 between the second and the third sample
std::array<float, 4> cubic_weights(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {static_cast<float>(0.5 * (-t + 2 * t2 - t3)),
          static_cast<float>(0.5 * (2 - 5 * t2 + 3 * t3)),
          static_cast<float>(0.5 * (t + 4 * t2 - 3 * t3)), static_cast<float>(0.5 * (-t2 + t3))};
}

// Shifts a line by `shift` samples into a longer one; outside is `air`.
void shift_line(const float* from, int n, std::ptrdiff_t from_stride, float* to, int n_to,
                std::ptrdiff_t to_stride, double shift, float air) {
  const int whole = static_cast<int>(std::floor(shift));
  const auto w = cubic_weights(1.0 - (shift - whole));
  // sample at position i - shift = (i - whole - 1) + (1 - fraction)
  for (int i = 0; i < n_to; ++i) {
    const int base = i - whole - 1;
    float sum = 0;
    for (int a = 0; a < 4; ++a) {
      const int at = base - 1 + a;
      sum += w[static_cast<std::size_t>(a)] * (at >= 0 && at < n ? from[at * from_stride] : air);
    }
    to[i * to_stride] = sum;
  }
}

}  // namespace

bool usable(const Affine& affine) {
  if (!affine.step.allFinite() || !affine.origin.allFinite()) return false;
  constexpr double kFarthest = 1e6;  // a kilometre; no patient lies further away [mm]
  if (affine.origin.cwiseAbs().maxCoeff() > kFarthest) return false;
  const Vec3 length(affine.step.col(0).norm(), affine.step.col(1).norm(),
                    affine.step.col(2).norm());
  if (!(length.minCoeff() > 1e-6) || !(length.maxCoeff() < 1e4)) return false;
  Mat3 unit;
  for (int a = 0; a < 3; ++a) unit.col(a) = affine.step.col(a) / length[a];
  return std::abs(unit.determinant()) > 0.05;
}

Status straighten(Scan& scan, const std::vector<SlicePlace>& places, double gap_mm,
                  Progress& progress) {
  const int nx = scan.size.x(), ny = scan.size.y(), nz = scan.size.z();
  const double dx = scan.spacing_mm.x(), dy = scan.spacing_mm.y();
  double lo_x = 0, hi_x = 0, lo_y = 0, hi_y = 0;
  for (const SlicePlace& place : places) {
    lo_x = std::min(lo_x, place.x_mm);
    hi_x = std::max(hi_x, place.x_mm);
    lo_y = std::min(lo_y, place.y_mm);
    hi_y = std::max(hi_y, place.y_mm);
  }
  // checked before the conversion to integers: a false header may shift a slice by anything
  if (!((hi_x - lo_x) / dx <= 4.0 * nx) || !((hi_y - lo_y) / dy <= 4.0 * ny) ||
      !(places.back().z_mm / gap_mm <= 16.0 * nz))
    return error("the slices are too far apart to be one volume; choose another series");
  const int more_x = static_cast<int>(std::ceil(hi_x / dx - 1e-6) - std::floor(lo_x / dx + 1e-6));
  const int more_y = static_cast<int>(std::ceil(hi_y / dy - 1e-6) - std::floor(lo_y / dy + 1e-6));
  const double start_x = std::floor(lo_x / dx + 1e-6) * dx,
               start_y = std::floor(lo_y / dy + 1e-6) * dy;
  const int to_x = nx + more_x, to_y = ny + more_y;
  const double depth = places.back().z_mm;
  const int to_z = nz == 1 ? 1 : static_cast<int>(std::lround(depth / gap_mm)) + 1;
  if (auto count = voxel_count("the straightened volume", to_x, to_y, to_z); !count)
    return count.error();

  const bool labels = scan.values.empty();
  const float air = air_of(scan);
  const std::size_t from_slice = slice_voxels(scan),
                    to_slice = static_cast<std::size_t>(to_x) * static_cast<std::size_t>(to_y);
  Voxels<float> even(labels ? 0 : to_slice * static_cast<std::size_t>(to_z), air);
  Voxels<std::uint8_t> even_labels(labels ? to_slice * static_cast<std::size_t>(to_z) : 0);

  // moves a slice into the larger plane
  std::vector<float> line_buffer(static_cast<std::size_t>(to_x) * static_cast<std::size_t>(ny),
                                 air);
  const auto move = [&](int k, std::vector<float>& plane) {
    const float* from = scan.values.data() + static_cast<std::size_t>(k) * from_slice;
    const SlicePlace& place = places[static_cast<std::size_t>(k)];
    for (int j = 0; j < ny; ++j)
      shift_line(from + static_cast<std::ptrdiff_t>(j) * nx, nx, 1,
                 line_buffer.data() + static_cast<std::ptrdiff_t>(j) * to_x, to_x, 1,
                 (place.x_mm - start_x) / dx, air);
    for (int i = 0; i < to_x; ++i)
      shift_line(line_buffer.data() + i, ny, to_x, plane.data() + i, to_y, to_x,
                 (place.y_mm - start_y) / dy, air);
  };

  std::vector<float> below(to_slice), above(to_slice);
  int have_below = -1, have_above = -1;
  for (int k = 0; k < to_z; ++k) {
    const double z = to_z == 1 ? 0 : depth * k / (to_z - 1);
    int lower = 0;
    while (lower + 2 < nz && places[static_cast<std::size_t>(lower) + 1].z_mm <= z) ++lower;
    const int upper = std::min(lower + 1, nz - 1);
    const double span =
        places[static_cast<std::size_t>(upper)].z_mm - places[static_cast<std::size_t>(lower)].z_mm;
    const double t =
        span > 0 ? std::clamp((z - places[static_cast<std::size_t>(lower)].z_mm) / span, 0.0, 1.0)
                 : 0;
    if (labels) {  // labels: the nearer slice, moved by whole voxels
      const int near = t < 0.5 ? lower : upper;
      const SlicePlace& place = places[static_cast<std::size_t>(near)];
      const int si = static_cast<int>(std::lround((place.x_mm - start_x) / dx)),
                sj = static_cast<int>(std::lround((place.y_mm - start_y) / dy));
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
          if (i + si < to_x && j + sj < to_y)
            even_labels[static_cast<std::size_t>(k) * to_slice +
                        static_cast<std::size_t>((j + sj) * to_x + i + si)] =
                scan.labels[static_cast<std::size_t>(near) * from_slice +
                            static_cast<std::size_t>(j * nx + i)];
    } else {
      if (have_below != lower) {
        if (have_above == lower) {
          std::swap(below, above);
          have_above = -1;
        } else {
          move(lower, below);
        }
        have_below = lower;
      }
      if (have_above != upper) {
        move(upper, above);
        have_above = upper;
      }
      float* to = even.data() + static_cast<std::size_t>(k) * to_slice;
      const auto u = static_cast<float>(t);
      for (std::size_t v = 0; v < to_slice; ++v) to[v] = below[v] + u * (above[v] - below[v]);
    }
    progress.report((k + 1.0) / to_z, "straightening the slices");
    if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
  }
  // at sharp edges the cubic weights go a little below air
  if (scan.hounsfield)
    for (float& value : even) value = std::max(value, -1024.0F);
  scan.values = std::move(even);
  scan.labels = std::move(even_labels);
  scan.size = {to_x, to_y, to_z};
  if (to_z > 1) scan.spacing_mm.z() = depth / (to_z - 1);
  scan.origin_mm += scan.axes.col(0) * start_x + scan.axes.col(1) * start_y;
  return fine();
}

Status place(Scan& scan, const Affine& affine, const Vec3& spacing_mm, std::string_view file,
             Progress& progress) {
  if (!usable(affine))
    return error(
        fmt::format("{}: its voxel spacing, directions or origin are not valid; correct the header "
                    "or give --spacing-mm",
                    file));
  Vec3 length;
  Mat3 axes;
  for (int a = 0; a < 3; ++a) {
    length[a] = affine.step.col(a).norm();
    axes.col(a) = affine.step.col(a) / length[a];
  }
  Vec3 origin = affine.origin;

  // slices shifted over orthogonal planes can be moved back; a scanner makes no other shear
  const Vec3 normal = axes.col(0).cross(axes.col(1)).normalized();
  const double plane = std::abs(axes.col(0).dot(axes.col(1)));
  const double lean = std::abs(std::abs(axes.col(2).dot(normal)) - 1.0);
  constexpr double kSquare = 2e-3;  // [rad]; headers are rounded to this
  if (plane > kSquare)
    return error(
        fmt::format("{}: its rows and columns are not at right angles ({:.1f} degrees); resample "
                    "it to a rectangular grid first",
                    file, std::acos(std::clamp(plane, 0.0, 1.0)) * 180 / M_PI));
  bool leaning = lean > kSquare * kSquare;
  const double up = axes.col(2).dot(normal);
  if (leaning) {
    // correct the shear in the stack's own frame; the normal may point backwards
    const Vec3 step = affine.step.col(2);
    std::vector<SlicePlace> places(static_cast<std::size_t>(scan.size.z()));
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double n = static_cast<double>(k);
      places[k] = {n * step.dot(axes.col(0)), n * step.dot(axes.col(1)),
                   n * std::abs(step.dot(normal))};
    }
    Mat3 upright;
    upright.col(0) = axes.col(0);
    upright.col(1) = (axes.col(1) - axes.col(0) * axes.col(0).dot(axes.col(1))).normalized();
    upright.col(2) = upright.col(0).cross(upright.col(1)) * (up < 0 ? -1.0 : 1.0);
    scan.axes = upright;
    scan.spacing_mm = length;
    scan.origin_mm = origin;
    const double gap = std::abs(step.dot(normal));
    if (Status status = straighten(scan, places, gap, progress); !status) return status;
    scan.notices.push_back(fmt::format(
        "The stack of slices leans by {:.1f} degrees; the slices were shifted to make it upright.",
        std::acos(std::clamp(std::abs(up), 0.0, 1.0)) * 180 / M_PI));
    axes = scan.axes;
    length = {length.x(), length.y(), gap};
    origin = scan.origin_mm;
  }

  // the nearest exact rotation (polar decomposition); mirrored if the file's grid is left-handed
  const bool left_handed = axes.determinant() < 0;
  if (left_handed) {
    origin += axes.col(2) * length.z() * (scan.size.z() - 1);
    axes.col(2) = -axes.col(2);
    reverse_slices(scan.values, slice_voxels(scan));
    reverse_slices(scan.labels, slice_voxels(scan));
    scan.k_reversed = !scan.k_reversed;
  }
  const Eigen::JacobiSVD<Mat3> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  scan.axes = svd.matrixU() * svd.matrixV().transpose();
  scan.spacing_mm = length;
  scan.origin_mm = origin;

  if ((spacing_mm.array() > 0).all()) {
    scan.notices.push_back(fmt::format(
        "The spacing is {:.4g} x {:.4g} x {:.4g} mm as given by --spacing-mm, instead of {:.4g} x "
        "{:.4g} x {:.4g} mm in the file.",
        spacing_mm.x(), spacing_mm.y(), spacing_mm.z(), length.x(), length.y(), length.z()));
    scan.spacing_mm = spacing_mm;
  }
  return fine();
}

}  // namespace burr::io
