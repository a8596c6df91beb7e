#include "burr/workshop/open_bone.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/inputs.h"
#include "burr/base/plain_file.h"
#include "burr/importing/materials.h"
#include "burr/phantom/phantoms.h"
#include "burr/record/bone_blob.h"
#include "burr/volume/volume_of.h"
#include "burr/workshop/bone_cache.h"
#include "burr/workshop/prebuilt_phantom.h"

namespace burr::workshop {
namespace {

void describe(const volume::Bone& bone, const char* format, importing::ImportSummary& s) {
  s.format = format;
  s.voxel_mm = bone.grid().voxel * 1e3;
  s.size = s.scan_size = s.roi_size = bone.grid().size;
  s.spacing_mm = math::Vec3::Constant(s.voxel_mm);
  s.axes = bone.grid().frame.q.toRotationMatrix();
  s.origin_mm = bone.grid().frame.p * 1e3;
  s.labels = true;
  const auto& table = bone.tissues().tissues;
  for (std::size_t id = 1; id < table.size(); ++id)
    s.tissues.push_back({static_cast<volume::TissueId>(id), table[id], 0, 0});
  s.solid_mm3 = volume::volume_of(bone) * 1e9;
}

Result<importing::Imported> open_phantom(const scenario::BoneRecipe& recipe, Progress& progress) {
  const std::string name = scenario::phantom_name(recipe.source);
  const scenario::BoneRecipe usual;
  if (!recipe.series.empty() || !recipe.spacing_mm.isZero(0) || recipe.region || recipe.iso ||
      recipe.smooth != usual.smooth || recipe.memory_mb != usual.memory_mb ||
      recipe.allow_missing || recipe.as_it_is || !recipe.labels.empty() ||
      recipe.read_seconds != 0 || recipe.read_memory_mb != 0 || !recipe.keep.all() ||
      recipe.drop_islands_mm3 != 0)
    return error(Trouble::usage,
                 "a phantom is a formula: only `voxel_mm` and `materials` apply to it");
  std::function<void(volume::TissueTable&)> made_of;
  if (!recipe.materials.empty()) {
    auto materials = importing::read_materials(recipe.materials);
    if (!materials) return materials.error();
    made_of = [all = std::move(*materials)](volume::TissueTable& table) {
      for (std::size_t id = 1; id < table.tissues.size(); ++id)
        all.apply_material(table.tissues[id]);
    };
  }
  importing::Imported made;
  const bool as_ever = recipe.voxel_mm == 0 || recipe.voxel_mm == phantom::default_voxel_mm(name);
  if (as_ever && !made_of) made.bone = prebuilt_phantom(name, recipe.reserve_bricks);
  const std::string entry = made.bone ? std::string() : entry_of(recipe);
  if (auto kept = kept_bone(entry, recipe.reserve_bricks)) made.bone = std::move(kept->bone);
  if (!made.bone) {
    auto bone =
        phantom::phantom(name, recipe.voxel_mm, progress, recipe.reserve_bricks, 2, made_of);
    if (!bone) return bone.error();
    made.bone = std::move(*bone);
    keep_bone(entry, made);
  }
  describe(*made.bone, "formula", made.summary);
  return made;
}

// A bone that burr wrote whole (write_prebuilt_phantom()).
Result<importing::Imported> open_whole(const scenario::BoneRecipe& recipe) {
  scenario::BoneRecipe usual;
  usual.source = recipe.source;
  usual.reserve_bricks = recipe.reserve_bricks;
  if (!(recipe == usual))
    return error(Trouble::usage,
                 "a .bone file holds a bone as it is: only `reserve_bricks` applies to it");
  if (const Status plain = base::check_plain_file(recipe.source); !plain) return plain.error();
  std::ifstream in(recipe.source, std::ios::binary);
  const std::string name = std::filesystem::path(recipe.source).filename().string();
  if (!in) return error(fmt::format("{}: cannot read this file; check its name", name));
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  auto bone = record::bone_from_blob(record::ByteSpan(bytes), recipe.reserve_bricks, name);
  if (!bone) return bone.error();
  importing::Imported made;
  made.bone = std::move(*bone);
  describe(*made.bone, "bone of burr", made.summary);
  return made;
}

}  // namespace

bool is_whole_bone(const std::string& source) {
  return !scenario::is_phantom(source) && std::filesystem::path(source).extension() == ".bone";
}

io::ReadOptions read_options(const scenario::BoneRecipe& recipe) {
  return {recipe.series,     recipe.spacing_mm,   recipe.check_values,
          recipe.check_scan, recipe.read_seconds, recipe.read_memory_mb};
}

// The shares are those of a CT of a head.
std::vector<base::OneBar::Step> steps_to_bone(const scenario::BoneRecipe& recipe, bool read) {
  if (scenario::is_phantom(recipe.source))
    return {{{"shaping bone"}, 0.5}, {{"filling bone"}, 0.3}};
  if (is_whole_bone(recipe.source)) return {};
  std::vector<base::OneBar::Step> steps;
  if (!read) steps.push_back({{"reading", "straightening the slices"}, 0.3});
  steps.push_back({{"smoothing"}, 0.2});
  steps.push_back({{"making voxels cubic", "looking for separate parts"}, 0.2});
  steps.push_back({{"looking for bone", "finding the surface"}, 0.3});
  return steps;
}

std::vector<base::OneBar::Step> steps_to_picture(const scenario::BoneRecipe& recipe, bool read) {
  std::vector<base::OneBar::Step> steps = steps_to_bone(recipe, read);
  steps.push_back({{"finding the surface", "measuring the distance to structures to spare",
                    "making the surface"},
                   0.3});
  return steps;
}

Result<importing::Imported> open_bone(const scenario::BoneRecipe& recipe, Progress& whole,
                                      const io::Scan* scan, bool keep_greys) {
  base::OneBar progress(whole, steps_to_bone(recipe, scan != nullptr));
  for (const std::string& input : {recipe.source, recipe.labels, recipe.materials})
    base::note_input(input);
  if (scenario::is_phantom(recipe.source)) return open_phantom(recipe, progress);
  if (is_whole_bone(recipe.source)) return open_whole(recipe);
  if (scan != nullptr) return importing::import_bone(*scan, recipe, progress, keep_greys);
  const std::string entry = keep_greys ? std::string() : entry_of(recipe);
  if (auto kept = kept_bone(entry, recipe.reserve_bricks)) return std::move(*kept);
  auto read = io::read_scan(recipe.source, read_options(recipe), progress);
  if (!read) return read.error();
  auto made = importing::import_bone(*read, recipe, progress, keep_greys);
  if (made) keep_bone(entry, *made);
  return made;
}

}  // namespace burr::workshop
