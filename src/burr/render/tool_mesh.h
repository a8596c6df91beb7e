// render/tool_mesh.h - the surface of a tool of any shape, to be drawn or written to a file.
//
// Round kinds are turned about their axis; their edges are rounded as the shape says, so the mesh
// is the surface phi = 0 of tool/shape.h, up to the facets. Boxes and wedges are drawn with sharp
// edges at their outer sizes: their rounding is a few hundredths of a millimetre.
//
// Each face has vertices of its own where two faces meet at an edge, so normals are those of the
// faces. Thread: any. Frame: of the part, or of the tool. Units: m.
#pragma once

#include "burr/surface/patch.h"
#include "burr/tool/tool.h"

namespace burr::render {

// Largest distance between a facet and the surface that it stands for.  [m]
inline constexpr double kToolFacet = 10e-6;

[[nodiscard]] surface::Mesh mesh_of(const tool::Shape& shape);
// All parts with this role, each whole: where they overlap, both surfaces are there.
[[nodiscard]] surface::Mesh mesh_of(const tool::Tool& tool, tool::Role role);

}  // namespace burr::render
