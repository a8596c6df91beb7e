#include "burr/importing/import.h"

#include <algorithm>
#include <new>
#include <utility>

#include "burr/importing/import_plan.h"
#include "burr/importing/imported_shape.h"
#include "burr/importing/keep_greys.h"
#include "burr/volume/volume_of.h"

namespace burr::importing {
namespace {

bool keeps_all(const scenario::BoneRecipe& recipe) {
  return recipe.keep.all() && recipe.drop_islands_mm3 <= 0;
}

}  // namespace

Result<ImportSummary> plan_import(const io::Scan& scan, const scenario::BoneRecipe& recipe) {
  auto plan = make_plan(scan, recipe);
  if (!plan) return plan.error();
  return std::move(plan->summary);
}

Result<FoundParts> parts_of(const io::Scan& scan, const scenario::BoneRecipe& recipe,
                            Progress& progress) {
  try {
    const auto plan = make_plan(scan, recipe);
    if (!plan) return plan.error();
    const auto shape = shape_of(scan, recipe, *plan, progress);
    if (!shape) return shape.error();
    return parts_of(scan, *shape, progress);
  } catch (const std::bad_alloc&) {
    return error(
        "not enough memory to look for the parts of the bone; use a larger `voxel_mm` or a "
        "smaller `region`");
  }
}

Status count_parts(const io::Scan& scan, const scenario::BoneRecipe& recipe, Progress& progress,
                   ImportSummary& summary) {
  const auto found = parts_of(scan, recipe, progress);
  if (!found) return found.error();
  const auto chosen = choose(*found, recipe, summary);
  return chosen ? fine() : Status(chosen.error());
}

Result<std::vector<TissueFound>> labels_of(const io::Scan& scan,
                                           const scenario::BoneRecipe& recipe) {
  std::vector<TissueFound> all;
  if (scan.labels.empty()) return all;
  const auto materials = materials_of(recipe);
  if (!materials) return materials.error();
  const std::array<std::int64_t, 256> counts =
      count_labels({scan.labels.data(), scan.size, {0, 0, 0}}, scan.size);
  std::array<bool, 256> present{};
  for (std::size_t v = 1; v < 256; ++v) present[v] = counts[v] > 0;
  const auto labels = label_tissues(scan, present, recipe.labels, *materials);
  if (!labels) return labels.error();
  for (std::size_t v = 1; v < 256; ++v)
    if (const volume::TissueId id = labels->of_label[v]; id != 0)
      all.push_back({id, labels->table[id], counts[v], 0, labels->assumed[v]});
  for (const volume::Tissue& air : labels->air)
    all.push_back({0, air, counts[static_cast<std::size_t>(air.label)], 0});
  for (TissueFound& one : all)
    one.volume_mm3 = static_cast<double>(one.voxels) * scan.spacing_mm.prod();
  std::sort(all.begin(), all.end(), [](const TissueFound& a, const TissueFound& b) {
    return a.tissue.label < b.tissue.label;
  });
  return all;
}

Result<Imported> import_bone(const io::Scan& scan, const scenario::BoneRecipe& recipe,
                             Progress& progress, bool with_greys) {
  try {
    auto plan = make_plan(scan, recipe);
    if (!plan) return plan.error();
    auto shape = shape_of(scan, recipe, std::move(*plan), progress);
    if (!shape) return shape.error();
    if (!keeps_all(recipe))
      if (Status kept = keep_parts(scan, recipe, *shape, progress); !kept) return kept.error();
    Imported made;
    made.bone = std::move(shape->bone);
    made.summary = std::move(shape->plan.summary);
    if (with_greys && shape->grey) {
      made.greys = keep_greys(scan, made.summary.iso, progress);
      if (made.greys == nullptr) return error(Trouble::interrupted, "the import was stopped");
    }
    const volume::Bone& bone = *made.bone;
    made.summary.solid_mm3 = volume::volume_of(bone) * 1e9;
    made.summary.memory_mb = static_cast<double>(bone.memory_bytes()) / 1048576.0;
    if (made.summary.solid_mm3 <= 0)
      return error("there is no bone at this surface level; choose another with `iso`");
    return made;
  } catch (const std::bad_alloc&) {
    return error("not enough memory for the bone; use a larger `voxel_mm` or a smaller `region`");
  }
}

}  // namespace burr::importing
