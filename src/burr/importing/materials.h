// importing/materials.h - what tissues are made of: constants with their range, their source, and whether
// anybody has measured them. Format of the file: docs/materials.md.
//
//     Result<Materials> materials = read_materials("mine.toml");   // over the built-in ones
//     materials->lay_over(tissue);                                     // chosen by its name
//
// Constants are SI; the file's keys carry the units it is written in. Thread: any.
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

// What is not given is not known of this material (of soft tissue: all that cutting asks for).
struct Material {
  std::string name;
  std::optional<Constant> cutting_energy;    // [J/m^3]
  std::optional<Constant> friction;          // steel on it, wet, spindle off             [-]
  std::optional<Constant> cutting_friction;  // mu_c: tangential over normal force of a cut  [-]
  std::optional<Constant> chip_tangential, chip_radial;  // volume::CuttingForce          [N/m^2]
  std::optional<Constant> edge_tangential, edge_radial;  //                               [N/m]
  std::optional<Constant> edge_onset;                    //                               [m]
  std::optional<Constant> conductivity;                  //                               [W/(m K)]
  std::optional<Constant> density;                       // with what is in its pores     [kg/m^3]
  std::optional<Constant> specific_heat;                 //                               [J/(kg K)]
};

// One constant of a Material: its key in the file, and the unit there.
struct MaterialField {
  const char* key;   // "cutting_energy_J_mm3"
  const char* unit;  // "J/mm^3"
  double si;         // SI = the file's number * si
  double most;       // largest number a file may say
  std::optional<Constant> Material::*place;
};
[[nodiscard]] std::span<const MaterialField> material_fields();

struct Materials {
  std::vector<Material> all;

  // By name, case and _ and - as they like; nullptr: there is none.
  [[nodiscard]] const Material* find(std::string_view name) const;
  // The material of a tissue called that: one of the same name, or what the name says (enamel,
  // dentine, caries, trabecular, cement, foam); of soft ones "soft tissue"; else cortical bone.
  [[nodiscard]] const Material& of(std::string_view tissue_name,
                                   volume::TissueKind kind = volume::TissueKind::solid) const;
  // Gives the tissue the constants of of(its name, its kind).
  void lay_over(volume::Tissue& tissue) const;
};

// Gives the tissue the constants the material has; the others stay.
void lay_over(const Material& material, volume::Tissue& tissue);

[[nodiscard]] const Materials& built_in_materials();

// The built-in materials with what the file says in their place. A file may name new materials;
// what those leave out is taken from the material they are `like`, or from cortical bone.
[[nodiscard]] Result<Materials> read_materials(const std::string& path);
// `file`: the name for the error's sentence; `base`: what the text is laid over.
[[nodiscard]] Result<Materials> parse_materials(std::string_view text, std::string_view file,
                                                const Materials& base);

// The same as a file: what read_materials() reads.
[[nodiscard]] std::string materials_toml(std::span<const Material> materials);

}  // namespace burr::importing
