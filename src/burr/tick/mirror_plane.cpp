#include "burr/tick/mirror_plane.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "burr/math/rotation.h"
#include "burr/math/sums.h"

namespace burr::tick {
namespace {

using math::Vec3;
using tick::CommandKind;

// axes[plane]: of all ways to give each plane an axis of its own, the one that fits best
std::array<int, kPlanes> axes_of(const volume::Grid& grid) {
  const Eigen::Matrix3d along = grid.frame.q.toRotationMatrix().cwiseAbs();
  std::array<int, kPlanes> axes = {0, 1, 2}, best = axes;
  double most = -1;
  do {
    const double fits = along(0, axes[0]) + along(1, axes[1]) + along(2, axes[2]);
    if (fits > most + 1e-9) {
      most = fits;
      best = axes;
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return best;
}

// does the grid's axis point to the patient's left, back or top?
double sign_of(const volume::Grid& grid, Plane plane, int axis) {
  return std::copysign(1.0, grid.frame.q.toRotationMatrix()(static_cast<int>(plane), axis));
}

double middle(const volume::Grid& grid, int axis) { return 0.5 * (grid.size[axis] - 1); }

// The whole text as a number; false: it is none.
bool number_from(std::string_view text, double& value) {
#ifdef __cpp_lib_to_chars
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
#else  // an older libc++
  const std::string copy(text);
  char* end = nullptr;
  value = std::strtod(copy.c_str(), &end);
  return !copy.empty() && end == copy.c_str() + copy.size();
#endif
}

Error wrong(std::string_view text) {
  std::string names;
  for (const auto& name : kPlaneNames) names.append(names.empty() ? "" : ", ").append(name);
  return error(Trouble::usage,
               "'" + std::string(text) + "' is no plane; give one of " + names +
                   ", and if it is not through the middle a comma and how far from it in mm: "
                   "sagittal,-3.5");
}

}  // namespace

int axis_of(const volume::Grid& grid, Plane plane) {
  return axes_of(grid)[static_cast<std::size_t>(plane)];
}

Plane plane_of(const volume::Grid& grid, int axis) {
  const auto axes = axes_of(grid);
  return static_cast<Plane>(std::find(axes.begin(), axes.end(), axis) - axes.begin());
}

edit::Mirror mirror_plane(const volume::Grid& grid, Plane plane,
                          const std::optional<Vec3>& through) {
  const int axis = axis_of(grid, plane);
  const double place = through ? grid.grid_from_world(*through)[axis] : middle(grid, axis);
  return edit::mirror_at(axis, place, grid.size);
}

Result<edit::Mirror> mirror_in_words(std::string_view text, const volume::Grid& grid) {
  const std::string_view name = text.substr(0, text.find(','));
  const auto found = std::find(kPlaneNames.begin(), kPlaneNames.end(), name);
  if (found == kPlaneNames.end()) return wrong(text);
  const auto plane = static_cast<Plane>(found - kPlaneNames.begin());
  if (name.size() == text.size()) return mirror_plane(grid, plane);
  const std::string_view number = text.substr(name.size() + 1);
  double mm = 0;
  if (!number_from(number, mm) || !std::isfinite(mm)) return wrong(text);
  const int axis = axis_of(grid, plane);
  const double place = middle(grid, axis) + sign_of(grid, plane, axis) * 1e-3 * mm / grid.voxel;
  if (!(place >= 0 && place <= grid.size[axis] - 1.0)) {
    char why[160];
    std::snprintf(why, sizeof why,
                  "%g mm from the middle is outside of the volume, which reaches %.1f mm "
                  "to either side",
                  mm, 1e3 * middle(grid, axis) * grid.voxel);
    return error(Trouble::usage, why);
  }
  return edit::mirror_at(axis, place, grid.size);
}

double offset_of(const volume::Grid& grid, const edit::Mirror& mirror) {
  return sign_of(grid, plane_of(grid, mirror.axis), mirror.axis) *
         (mirror.place() - middle(grid, mirror.axis)) * grid.voxel;
}

Command command_for(const edit::Mirror& mirror) {
  if (!mirror.on()) return {CommandKind::mirror_off, 0};
  return {static_cast<CommandKind>(static_cast<int>(CommandKind::mirror_i) + mirror.axis),
          mirror.place()};
}

std::optional<edit::Mirror> mirror_of(const Command& command, const math::Ijk& size) BURR_RT {
  if (command.kind == CommandKind::mirror_off) return edit::Mirror{};
  const int axis = static_cast<int>(command.kind) - static_cast<int>(CommandKind::mirror_i);
  if (axis < 0 || axis > 2 || !std::isfinite(command.value)) return std::nullopt;
  return edit::mirror_at(axis, command.value, size);
}

math::Pose image_of(const math::Pose& world_from_tool, const volume::Grid& grid,
                    const edit::Mirror& mirror) {
  math::Pose image;
  image.p = grid.world_from_grid(mirror.image_of(grid.grid_from_world(world_from_tool.p)));
  const Vec3 normal = grid.frame.q * Vec3(Vec3::Unit(mirror.axis));
  const Vec3 z = world_from_tool.q * Vec3::UnitZ();
  image.q = math::shortest_rotation(Vec3::UnitZ(), z - 2 * math::dot(z, normal) * normal);
  return image;
}

}  // namespace burr::tick
