#include "burr/importing/materials.h"

#include <fmt/format.h>

#include <safe_toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "burr/base/check.h"
#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/base/toml_text.h"
#include "burr/importing/materials_text.h"
#include "burr/io/read/text.h"

namespace burr::importing {
namespace {

constexpr const char* kCortical = "cortical bone";
constexpr std::size_t kLargestFile = std::size_t{1} << 20;  // a table is about a page of text
                                                            // [byte]
constexpr std::size_t kMostMaterials = 255;

constexpr std::array<MaterialField, 11> kFields = {{
    {"cutting_energy_J_mm3", "J/mm^3", 1e9, 1e3, &Material::cutting_energy},
    {"friction", "-", 1, 2, &Material::friction},
    {"cutting_friction", "-", 1, 2, &Material::cutting_friction},
    {"chip_tangential_N_mm2", "N/mm^2", 1e6, 1e5, &Material::chip_tangential},
    {"chip_radial_N_mm2", "N/mm^2", 1e6, 1e5, &Material::chip_radial},
    {"edge_tangential_N_mm", "N/mm", 1e3, 1e4, &Material::edge_tangential},
    {"edge_radial_N_mm", "N/mm", 1e3, 1e4, &Material::edge_radial},
    {"edge_onset_um", "um", 1e-6, 1e3, &Material::edge_onset},
    {"conductivity_W_mK", "W/(m K)", 1, 1e3, &Material::conductivity},
    {"density_kg_m3", "kg/m^3", 1, 3e4, &Material::density},
    {"specific_heat_J_kgK", "J/(kg K)", 1, 1e4, &Material::specific_heat},
}};

// Names are compared without case; _ - + . / , count as a space.
std::string plain(std::string_view name) {
  std::string out = io::lower(name);
  for (char& c : out)
    if (c == '_' || c == '-' || c == '+' || c == '.' || c == '/' || c == ',') c = ' ';
  return out;
}

bool any_of(const std::string& name, std::initializer_list<const char*> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const char* part) { return name.find(part) != std::string::npos; });
}

// The material that a name of hard tissue contains; the rarer word first ("carious dentine",
// "enamel of dentine").
const char* material_named_in(const std::string& plain_name) {
  if (any_of(plain_name, {"caries", "carious", "decay"})) return "caries";
  if (any_of(plain_name, {"enamel"})) return "enamel";
  if (any_of(plain_name, {"dentin", "cementum"})) return "dentine";
  if (any_of(plain_name, {"trabecular", "spongiosa", "cancellous"})) return "trabecular bone";
  if (any_of(plain_name, {"cement", "pmma"})) return "cement";
  if (any_of(plain_name, {"polyurethane", "foam"})) return "polyurethane foam";
  return kCortical;
}

// Reads one file. The first error is kept; nothing after it counts.
class Reader {
 public:
  // fills_gaps: values that a new material lacks are taken from another one
  Reader(std::string_view file, bool fills_gaps) : file_(file), fills_gaps_(fills_gaps) {}

  void fail(const std::string& what) {
    if (!wrong_) wrong_ = error(fmt::format("{}: {}", file_, what));
  }
  [[nodiscard]] const std::optional<Error>& wrong() const { return wrong_; }

