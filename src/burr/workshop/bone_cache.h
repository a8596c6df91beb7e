// workshop/bone_cache.h - a folder that keeps prepared bones, so that a thousand sessions on one scan, or on one other bone of a case,
// prepare it once.
//
//     keep_bones_in("cache", build);        // before the first open_bone() of this process
//
// An entry's name is a hash of what the bone is made of: the bytes of the scan (of a folder: of all its files), of the tables that the
// recipe names, the recipe itself, and the build. A changed scan is another entry, and no entry is ever changed; the folder may be deleted
// at any time. Any number of processes may use it: an entry comes into being whole, by a rename. What cannot be written or
// read is as if it were not there. Thread: keep_bones_in() before all others; then any.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "burr/importing/import.h"
#include "burr/scenario/recipe.h"

namespace burr::workshop {

// build: only the same build makes the same bone. An empty folder: nothing is kept, as it is without this call.
void keep_bones_in(std::filesystem::path folder, std::string build);

// The name of the bone's entry; empty: nothing is kept, or what it is made of cannot be read. Reads the scan once.
[[nodiscard]] std::string entry_of(const scenario::BoneRecipe& recipe);

// Bone, format, notices, size and voxels of the summary; nothing else of it is kept. None: it was never kept, or is damaged.
[[nodiscard]] std::optional<importing::Imported> kept_bone(const std::string& entry,
                                                           std::size_t reserve_bricks);
void keep_bone(const std::string& entry, const importing::Imported& made);

}  // namespace burr::workshop
