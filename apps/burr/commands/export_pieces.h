// commands/export_pieces.h - `burr export --part pieces`: each separate piece of the bone to a file
// of its own.
#pragma once

#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/edit/piece_store.h"
#include "burr/io/export_part.h"
#include "burr/volume/bone.h"
#include "shared/piece_files.h"

namespace burr::app {

// write_pieces(), and prints what it wrote.
[[nodiscard]] Status export_pieces(const volume::Bone& bone, const std::string& out,
                                   const io::ExportOptions& options, bool force, bool json,
                                   Progress& progress, const edit::PieceStore& store = {});

}  // namespace burr::app
