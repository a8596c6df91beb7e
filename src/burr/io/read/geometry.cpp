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

// The upright grid that holds all slices of a stack.
struct Upright {
  int nx = 0, ny = 0, nz = 0;
  double start_x = 0, start_y = 0;  // its first voxel, from that of the first slice [mm]
  double depth = 0;                 // from the first slice to the last [mm]
  std::size_t slice = 0;            // voxels in a slice
};

Result<Upright> upright_grid(const Scan& scan, const std::vector<SlicePlace>& places,
                             double gap_mm) {
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
  Upright to;
  to.start_x = std::floor(lo_x / dx + 1e-6) * dx;
  to.start_y = std::floor(lo_y / dy + 1e-6) * dy;
  to.nx = nx + more_x;
  to.ny = ny + more_y;
  to.depth = places.back().z_mm;
  to.nz = nz == 1 ? 1 : static_cast<int>(std::lround(to.depth / gap_mm)) + 1;
  if (auto count = voxel_count("the straightened volume", to.nx, to.ny, to.nz); !count)
    return count.error();
  to.slice = static_cast<std::size_t>(to.nx) * static_cast<std::size_t>(to.ny);
  return to;
}

// The slices below and above a height, and how far it lies from the lower to the upper one (0..1).
struct Neighbours {
  int lower = 0, upper = 0;
  double t = 0;
};

Neighbours slices_around(const std::vector<SlicePlace>& places, double z) {
  const auto nz = static_cast<int>(places.size());
  Neighbours found;
  int& lower = found.lower;
  while (lower + 2 < nz && places[static_cast<std::size_t>(lower) + 1].z_mm <= z) ++lower;
  found.upper = std::min(lower + 1, nz - 1);
  const double from = places[static_cast<std::size_t>(lower)].z_mm,
               span = places[static_cast<std::size_t>(found.upper)].z_mm - from;
  found.t = span > 0 ? std::clamp((z - from) / span, 0.0, 1.0) : 0;
  return found;
}

// Puts slice k of the labels at its place in an upright slice, moved by whole voxels.
void move_labels(const Scan& scan, int k, const SlicePlace& place, const Upright& grid,
                 std::uint8_t* to) {
  const int nx = scan.size.x(), ny = scan.size.y();
  const int si = static_cast<int>(std::lround((place.x_mm - grid.start_x) / scan.spacing_mm.x())),
            sj = static_cast<int>(std::lround((place.y_mm - grid.start_y) / scan.spacing_mm.y()));
  const std::uint8_t* from = scan.labels.data() + static_cast<std::size_t>(k) * slice_voxels(scan);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      if (i + si < grid.nx && j + sj < grid.ny)
        to[static_cast<std::size_t>((j + sj) * grid.nx + i + si)] =
            from[static_cast<std::size_t>(j * nx + i)];
}

// Grey slices moved to their places in the upright grid. The two used last are kept, because the
// upright slices are made from below to above.
class MovedSlices {
 public:
  MovedSlices(const Scan& scan, const std::vector<SlicePlace>& places, const Upright& grid,
              float air)
      : scan_(scan),
        places_(places),
        grid_(grid),
        air_(air),
        lines_(static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(scan.size.y()), air),
        below_(grid.slice),
        above_(grid.slice) {}

  // Writes the upright slice between two neighbours.
  void blend(const Neighbours& around, float* to) {
    if (have_below_ != around.lower) {
      if (have_above_ == around.lower) {
        std::swap(below_, above_);
        have_above_ = -1;
      } else {
        move(around.lower, below_);
      }
      have_below_ = around.lower;
    }
    if (have_above_ != around.upper) {
      move(around.upper, above_);
      have_above_ = around.upper;
    }
    const auto u = static_cast<float>(around.t);
    for (std::size_t v = 0; v < grid_.slice; ++v) to[v] = below_[v] + u * (above_[v] - below_[v]);
  }

