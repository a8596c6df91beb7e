// workshop/open_bone.h - a recipe becomes a bone, ready to be milled: a scan is read and imported;
// a phantom is computed from its formula, or read from a file if it was computed before.
//
//     auto made = workshop::open_bone(recipe, progress);     // made->bone, made->summary
//
// Thread: any. Errors: one sentence that names the option or the file.
#pragma once

#include <string>
#include <vector>

#include "burr/base/one_bar.h"
#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/importing/import.h"
#include "burr/io/read/read_scan.h"
#include "burr/scenario/recipe.h"

namespace burr::workshop {

// The part of the recipe that the reader of the file needs.
[[nodiscard]] io::ReadOptions read_options(const scenario::BoneRecipe& recipe);

// True: a .bone file, which holds a bone to the bit, as `burr phantom --out X.bone` writes it.
[[nodiscard]] bool is_whole_bone(const std::string& source);

// What there is to do, for one bar (base/one_bar.h). read: the scan has been read before.
[[nodiscard]] std::vector<base::OneBar::Step> steps_to_bone(const scenario::BoneRecipe& recipe,
                                                            bool read = false);
// The same with the surface of a session and of its picture.
[[nodiscard]] std::vector<base::OneBar::Step> steps_to_picture(const scenario::BoneRecipe& recipe,
                                                               bool read = false);

// Progress is told as one bar, "2 of 4: smoothing". scan: the content of the source if it has been read before; it is then not read again.
// keep_greys: keep the values of a grey scan, so that slices can be shown.
[[nodiscard]] Result<importing::Imported> open_bone(const scenario::BoneRecipe& recipe,
                                                    Progress& progress,
                                                    const io::Scan* scan = nullptr,
                                                    bool keep_greys = false);

}  // namespace burr::workshop
