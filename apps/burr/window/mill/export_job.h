// apps/burr/window/mill/export_job.h - what may be written out of a session that goes on: the bone, what
// was removed of it, a picture, or a film; asked and done without the window.
//
// Thread: any, except where said.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/render/image.h"
#include "burr/rt/changed_bits.h"
#include "burr/volume/bone.h"

namespace burr::app {

enum class ExportWhat { bone, removed, picture, film };

struct ExportRequest {
  ExportWhat what = ExportWhat::bone;
  std::string path;  // of a film: its folder
};

// ".stl", ... the first is the usual one. A film has none.
[[nodiscard]] const std::vector<std::string>& endings_of(ExportWhat what);
// The path with another of these endings; a name that burr gave is that of `what`.
[[nodiscard]] std::string path_for(const std::string& path, ExportWhat what,
                                   const std::string& ending);
// The ending the path has, of endings_of(what); "": none of them.
[[nodiscard]] std::string ending_of(const std::string& path, ExportWhat what);

// Something of that name is there already.
[[nodiscard]] bool already_there(const ExportRequest& request);

// One sentence about why it cannot be: no such ending, no such folder, a folder itself.
[[nodiscard]] Status check_request(const ExportRequest& request);

// What was written, for a sentence.
struct ExportDone {
  std::string path;
  double volume = 0;          // 0 for a picture  [m^3]
  std::size_t triangles = 0;  // 0 for what is no mesh
  int pictures = 0;           // of a film
};

// Copies the bone while the servo cuts it, and writes. before: at the first tick, only for what was
// removed. changed: a watcher of the bone's, nobody else's. The bone outlives the work. For films:
// film_job.h.
[[nodiscard]] Result<ExportDone> write_export(const ExportRequest& request,
                                              const volume::Bone& bone, rt::ChangedBits& changed,
                                              const volume::Bone* before,
                                              const render::Image* picture, Progress& progress);

}  // namespace burr::app
