// commands/export_pieces.h - `burr export --part pieces`: each separate piece of the bone to a file
// of its own.
#pragma once

#include <string>

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

// Writes numbered files beside `out`, the largest piece first, and prints what it wrote. force:
// files that are there may be replaced. bone: at rest. store: pieces that were moved in it, each of
// which is written by itself in its new place, even where it touches other bone.
[[nodiscard]] Status export_pieces(const volume::Bone& bone, const std::string& out,
                                   const io::ExportOptions& options, bool force, bool json,
                                   Progress& progress, const edit::PieceStore& store = {});

}  // namespace burr::app
