// importing/materials.h - the physical constants of tissues, with their range, their source, and
// whether they were measured. File format: docs/use/materials.md.
//
//     Result<Materials> materials = read_materials("mine.toml");  // added to the built-in ones
//     materials->apply_material(tissue);                          // finds the material by its name
//
// Constants are SI; the keys in the file name the units of the file. Thread: any.
// Errors: what is wrong in the file, one sentence.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/volume/tissue.h"

namespace burr::importing {

struct Constant {
  double value = 0, low = 0, high = 0;  // SI
  std::string source;
  bool calibrated = false;
};

// A missing value is not known for this material (soft tissue lacks everything that is for
// cutting).
struct Material {
  std::string name;
  std::optional<Constant> cutting_energy;    // [J/m^3]
  std::optional<Constant> friction;          // steel on the material, wet, spindle off [-]
  std::optional<Constant> cutting_friction;  // mu_c: tangential over normal force of a cut [-]
  std::optional<Constant> chip_tangential, chip_radial;  // volume::CuttingForce [N/m^2]
  std::optional<Constant> edge_tangential, edge_radial;  // [N/m]
  std::optional<Constant> edge_onset;                    // [m]
  std::optional<Constant> conductivity;                  // [W/(m K)]
  std::optional<Constant> density;                       // pores included [kg/m^3]
  std::optional<Constant> specific_heat;                 // [J/(kg K)]
};

// One constant of a Material: its key and its unit in the file.
struct MaterialField {
  const char* key;   // "cutting_energy_J_mm3"
  const char* unit;  // "J/mm^3"
  double si;         // SI = the file's number * si
  double most;       // largest number allowed in a file
  std::optional<Constant> Material::*place;
};
[[nodiscard]] std::span<const MaterialField> material_fields();

struct Materials {
  std::vector<Material> all;

  // Finds a material by name; case, _ and - do not matter. nullptr: there is none.
  [[nodiscard]] const Material* find(std::string_view name) const;
  // The material of a tissue with this name: the one of the same name, or the one that the name
  // contains (enamel, dentine, caries, trabecular, cement, foam); for soft tissues "soft tissue";
  // otherwise cortical bone.
  [[nodiscard]] const Material& of(std::string_view tissue_name,
                                   volume::TissueKind kind = volume::TissueKind::solid) const;
  // Gives the tissue the constants of the material of(its name, its kind).
  void apply_material(volume::Tissue& tissue) const;
};

// Gives the tissue the constants that the material has; the others stay as they are.
void apply_material(const Material& material, volume::Tissue& tissue);

[[nodiscard]] const Materials& built_in_materials();

// The built-in materials, changed and extended by the file. A file may name new materials; what
// they leave out is taken from the material in their key `like`, or from cortical bone.
[[nodiscard]] Result<Materials> read_materials(const std::string& path);
// file: name for error messages; base: the materials that the text changes and extends.
[[nodiscard]] Result<Materials> parse_materials(std::string_view text, std::string_view file,
                                                const Materials& base);

// The materials as a file for read_materials().
[[nodiscard]] std::string materials_toml(std::span<const Material> materials);

}  // namespace burr::importing
