#include "burr/io/read/compare_frames.h"

#include <fmt/core.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace burr::io {
namespace {

using math::Mat3;
using math::Vec3;

Vec3 lengths(const Affine& affine) { return affine.step.colwise().norm().transpose(); }

Mat3 directions(const Affine& affine) {
  Mat3 unit;
  for (int a = 0; a < 3; ++a) unit.col(a) = affine.step.col(a).normalized();
  return unit;
}

// Rows, columns and slices are not at right angles: a rotation and a spacing cannot state that.
bool sheared(const Affine& affine) {
  const Mat3 unit = directions(affine);
  return (unit.transpose() * unit - Mat3::Identity()).cwiseAbs().maxCoeff() > 2e-3;
}

std::string text(const Vec3& v) {
  return fmt::format("{:.4g} x {:.4g} x {:.4g}", v.x(), v.y(), v.z());
}

// How far apart they place the corner of the scan where they differ most [mm].
double farthest(const Affine& a, const Affine& b, const math::Ijk& size) {
  double most = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 voxel = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis)
      if ((corner >> axis & 1) != 0) voxel[axis] = size[axis] - 1;
    most = std::max(most, (a.step * voxel + a.origin - b.step * voxel - b.origin).norm());
  }
  return most;
}

}  // namespace

void compare_frames(const StatedFrame& used, const StatedFrame& other, const std::string& file,
                    Scan& scan) {
  constexpr double kSameSize = 0.02;  // of the spacing
  const Vec3 mine = lengths(used.affine), theirs = lengths(other.affine);
  const bool resized = (mine.cwiseQuotient(theirs).array() - 1).abs().maxCoeff() > kSameSize &&
                       !sheared(used.affine) && !sheared(other.affine);
  const bool mirrored = used.affine.step.determinant() * other.affine.step.determinant() < 0;
  if (resized)
    scan.ask(Ask::doubt,
             fmt::format("{}: contradicts itself about the size of its voxels: {} mm by its {}, {} "
                         "mm by its {} ({:.3g} times the volume); the {} is used",
                         file, text(mine), used.name, text(theirs), other.name,
                         mine.prod() / theirs.prod(), used.name));
  if (mirrored)
    scan.ask(Ask::doubt,
             fmt::format("{}: contradicts itself about left and right: its {} and its {} are "
                         "mirror images of each other; the {} is used",
                         file, used.name, other.name, used.name));
  if (resized || mirrored) return;
  // headers round; a quarter of a voxel is not seen
  constexpr double kSamePlace = 0.25;
  const double apart = farthest(used.affine, other.affine, scan.size);
  if (apart <= kSamePlace * mine.minCoeff()) return;
  const Mat3 turn = directions(used.affine) * directions(other.affine).inverse();
  const double angle = std::acos(std::clamp(0.5 * (turn.trace() - 1), -1.0, 1.0)) * 180 / M_PI;
  const Vec3 middle = 0.5 * (scan.size.cast<double>() - Vec3::Ones());
  const double moved = (used.affine.step * middle + used.affine.origin -
                        other.affine.step * middle - other.affine.origin)
                           .norm();
  std::string how;
  if (moved > kSamePlace * mine.minCoeff())
    how = fmt::format("its middle lies {:.3g} mm apart", moved);
  if (angle > 0.1)
    how += fmt::format("{}it is turned by {:.3g} degrees", how.empty() ? "" : ", and ", angle);
  if (how.empty()) how = fmt::format("its corners lie up to {:.3g} mm apart", apart);
  scan.notices.push_back(fmt::format(
      "The file places the scan in two ways, by its {} and by its {}: {}. The {} is used.",
      used.name, other.name, how, used.name));
}

}  // namespace burr::io
