// io/write/write_mesh.h - writes a surface as a file for other programs. Millimetres, except GLB.
//
//     .stl   binary; SPACE=LPS or SPACE=RAS in the header, as 3D Slicer reads it
//     .ply   binary little endian; the mark as a comment; normals and a colour per vertex
//     .obj   text; the mark as a comment; normals
//     .3mf   unit millimeter; one material with name and colour per tissue
//     .glb   metres, +Y up (superior), +Z to the front (anterior); normals and a colour per vertex
//
// A mesh in the frame `print` has no SPACE mark, because it no longer lies where the patient lay.
// GLB has its own axes and ignores the frame. A file is written under another name beside its final
// place and then renamed. Errors: Trouble::usage for an ending not listed, Trouble::io,
// Trouble::interrupted. Thread: any.
#pragma once

#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/write/mesh_frame.h"
#include "burr/surface/patch.h"
#include "burr/volume/tissue.h"

namespace burr::io {

// True: the path ends in one of the above, in upper or lower case.
[[nodiscard]] bool is_mesh_path(const std::string& path);

// mesh: closed, world LPS in metres; its tissue ids index `tissues`.
[[nodiscard]] Status write_mesh(const surface::Mesh& mesh, const volume::TissueTable& tissues,
                                const std::string& path, Frame frame, Progress& progress);

}  // namespace burr::io
