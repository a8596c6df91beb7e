// dataset/dataset.h - a recording as a data set for other programs: HDF5 in the layout of FIVRS
// (docs/use/datasets.md).
//
//     auto made = dataset::write(player, *bone, "s.hdf5", {}, progress);
//
// Frame of poses: world (LPS). Units: m, N, N m, s; in the file mm^3 and mm where a name of FIVRS
// asks for it. Errors: one sentence that names the file. Thread: main only (libhdf5; with pictures
// also SDL).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/dataset/options.h"
#include "burr/record/player.h"
#include "burr/volume/bone.h"

namespace burr::dataset {

struct Written {
  std::vector<std::string> files;
  std::uint64_t ticks = 0, samples = 0;
  std::uint64_t removed = 0, added = 0;  // voxels that left the bone, that came into it
  std::string late;                      // Crossings::late
};

// The names of the files that write() makes: `out` itself, or s_00001.hdf5, s_00002.hdf5 ...
[[nodiscard]] std::vector<std::string> files_of(const record::Player& player,
                                                const std::string& out, const Options& options);

// before: the bone at the first tick.
[[nodiscard]] Result<Written> write(record::Player& player, const volume::Bone& before,
                                    const std::string& out, const Options& options,
                                    Progress& progress);

}  // namespace burr::dataset