  void constant(const toml::node& node, const std::string& where, const MaterialField& field,
                std::optional<Constant>& out) {
    const toml::table* table = node.as_table();
    if (table == nullptr)
      return fail(where +
                  ": write { value = .., low = .., high = .., source = \"..\", calibrated = .. }");
    for (const auto& [key, value] : *table)
      if (key.str() != "value" && key.str() != "low" && key.str() != "high" &&
          key.str() != "source" && key.str() != "calibrated")
        return fail(
            fmt::format("{}: {} is not a known field; use value, low, high, source, calibrated",
                        where, base::printable(key.str())));
    Constant read;
    number(*table, where, "value", read.value);
    number(*table, where, "low", read.low);
    number(*table, where, "high", read.high);
    const toml::node* source = table->get("source");
    const auto text = source != nullptr ? source->value_exact<std::string>() : std::nullopt;
    if (!text || text->empty())
      fail(where +
           ": source is missing; write in quotes where the number comes from, or \"assumed\"");
    const toml::node* calibrated = table->get("calibrated");
    const auto yes = calibrated != nullptr ? calibrated->value_exact<bool>() : std::nullopt;
    if (!yes)
      fail(where + ": calibrated must be true or false; write false until it has been measured");
    if (!wrong_ && !(read.value > 0 && read.value <= field.most))
      fail(fmt::format("{}: value {:g} must be above 0 and at most {:g} {}", where, read.value,
                       field.most, field.unit));
    if (!wrong_ && !(read.low >= 0 && read.low <= read.value))
      fail(fmt::format("{}: low {:g} must be from 0 to the value {:g}", where, read.low,
                       read.value));
    if (!wrong_ && !(read.high >= read.value && read.high <= 1e3 * field.most))
      fail(fmt::format("{}: high {:g} must be from the value {:g} to {:g}", where, read.high,
                       read.value, 1e3 * field.most));
    if (wrong_) return;
    read.value *= field.si;
    read.low *= field.si;
    read.high *= field.si;
    read.source = *text;
    read.calibrated = *yes;
    out = std::move(read);
  }

  void material(const toml::table& table, std::size_t number, const Materials& before,
                Material& out) {
    for (const auto& [key, node] : table) {
      if (key.str() == "name" || key.str() == "like") continue;
      const auto field =
          std::find_if(kFields.begin(), kFields.end(),
                       [name = key.str()](const auto& one) { return name == one.key; });
      if (field == kFields.end())
        return fail(fmt::format("material {}: {} is not a known field; use {}", number,
                                base::printable(key.str()), keys()));
      constant(
          node,
          fmt::format("material \"{}\": {}", base::printable(out.name), std::string(key.str())),
          *field, out.*(field->place));
    }
    const toml::node* like = table.get("like");
    if (like == nullptr) return;
    const auto whom = like->value_exact<std::string>();
    if (!whom || before.find(*whom) == nullptr)
      fail(fmt::format("material \"{}\": like: must name a material defined above this one",
                       base::printable(out.name)));
  }

  // Applies the file to `out`.
  void all(const toml::table& table, Materials& out) {
    for (const auto& [key, node] : table)
      if (key.str() != "material")
        return fail(fmt::format("{} is not a known field; only [[material]] is allowed",
                                base::printable(key.str())));
    const toml::array* list = table["material"].as_array();
    if (list == nullptr) return fail("there is no [[material]]; see docs/use/materials.md");
    std::vector<std::string> named;
    for (const toml::node& node : *list) {
      const toml::table* entry = node.as_table();
      const std::size_t number = named.size() + 1;
      if (entry == nullptr) return fail("material: must be a list of tables, [[material]]");
      const toml::node* name_node = entry->get("name");
      const auto name = name_node != nullptr ? name_node->value_exact<std::string>() : std::nullopt;
      if (!name || io::trimmed(*name).empty() || name->size() > 100)
        return fail(fmt::format(
            "material {}: name is missing; give name = \"..\" of at most 100 letters", number));
      if (std::find(named.begin(), named.end(), plain(*name)) != named.end())
        return fail(fmt::format("material \"{}\" appears twice; keep one", base::printable(*name)));
      named.push_back(plain(*name));
      const toml::node* like = entry->get("like");
      const auto found = std::find_if(out.all.begin(), out.all.end(), [&](const Material& have) {
        return plain(have.name) == named.back();
      });
      if (found != out.all.end()) {
        if (like != nullptr)
          return fail(
              fmt::format("material \"{}\": like is only for new materials, and this one is built "
                          "in; remove like",
                          base::printable(*name)));
        material(*entry, number, out, *found);
      } else {
        const auto whom = like != nullptr ? like->value_exact<std::string>() : std::nullopt;
        const Material* pattern = fills_gaps_ ? out.find(whom.value_or(kCortical)) : nullptr;
        Material fresh = pattern != nullptr ? *pattern : Material{};
        fresh.name = *name;
        material(*entry, number, out, fresh);
        if (out.all.size() >= kMostMaterials)
          return fail(
              fmt::format("there are more than {} materials; remove those that you do not use",
                          kMostMaterials));
        out.all.push_back(std::move(fresh));
      }
      if (wrong_) return;
    }
  }

