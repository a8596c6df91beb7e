// apps/burr/shared/volume_words.h - the options of the command line that say how a bone is made.
#pragma once

#include "burr/scenario/recipe.h"

namespace CLI {
class App;
}

namespace burr::app {

// Adds --series --voxel-mm --spacing-mm --iso --roi --tissues --materials --smooth --keep
// --drop-islands-mm3 --memory-mb --read-seconds --read-memory-mb; the source itself is a positional argument of each subcommand,
// because some accept a CASE or a recording there. An invalid value is an error of the command
// line.
void add_volume_options(CLI::App& command, scenario::BoneRecipe& recipe);

}  // namespace burr::app
