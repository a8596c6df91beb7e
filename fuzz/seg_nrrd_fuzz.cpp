// .seg.nrrd from file to bone: segments with names and colours become tissues, labels become bone.
#include "burr/importing/import.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  const auto scan = fuzz::read_scan_bytes(io::read_nrrd, "a.seg.nrrd", {data, size});
  // the import has its own limits; here it must only be small enough to run often
  if (!scan || scan->labels.empty() || scan->size.maxCoeff() > 48) return 0;
  scenario::BoneRecipe options;
  options.reserve_bricks = 0;
  options.memory_mb = 16;
  NoProgress progress;
  const auto plan = importing::plan_import(*scan, options);
  fuzz::look_at_error(plan);
  if (!plan || plan->size.maxCoeff() > 64) return 0;
  const auto made = importing::import_bone(*scan, options, progress);
  fuzz::look_at_error(made);
  if (made) fuzz::look_at(made->bone->tissues());
  return 0;
}
