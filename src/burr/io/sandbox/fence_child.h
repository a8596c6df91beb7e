// io/sandbox/fence_child.h - the reader's side of the fence: what `burr-read` does. For use of this
// room only.
#pragma once

#include <filesystem>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/read_scan.h"
#include "burr/io/read/triangle_mesh.h"

namespace burr::io {

using FencedRead = Result<Scan> (*)(const std::filesystem::path& path, const ReadOptions& options,
                                    Progress& progress);
using FencedMesh = Result<TriangleMesh> (*)(const std::filesystem::path& path);

// The whole main() of a fenced reader: takes the request, limits its own process, reads, answers.
// Returns the exit status. If a user starts the program by hand, it says so and does nothing.
[[nodiscard]] int answer_one_request(FencedRead read, FencedMesh read_mesh);

}  // namespace burr::io
