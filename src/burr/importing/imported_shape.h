// importing/imported_shape.h - a scan on the bone's grid, the bone that is made of it, and its separate parts.
// Internal to importing.
// Units: voxels of the bone, mm where the name says so. Thread: any; uses two workers.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "burr/importing/cubic_labels.h"
#include "burr/importing/grey.h"
#include "burr/importing/import_plan.h"
#include "burr/importing/surface_field.h"

namespace burr::importing {

struct Shape {
  Plan plan;
  std::optional<Grey> grey;    // smoothed and cubic; none: labels
  CubicLabels cubic;           // empty where the labels of the scan are used without a copy
  std::vector<double> wanted;  // volume of each tissue of a label map; below 0: as it comes [voxel]
  InsideGrid inside;           // points into the above, or into the scan
  GreyTissue rule;
  std::unique_ptr<volume::Bone> bone;
};

// All parts. Error: stopped.
[[nodiscard]] Result<Shape> shape_of(const io::Scan& scan, const scenario::BoneRecipe& recipe,
                                     Plan plan, Progress& progress);

// The parts of the bone, with the volumes that their surfaces enclose.
[[nodiscard]] Result<FoundParts> parts_of(const io::Scan& scan, const Shape& shape,
                                          Progress& progress);

// Leaves the parts that the recipe keeps, and says in the summary which these are.
[[nodiscard]] Status keep_parts(const io::Scan& scan, const scenario::BoneRecipe& recipe,
                                Shape& shape, Progress& progress);

// Adds to the summary which parts the recipe removes.
[[nodiscard]] Result<ChosenParts> choose(const FoundParts& found,
                                         const scenario::BoneRecipe& recipe, ImportSummary& out);

}  // namespace burr::importing
