// tick/mirror_plane.h - the planes of mirror mode, as people name them and as the servo takes them.
//
// A plane of the patient (LPS) is replaced by the grid plane whose axis is nearest to its normal;
// on an oblique scan the plane is as oblique as the scan. edit/mirror.h says where along the axis a
// plane can be. Thread: any.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "burr/base/result.h"
#include "burr/edit/mirror.h"
#include "burr/tick/rows.h"
#include "burr/volume/grid.h"

namespace burr::tick {

enum class Plane { sagittal = 0, coronal = 1, axial = 2 };
inline constexpr int kPlanes = 3;
inline constexpr std::array<std::string_view, kPlanes> kPlaneNames = {"sagittal", "coronal",
                                                                      "axial"};

// Axis of the grid across the plane, and which plane that is for it; every axis has one of its own.
[[nodiscard]] int axis_of(const volume::Grid& grid, Plane plane);
[[nodiscard]] Plane plane_of(const volume::Grid& grid, int axis);

// Through the middle of the volume, or through p (world).
[[nodiscard]] edit::Mirror mirror_plane(const volume::Grid& grid, Plane plane,
                                        const std::optional<math::Vec3>& through = std::nullopt);

// "sagittal", "coronal,-3.5": a plane of the patient, and how far it is from the volume's middle to
// the left, back or top [mm].
[[nodiscard]] Result<edit::Mirror> mirror_in_words(std::string_view text, const volume::Grid& grid);

// How far from the middle of the volume, to the left, back or top.  [m]
[[nodiscard]] double offset_of(const volume::Grid& grid, const edit::Mirror& mirror);

// The command that sets this mirror in the servo.
[[nodiscard]] Command command_for(const edit::Mirror& mirror);
// The mirror that a command sets; none if it is not a command for a mirror.
[[nodiscard]] std::optional<edit::Mirror> mirror_of(const Command& command,
                                                    const math::Ijk& size) BURR_RT;

// The plane of a tool's state, in a row.
[[nodiscard]] inline edit::Mirror mirror_of(const tool::ToolState& tool) BURR_RT {
  return {tool.mirror_axis, tool.mirror_twice};
}

// The pose of a tool that is the other's image: its place and its axis +z.
[[nodiscard]] math::Pose image_of(const math::Pose& world_from_tool, const volume::Grid& grid,
                                  const edit::Mirror& mirror);

}  // namespace burr::tick
