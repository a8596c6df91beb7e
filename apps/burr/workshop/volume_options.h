// apps/burr/workshop/volume_options.h - the words about a volume that several subcommands share: which file
// or phantom, and what is done to it on the way to bone.
#pragma once

#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/importing/import.h"
#include "burr/io/read/read_scan.h"

namespace CLI {
class App;
}

namespace burr::app {

// As typed. Defaults are those of io::ReadOptions and importing::ImportOptions.
struct VolumeOptions {
  std::string path;  // a file, a DICOM folder, or phantom:NAME
  std::string series, spacing_mm, roi, iso, tissues, materials;
  double voxel_mm = 0, smooth = -1, memory_mb = 0;
  double read_seconds = 0, read_memory_mb = 0;  // limits of the fence
  std::size_t reserve_bricks = importing::ImportOptions{}.reserve_bricks;
  bool keep_greys = false;  // for slices with the scan's own values; not typed
};

// Adds --series --voxel-mm --spacing-mm --iso --roi --tissues --materials --smooth --memory-mb
// --read-seconds --read-memory-mb; the volume itself is the subcommand's own positional, because
// some take a CASE or a recording there.
void add_volume_options(CLI::App& command, VolumeOptions& options);

[[nodiscard]] bool is_phantom(const std::string& path);
[[nodiscard]] Result<io::ReadOptions> read_options(const VolumeOptions& options);
[[nodiscard]] Result<importing::ImportOptions> import_options(const VolumeOptions& options);

// The bone, ready to be milled, from a file, a folder or a formula.
// scan: what the path holds, where it was read before; it is not read again then.
[[nodiscard]] Result<importing::Imported> open_volume(const VolumeOptions& options,
                                                      Progress& progress,
                                                      const io::Scan* scan = nullptr);

}  // namespace burr::app
