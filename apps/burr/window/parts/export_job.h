// apps/burr/window/parts/export_job.h - what can be written from a running session: the bone, the
// removed or added part, each piece by itself, a picture, or a film; without any use of the window.
//
// Thread: any, except where stated.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/edit/piece_store.h"
#include "burr/render/image.h"
#include "burr/rt/changed_bits.h"
#include "burr/volume/bone.h"

namespace burr::app {

enum class ExportWhat { bone, removed, added, pieces, picture, film };
// It compares with the bone at the first tick.
[[nodiscard]] inline bool needs_before(ExportWhat what) {
  return what == ExportWhat::removed || what == ExportWhat::added;
}

struct ExportRequest {
  ExportWhat what = ExportWhat::bone;
  std::string path;  // for a film of pictures: their folder; for pieces: a number follows the name
};

// The possible endings, ".stl" for example; the first is the usual one. A film without ending is a
// folder of pictures.
[[nodiscard]] const std::vector<std::string>& endings_of(ExportWhat what);
// The path with another of these endings. If the name was made by burr, it becomes the name for
// `what`.
[[nodiscard]] std::string path_for(const std::string& path, ExportWhat what,
                                   const std::string& ending);
// The ending of the path, one of endings_of(what), small letters; "": it has none of them.
[[nodiscard]] std::string ending_of(const std::string& path, ExportWhat what);

// True: a file or film of this name exists, or the first piece.
[[nodiscard]] bool already_there(const ExportRequest& request);

// Says in one sentence why the request is not possible: unknown ending, no such folder, or the path
// is a folder.
[[nodiscard]] Status check_request(const ExportRequest& request);

// What was written, for a sentence to the user.
struct ExportDone {
  std::string path;
  double volume = 0;          // 0 for a picture  [m^3]
  std::size_t triangles = 0;  // 0 if it is not a mesh
  int pictures = 0;           // in a film
  std::size_t pieces = 0;     // so many files; path is that of the largest
};

// Copies the bone while the servo cuts it, and writes the file. before: the bone at the first tick, if
// needs_before(). store: of the pieces that were moved. changed: a watcher of the bone that no one else uses. The bone
// must outlive the work. For films see film_job.h.
[[nodiscard]] Result<ExportDone> write_export(const ExportRequest& request,
                                              const volume::Bone& bone, rt::ChangedBits& changed,
                                              const volume::Bone* before,
                                              const edit::PieceStore& store,
                                              const render::Image* picture, Progress& progress);

}  // namespace burr::app