 private:
  static std::string keys() {
    std::string list = "name, like";
    for (const MaterialField& field : kFields) list += std::string(", ") + field.key;
    return list;
  }

  void number(const toml::table& table, const std::string& where, const char* key, double& out) {
    const toml::node* node = table.get(key);
    if (node == nullptr)
      return fail(fmt::format("{}: {} is missing; give value, low and high", where, key));
    const auto value = node->is_number() ? node->value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value))
      return fail(fmt::format("{}: {} must be a number", where, key));
    out = *value;
  }

  std::string file_;
  bool fills_gaps_;
  std::optional<Error> wrong_;
};

// Names and sources are shown in one line.
std::string in_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
  return text;
}

// A TOML float: "1" would be an integer. Both are read, but a float shows that it is a measure.
std::string number_text(double value) {
  std::string text = fmt::format("{:.9g}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

std::span<const MaterialField> material_fields() { return kFields; }

const Material* Materials::find(std::string_view name) const {
  const std::string wanted = plain(name);
  for (const Material& material : all)
    if (plain(material.name) == wanted) return &material;
  return nullptr;
}

const Material& Materials::of(std::string_view tissue_name, volume::TissueKind kind) const {
  if (const Material* same = find(tissue_name)) return *same;
  if (kind == volume::TissueKind::soft)
    if (const Material* soft = find("soft tissue")) return *soft;
  const Material* hard = find(material_named_in(plain(tissue_name)));
  if (hard == nullptr) hard = find(kCortical);
  BURR_CHECK(hard != nullptr);
  return *hard;
}

void Materials::apply_material(volume::Tissue& tissue) const {
  importing::apply_material(of(tissue.name, tissue.kind), tissue);
}

void apply_material(const Material& material, volume::Tissue& tissue) {
  const auto take = [](const std::optional<Constant>& from, double& to) {
    if (from) to = from->value;
  };
  take(material.cutting_energy, tissue.cutting_energy);
  take(material.friction, tissue.friction);
  take(material.cutting_friction, tissue.cutting_friction);
  take(material.chip_tangential, tissue.force.chip_tangential);
  take(material.chip_radial, tissue.force.chip_radial);
  take(material.edge_tangential, tissue.force.edge_tangential);
  take(material.edge_radial, tissue.force.edge_radial);
  take(material.edge_onset, tissue.force.edge_onset);
}

const Materials& built_in_materials() {
  static const Materials all = [] {
    auto read = parse_materials(built_in_materials_text(), "materials.toml", {});
    BURR_CHECK(read.ok());
    return std::move(*read);
  }();
  return all;
}

Result<Materials> read_materials(const std::string& path) {
  const auto text = base::text_of_file(path, kLargestFile,
                                       "a table of materials; check that this is the right file");
  if (!text) return text.error();
  return parse_materials(*text, io::short_name(path), built_in_materials());
}

Result<Materials> parse_materials(std::string_view text, std::string_view file,
                                  const Materials& base) {
  const auto table = parse_toml(text, file);
  if (!table) return table.error();
  Materials out = base;
  Reader reader(file, !base.all.empty());  // the built-in table is complete as it is
  reader.all(*table, out);
  if (reader.wrong()) return *reader.wrong();
  return out;
}

std::string materials_toml(std::span<const Material> materials) {
  std::string out;
  for (const Material& material : materials) {
    out += fmt::format("{}[[material]]\nname = {}\n", out.empty() ? "" : "\n",
                       base::toml_text(in_one_line(material.name)));
    for (const MaterialField& field : kFields) {
      const std::optional<Constant>& constant = material.*(field.place);
      if (!constant) continue;
      out +=
          fmt::format("{} = {{ value = {}, low = {}, high = {}, source = {}, calibrated = {} }}\n",
                      field.key, number_text(constant->value / field.si),
                      number_text(constant->low / field.si), number_text(constant->high / field.si),
                      base::toml_text(in_one_line(constant->source)), constant->calibrated);
    }
  }
  return out;
}

}  // namespace burr::importing
