#include "burr/io/export_part.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <thread>

#include "burr/io/write/write_dicom_seg.h"
#include "burr/io/write/write_mesh.h"
#include "burr/io/write/write_volume.h"
#include "burr/surface/enclosed.h"
#include "burr/surface/mesher.h"
#include "burr/volume/removed_part.h"

namespace burr::io {
namespace {

bool ends_with(const std::string& path, const std::string& ending) {
  return path.size() >= ending.size() &&
         std::equal(ending.rbegin(), ending.rend(), path.rbegin(), [](char e, char p) {
           return e == std::tolower(static_cast<unsigned char>(p));
         });
}

constexpr int kFinest = 6;            // at most so many times finer than the bone
constexpr double kVolumeFits = 0.02;  // allowed difference between the mesh's volume and the
                                      // ledger's

int workers() { return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 8U)); }

}  // namespace

Status check_export(const std::string& path, const ExportOptions& options) {
  const bool labels = ends_with(path, ".seg.nrrd");
  const bool field = !labels && ends_with(path, ".nrrd");
  const bool mesh = is_mesh_path(path), dicom = ends_with(path, ".dcm");
  if (!labels && !field && !mesh && !dicom)
    return error(Trouble::usage,
                 path +
                     ": unknown file extension; use .stl, .ply, .obj, .3mf or .glb "
                     "for a mesh, .seg.nrrd or .dcm for labels, .nrrd for a volume");
  if (options.frame != Frame::lps && (!mesh || ends_with(path, ".glb")))
    return error(Trouble::usage, path +
                                     ": the frame can be chosen only for .stl, .ply, .obj and "
                                     ".3mf; use one of these, or keep the default frame");
  if (options.scan && (!field || options.part != Part::bone))
    return error(Trouble::usage,
                 path + ": grey values can be written only for the bone, and only to a .nrrd file");
  if (options.largest && !mesh)
    return error(
        Trouble::usage,
        path +
            ": `largest` is for meshes (.stl .ply .obj .3mf .glb); for a volume of a scan, "
            "use `keep` largest");
  return fine();
}

Result<Exported> export_part(const volume::Bone& before, const volume::Bone& now,
                             const std::string& path, const ExportOptions& options,
                             Progress& progress) {
  const Status possible = check_export(path, options);
  if (!possible) return possible.error();

  std::unique_ptr<volume::Bone> part;
  const volume::Bone* bone = &now;
  // what was added is what would be removed on the way back
  const bool added = options.part == Part::added;
  const volume::Bone &with = added ? now : before, &without = added ? before : now;
  if (options.part != Part::bone) {
    progress.report(0, "comparing before and after");
    if (added && volume::removed_volume(with, without) <= 0)
      return error("nothing was added to this bone; export `part` bone instead");
    auto made = volume::removed_part(with, without);
    // on the bone's own grid nothing may be left of a thin layer
    if (!made && is_mesh_path(path)) made = volume::removed_part(with, without, 2);
    if (!made) return made.error();
    part = std::move(*made);
    bone = part.get();
  }

  Exported exported{
      part != nullptr ? volume::removed_volume(with, without) : surface::enclosed_volume(*bone),
      0,
      {},
      {},
      {},
      {}};
  Status written = fine();
  if (is_mesh_path(path)) {
    auto mesh = surface::whole_surface(*bone, workers(), progress);
    // a thin layer falls between the voxels: use a finer grid until the mesh holds the part's
    // volume
    for (int finer = 2; part != nullptr && mesh.ok() && finer <= kFinest; ++finer) {
      if (std::abs(surface::shells_of(*mesh).volume / exported.volume - 1) < kVolumeFits) break;
      auto made = volume::removed_part(with, without, finer);
      if (!made) break;
      part = std::move(*made);
      bone = part.get();
      mesh = surface::whole_surface(*bone, workers(), progress);
    }
    if (!mesh) return mesh.error();
    // along the rim of a cut single voxels stand alone: no part that anybody removed
    if (part != nullptr)
      *mesh = surface::without_crumbs(*mesh, std::pow(now.grid().voxel, 3), exported.crumbs);
    exported.shells = surface::shells_of(*mesh);
    if (options.largest && exported.shells.parts > 0) {
      *mesh = surface::largest_part(*mesh);
      exported.volume = surface::shells_of(*mesh).volume;
    }
    exported.triangles = mesh->triangles.size() / 3;
    written = write_mesh(*mesh, bone->tissues(), path, options.frame, progress);
  } else if (ends_with(path, ".seg.nrrd")) {
    written = write_labels(*bone, path, progress);
  } else if (ends_with(path, ".dcm")) {
    auto segments = write_dicom_seg(labels_of_bone(*bone), path, options.dicom, progress);
    if (!segments) return segments.error();
    exported.segments = std::move(segments->segments);
    exported.notices = std::move(segments->notices);
  } else if (options.scan) {
    written = write_scan(before, now, path, progress);
  } else {
    written = write_field(*bone, path, progress);
  }
  if (!written) return written.error();
  return exported;
}

}  // namespace burr::io
