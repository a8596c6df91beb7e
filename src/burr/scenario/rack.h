// scenario/rack.h - the tools that a session may take: the built-in ones (tools/tools.toml) and
// those of the user's own file. File format: docs/use/tools.md.
//
//     Result<Rack> rack = read_rack("mine.toml");   // added to the built-in ones
//     const RackTool* saw = rack->find("sagittal-saw");
//
// Units: SI; the keys in a file name the units of the file. Thread: any. Errors: what is wrong in
// the file, one sentence with file, line and field.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/scenario/lesson.h"
#include "burr/tool/cutter.h"
#include "burr/tool/tool.h"

namespace burr::scenario {

inline constexpr double kUsualLean = 0.63;  // as a round burr is held: 36 degrees  [rad]

struct RackTool {
  std::string name;    // "sagittal-saw": how it is chosen, and recorded
  Texts title;         // as a person reads it
  std::string group;   // "burrs", "burs", "drills", "saws", "hand": how the list is ordered
  std::string source;  // where the sizes come from
  tool::Tool tool;
  tool::Cutter cutter;
  // How far the handle leans away from the bone's normal where a mouse holds the tool  [rad]
  double lean = kUsualLean;
};

struct Rack {
  std::vector<RackTool> all;
  // nullptr: there is none of this name.
  [[nodiscard]] const RackTool* find(std::string_view name) const;
  // The same, or an error that lists the names.
  [[nodiscard]] Result<RackTool> get(std::string_view name) const;
  // Adds it; it takes the place of one of the same name.
  void put(RackTool tool);
};

// A part that is a mesh from a file, which another room reads (workshop/mesh_shape.h).
struct MeshWish {
  std::string path;
  double m_per_unit = 1e-3;  // of the file's lengths
  double cell_m = 0;         // 0: chosen by the size
  bool turns = false;        // about the z axis of the file
};
struct MeshShape {
  tool::Shape shape;
  math::Vec3 middle = math::Vec3::Zero();  // of the shape, in the frame of the mesh  [m]
};
using MeshReader = std::function<Result<MeshShape>(const MeshWish&)>;

[[nodiscard]] const Rack& built_in_rack();

// The built-in tools with those of the file; one of the same name takes the place of the built-in.
// Paths of meshes count from the folder of the file; without `meshes` no part may be one.
[[nodiscard]] Result<Rack> read_rack(const std::string& path, const MeshReader& meshes = {});
// file: name for error messages; base: the tools that the text adds to; folder: of the meshes.
[[nodiscard]] Result<Rack> parse_rack(std::string_view text, std::string_view file,
                                      const Rack& base, const MeshReader& meshes = {},
                                      const std::string& folder = {});

// How wide the cutting parts are across the tool's axis, in the wider of x and y.  [m]
[[nodiscard]] double cutting_width(const RackTool& tool);

}  // namespace burr::scenario
