#include "workshop/open_volume.h"

#include "burr/workshop/open_bone.h"

namespace burr::app {

io::ReadOptions read_options(const scenario::Recipe& recipe) {
  return workshop::read_options(recipe);
}

Result<importing::Imported> open_volume(const scenario::Recipe& recipe, Progress& progress,
                                        const io::Scan* scan, bool keep_greys) {
  return workshop::open_bone(recipe, progress, scan, keep_greys);
}

}  // namespace burr::app
