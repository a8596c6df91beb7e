// io/export_part.h - writes the bone, or the part that was removed or added, to one file; the file's
// ending chooses the format.
//
//     .stl .ply .obj .3mf .glb    its closed surface            (io/write/write_mesh.h)
//     .seg.nrrd                   a label per tissue            (io/write/write_volume.h)
//     .nrrd                       the field, or the scan with the cut in it
//     .dcm                        a DICOM segmentation, a segment per tissue (io/write/write_dicom_seg.h)
//
// Both bones must be at rest. Thread: one; meshes use a few more. Memory: for a mesh about 130
// bytes per triangle, for the removed or added part its bricks.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/write/mesh_frame.h"
#include "burr/io/write/seg_options.h"
#include "burr/surface/shells.h"
#include "burr/volume/bone.h"

namespace burr::io {

enum class Part : std::uint8_t { bone, removed, added };

struct ExportOptions {
  Part part = Part::bone;
  Frame frame = Frame::lps;  // for meshes except .glb; volumes are always LPS
  bool scan = false;         // .nrrd of the bone: the scan's grey values instead of the field
  bool largest = false;      // of a mesh only the largest part, with its cavities
  SegOptions dicom = {};     // of .dcm
};

// What was written.
struct Exported {
  // What was written encloses, by its mesh; of a removed or added part without `largest`, by the
  // ledger.  [m^3]
  double volume = 0;
  std::size_t triangles = 0;         // 0 for a volume
  surface::Shells shells;            // of the mesh, also of what `largest` left out
  surface::LeftOut crumbs;           // of a removed or added part: below one voxel, not written
  std::vector<SegSegment> segments;  // of .dcm
  std::vector<std::string> notices;  // of .dcm: what the user must know, one sentence each
};

// Trouble::usage if the ending is unknown or does not fit the options. Does not touch the disk, so
// it can be called before long work.
[[nodiscard]] Status check_export(const std::string& path, const ExportOptions& options);

// before: the bone as it was opened; now: the bone to export (may be the same object).
[[nodiscard]] Result<Exported> export_part(const volume::Bone& before, const volume::Bone& now,
                                           const std::string& path, const ExportOptions& options,
                                           Progress& progress);

}  // namespace burr::io
