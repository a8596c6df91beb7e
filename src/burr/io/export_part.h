// io/export_part.h - the bone, or what was taken out of it, into one file; the ending says which
// kind.
//
//     .stl .ply .obj .3mf .glb    its closed surface            (io/write/write_mesh.h)
//     .seg.nrrd                   a label per tissue            (io/write/write_volume.h)
//     .nrrd                       the field, or the scan with the cut in it
//
// Both bones at rest. Thread: one; meshes on a few of its own. Memory: for a mesh about 130 bytes
// per triangle, for the removed part its bricks.
#pragma once

#include <cstdint>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/write/frame.h"
#include "burr/volume/bone.h"

namespace burr::io {

enum class Part : std::uint8_t { bone, removed };

struct ExportOptions {
  Part part = Part::bone;
  Frame frame = Frame::lps;  // of meshes except .glb; volumes are always LPS
  bool scan = false;         // .nrrd of the bone: the scan's grey values instead of the field
};

// What was written.
struct Exported {
  double volume = 0;          // of the part, volume_of()  [m^3]
  std::size_t triangles = 0;  // 0 for a volume
};

// Trouble::usage if the ending is unknown or does not go with the options; asks nothing of the
// disk, so that one may ask before long work.
[[nodiscard]] Status check_export(const std::string& path, const ExportOptions& options);

// before: the bone as it was opened; now: the bone to export (may be the same object).
[[nodiscard]] Result<Exported> export_part(const volume::Bone& before, const volume::Bone& now,
                                           const std::string& path, const ExportOptions& options,
                                           Progress& progress);

}  // namespace burr::io
