// apps/burr/shared/piece_files.h - each separate piece of a bone to a file of its own, the largest first:
// of `burr export --part pieces` and of the window's page for exports.
//
// Thread: any, one at a time.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/edit/piece_store.h"
#include "burr/io/export_part.h"
#include "burr/volume/bone.h"

namespace burr::app {

// Pieces below this are splinters: they are counted and not written.  [m^3]
inline constexpr double kSplinter = 5e-9;

// "bone.stl" -> "bone_2.stl", "a.seg.nrrd" -> "a_2.seg.nrrd"
[[nodiscard]] std::string numbered(const std::string& path, std::size_t number);

struct PieceFiles {
  struct One {
    std::string path;
    double volume = 0;  // [m^3]
    std::size_t triangles = 0;
    std::optional<std::size_t>
        moved;  // its row in `moved` of the store; none: it lies where it was cut
  };
  std::vector<One> files;
  std::size_t splinters = 0;
  double splinters_volume = 0;  // [m^3]
};

// Writes numbered files beside `out`. may_write: asked for each path before the first is written. bone: at
// rest. store: pieces that were moved in it, each of which is written by itself in its new place, even
// where it touches other bone.
[[nodiscard]] Result<PieceFiles> write_pieces(
    const volume::Bone& bone, const std::string& out, const io::ExportOptions& options,
    const std::function<Status(const std::string& path)>& may_write, Progress& progress,
    const edit::PieceStore& store = {});

}  // namespace burr::app
