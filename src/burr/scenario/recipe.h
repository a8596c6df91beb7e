// scenario/recipe.h - how a bone is made: of what, which part, how fine, where its surface lies,
// what its tissues are. The same type at the command line, in the window, in kept sessions and
// recordings.
//
//     scenario::BoneRecipe recipe;
//     recipe.source = "ct_folder";
//     recipe.region = scenario::Region{{0, 99}, {0, 99}, {10, 60}};
//     auto made = importing::import_bone(*scan, recipe, progress);
//
// Texts become numbers where a person types them, with the parse functions below, and nowhere else.
// Units: mm, and HU or the file's unit, as people type them; a bone is SI. The length stays in mm
// because a round trip through metres would change its last bit.
// Thread: any.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/math/vec3.h"

namespace burr::scenario {

// First and last voxel of a box, both inside, counted from 0 as the file does (slices as they lie
// in the file, even where Scan::k_reversed).
struct Region {
  std::array<int, 2> i{}, j{}, k{};
  bool operator==(const Region&) const = default;
};

// Which of the separate parts of the bone are kept (importing/parts.h): the `largest` largest ones,
// and those at the points. Nothing given: all.
struct Keep {
  int largest = 0;
  std::vector<math::Vec3> at_mm;  // LPS
  [[nodiscard]] bool all() const { return largest <= 0 && at_mm.empty(); }
  bool operator==(const Keep& other) const;
};

struct BoneRecipe {
  std::string source;  // a file, a DICOM folder, or phantom:NAME
  std::string series;  // of a DICOM folder: a UID, its beginning, or "#2"; empty: the best one
  math::Vec3 spacing_mm = {0, 0, 0};  // all > 0: overrides the file
  bool allow_missing = false;         // go on though slices could not be read, or are not there
  bool as_it_is = false;              // go on though the scan contradicts itself or is no CT
  std::optional<Region> region;       // none: the whole scan
  double voxel_mm = 0;                // edge of the cubic voxels; 0: the finest axis of the scan,
                                      // coarser if memory_mb requires it
  std::optional<double>
      iso;                  // surface level, in HU or the file's unit; none: 300 HU, or an estimate
  double smooth = -1;       // noise to remove, standard deviation in HU or the file's unit;
                            // 0: none, below 0: as much as is measured in the scan
  std::string labels;       // path of a TOML file, docs/use/labels.md; empty: by name
  std::string materials;    // path of a TOML file, docs/use/materials.md; empty: built in
  double memory_mb = 2048;  // budget of the work and the bone, for voxel_mm = 0
  Keep keep;
  double drop_islands_mm3 = 0;  // parts of the bone below this volume are removed
  // Limits of reading a file; 0: by how large the files are.
  double read_seconds = 0, read_memory_mb = 0;
  std::size_t reserve_bricks = 4096;  // room for deposited material
  // Layers of air behind the faces in which the border of the scan cuts bone. false: as burr built
  // bones before 2026-11-25; a recipe in JSON that does not name it is of that time.
  bool margin = true;
  // The header's word on the values is checked, and the level of a scan without HU is estimated.
  // false: as burr did before 2026-11-26; a recipe in JSON that does not name it is of that time.
  bool check_values = true;
  // What should be there is compared with what is there, a scan that contradicts itself is
  // questioned, and inverted values are turned. false: as burr did before 2026-11-29; a recipe in
  // JSON that does not name it is of that time.
  bool check_scan = true;
  // By which law bone is made of a scan. 2: docs/understand/bone_of_a_scan.md. 1: as burr did
  // before 2026-11-29, with bone beside thin walls that no scan has; a recipe in JSON that does not
  // name it is of that time.
  int bone_law = 2;

  bool operator==(const BoneRecipe& other) const;
};

[[nodiscard]] bool is_phantom(const std::string& source);
// "temporal-bone" of "phantom:temporal-bone"; empty: it is none.
[[nodiscard]] std::string phantom_name(const std::string& source);
[[nodiscard]] std::string phantom_source(const std::string& name);
// "jaw" of "jaw?long,defect".
[[nodiscard]] std::string without_variant(const std::string& phantom);

// As a recording may hold it: no path and no identifier. A file becomes "", an own table or a
// series chosen by its UID becomes kOwn.
inline constexpr const char* kOwn = "own";
[[nodiscard]] BoneRecipe without_paths(BoneRecipe recipe);

// One JSON object; every number comes back to the bit.
[[nodiscard]] std::string to_json(const BoneRecipe& recipe);
// The Error names the field. where: the file, for its sentence.
[[nodiscard]] Result<BoneRecipe> recipe_from_json(std::string_view text, const std::string& where);

// What a person types: "10,200,0,99,5,80", "1300", "0.3,0.3,0.6". The Error names the field.
[[nodiscard]] Result<Region> parse_region(std::string_view text);
[[nodiscard]] Result<double> parse_level(std::string_view text);
[[nodiscard]] Result<math::Vec3> parse_spacing(std::string_view text);
// "largest", "3", "3 largest", "at 10,-20,30", "at 10,-20,30; 1,2,3", or the points alone; "all".
[[nodiscard]] Result<Keep> parse_keep(std::string_view text);
// To be shown; parse_region() reads it.
[[nodiscard]] std::string region_text(const Region& region);

}  // namespace burr::scenario
