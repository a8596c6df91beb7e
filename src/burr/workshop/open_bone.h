// workshop/open_bone.h - a recipe becomes a bone, ready to be milled: a scan is read and imported, a
// phantom shaped by its formula or taken from where it was shaped before.
//
//     auto made = workshop::open_bone(recipe, progress);     // made->bone, made->summary
//
// Thread: any. Errors: one sentence that names the option or the file.
#pragma once

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/importing/import.h"
#include "burr/io/read/read_scan.h"
#include "burr/scenario/recipe.h"

namespace burr::workshop {

// What of the recipe is for whoever reads the file.
[[nodiscard]] io::ReadOptions read_options(const scenario::Recipe& recipe);

// scan: what the source holds, where it was read before; it is not read again then. keep_greys: of
// a grey scan, its values, to be looked at.
[[nodiscard]] Result<importing::Imported> open_bone(const scenario::Recipe& recipe,
                                                    Progress& progress,
                                                    const io::Scan* scan = nullptr,
                                                    bool keep_greys = false);

}  // namespace burr::workshop