 private:
  void move(int k, std::vector<float>& plane) {
    const int nx = scan_.size.x(), ny = scan_.size.y();
    const float* from = scan_.values.data() + static_cast<std::size_t>(k) * slice_voxels(scan_);
    const SlicePlace& place = places_[static_cast<std::size_t>(k)];
    for (int j = 0; j < ny; ++j)
      shift_line(from + static_cast<std::ptrdiff_t>(j) * nx, nx, 1,
                 lines_.data() + static_cast<std::ptrdiff_t>(j) * grid_.nx, grid_.nx, 1,
                 (place.x_mm - grid_.start_x) / scan_.spacing_mm.x(), air_);
    for (int i = 0; i < grid_.nx; ++i)
      shift_line(lines_.data() + i, ny, grid_.nx, plane.data() + i, grid_.ny, grid_.nx,
                 (place.y_mm - grid_.start_y) / scan_.spacing_mm.y(), air_);
  }

  const Scan& scan_;
  const std::vector<SlicePlace>& places_;
  const Upright& grid_;
  float air_;
  std::vector<float> lines_;  // a slice whose rows are moved and whose columns are not yet
  std::vector<float> below_, above_;
  int have_below_ = -1, have_above_ = -1;  // which slices they hold
};

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

void no_spacing(std::string_view file, bool check_scan, Scan& scan) {
  if (check_scan)
    scan.ask(Ask::spacing, fmt::format("{}: states no voxel spacing (taken for 1 mm)", file));
  else
    scan.notices.emplace_back(
        "The file states no voxel spacing: 1 mm is assumed; see `spacing_mm`.");
}

Status resample_upright(Scan& scan, const std::vector<SlicePlace>& places, double gap_mm,
                        Progress& progress) {
  const auto fits = upright_grid(scan, places, gap_mm);
  if (!fits) return fits.error();
  const Upright& grid = *fits;
  const bool labels = scan.values.empty();
  const float air = air_of(scan);
  const std::size_t voxels = grid.slice * static_cast<std::size_t>(grid.nz);
  Voxels<float> even(labels ? 0 : voxels, air);
  Voxels<std::uint8_t> even_labels(labels ? voxels : 0);
  MovedSlices moved(scan, places, grid, air);
  for (int k = 0; k < grid.nz; ++k) {
    const double z = grid.nz == 1 ? 0 : grid.depth * k / (grid.nz - 1);
    const Neighbours around = slices_around(places, z);
    const std::size_t start = static_cast<std::size_t>(k) * grid.slice;
    if (labels) {  // labels: the nearer slice
      const int near = around.t < 0.5 ? around.lower : around.upper;
      move_labels(scan, near, places[static_cast<std::size_t>(near)], grid,
                  even_labels.data() + start);
    } else {
      moved.blend(around, even.data() + start);
    }
    progress.report((k + 1.0) / grid.nz, "straightening the slices");
    if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
  }
  // at sharp edges the cubic weights go a little below air
  if (scan.hounsfield)
    for (float& value : even) value = std::max(value, -1024.0F);
  scan.values = std::move(even);
  scan.labels = std::move(even_labels);
  scan.size = {grid.nx, grid.ny, grid.nz};
  if (grid.nz > 1) scan.spacing_mm.z() = grid.depth / (grid.nz - 1);
  scan.origin_mm += scan.axes.col(0) * grid.start_x + scan.axes.col(1) * grid.start_y;
  return fine();
}

Status place(Scan& scan, const Affine& affine, const Vec3& spacing_mm, std::string_view file,
             Progress& progress) {
  if (!usable(affine))
    return error(
        fmt::format("{}: its voxel spacing, directions or origin are not valid; correct the header "
                    "or give `spacing_mm`",
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
    if (Status status = resample_upright(scan, places, gap, progress); !status) return status;
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
    const bool stated = std::none_of(scan.questions.begin(), scan.questions.end(),
                                     [](const Question& one) { return one.ask == Ask::spacing; });
    if (!stated)
      scan.notices.push_back(
          fmt::format("The spacing is {:.4g} x {:.4g} x {:.4g} mm as given by `spacing_mm`.",
                      spacing_mm.x(), spacing_mm.y(), spacing_mm.z()));
    else
      scan.notices.push_back(fmt::format(
          "The spacing is {:.4g} x {:.4g} x {:.4g} mm as given by `spacing_mm`, instead of {:.4g} "
          "x "
          "{:.4g} x {:.4g} mm in the file.",
          spacing_mm.x(), spacing_mm.y(), spacing_mm.z(), length.x(), length.y(), length.z()));
    scan.spacing_mm = spacing_mm;
  }
  return fine();
}

}  // namespace burr::io
