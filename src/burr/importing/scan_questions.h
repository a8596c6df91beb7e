// importing/scan_questions.h - what a reader of scans asked, and whether the recipe answers it. Thread: any.
#pragma once

#include "burr/io/scan.h"
#include "burr/scenario/recipe.h"

namespace burr::importing {

// Whether the recipe answers this question of the reader.
[[nodiscard]] bool answered(const io::Question& question, const scenario::BoneRecipe& recipe);

}  // namespace burr::importing
