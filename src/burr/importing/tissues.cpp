#include "burr/importing/tissues.h"

#include <fmt/core.h>

#include <safe_toml.h>
#include <algorithm>
#include <cmath>

#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/io/read/text.h"

namespace burr::importing {
namespace {

using volume::Tissue;
using volume::TissueKind;

// The table's values for trabecular bone belong to the middle of its class.
constexpr double kTrabecularHu = 450;

// A guess, for the picture only: it oozes where a vessel runs.
constexpr double kTrabecularBleeds = 0.15;

// Apparent density of trabecular bone (Rho et al. 1995), within the range of such bone. [kg/m^3]
double density_of(double hu) { return std::clamp(131 + 1.067 * hu, 100.0, 2000.0); }

bool any_of(const std::string& name, std::initializer_list<const char*> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const char* part) { return name.find(part) != std::string::npos; });
}

bool word_of(const std::string& name, const char* word) {
  for (const std::string& w : io::words(name))
    if (w == word) return true;
  return false;
}

std::string plain(const std::string& name) {
  std::string out = io::lower(name);
  for (char& c : out)
    if (c == '_' || c == '-' || c == '+' || c == '.' || c == '/' || c == ',') c = ' ';
  return out;
}

std::string names_of(const Materials& materials) {
  std::string list;
  for (const Material& one : materials.all)
    list += (list.empty() ? "" : ", ") + base::printable(one.name);
  return list;
}

Status read_table(const std::string& path, const Materials& materials,
                  std::vector<Tissue>& of_value, std::array<bool, 256>& known) {
  const std::string file = io::short_name(path);
  const auto text = base::text_of_file(path, std::uintmax_t{1} << 20,
                                       "a table of labels; check that this is the right file");
  if (!text) return text.error();
  const auto read = parse_toml(*text, file);
  if (!read) return read.error();
  const auto* list = (*read)["label"].as_array();
  if (list == nullptr)
    return error(fmt::format("{}: there is no [[label]]; see docs/labels.md", file));
  for (const auto& node : *list) {
    const auto* entry = node.as_table();
    if (entry == nullptr)
      return error(fmt::format("{}: label: must be a list of tables, [[label]]", file));
    const auto value = (*entry)["value"].value<std::int64_t>();
    const auto name = (*entry)["name"].value<std::string>();
    std::vector<std::size_t> hits;
    if (value) {
      if (*value < 1 || *value > 255)
        return error(
            fmt::format("{}: label: value {} is out of range; use 1 to 255", file, *value));
      hits.push_back(static_cast<std::size_t>(*value));
    } else if (name) {
      for (std::size_t v = 1; v < 256; ++v)
        if (known[v] && plain(of_value[v].name) == plain(*name)) hits.push_back(v);
    } else {
      return error(fmt::format("{}: label: value or name is missing; give one of them", file));
    }
    for (const std::size_t v : hits) {
      Tissue& tissue = of_value[v];
      known[v] = true;
      if (name) tissue.name = *name;
      if (const auto kind = (*entry)["kind"].value<std::string>()) {
        if (*kind == "solid")
          tissue.kind = TissueKind::solid;
        else if (*kind == "soft")
          tissue.kind = TissueKind::soft;
        else if (*kind == "air")
          tissue.kind = TissueKind::air;
        else
          return error(fmt::format("{}: label {}: kind \"{}\" is not known; use solid, soft or air",
                                   file, v, base::printable(*kind)));
      }
      if (const auto wanted = (*entry)["material"].value<std::string>()) {
        const Material* material = materials.find(*wanted);
        if (material == nullptr)
          return error(fmt::format("{}: label {}: material \"{}\" is not known; use one of {}",
                                   file, v, base::printable(*wanted), names_of(materials)));
        apply_material(*material, tissue);
      }
      if (const auto energy = (*entry)["cutting_energy_J_mm3"].value<double>()) {
        if (!(*energy > 0 && *energy < 1e3))
          return error(fmt::format(
              "{}: label {}: cutting_energy_J_mm3 must be above 0 and below 1000", file, v));
        tissue.cutting_energy = *energy * 1e9;
      }
      if (const auto friction = (*entry)["friction"].value<double>()) {
        if (!(*friction >= 0 && *friction <= 2))
          return error(fmt::format("{}: label {}: friction must be from 0 to 2", file, v));
        tissue.friction = *friction;
      }
      if (const auto spare = (*entry)["spare"].value<bool>()) tissue.spare = *spare;
      if (const auto bleeds = (*entry)["bleeds"].value<double>()) {
        if (!(*bleeds >= 0 && *bleeds <= 1))
          return error(fmt::format(
              "{}: label {}: bleeds must be from 0 (not at all) to 1 (as a vessel)", file, v));
        tissue.bleeds = *bleeds;
      }
      if (const auto* colour = (*entry)["colour"].as_array()) {
        if (colour->size() != 3)
          return error(
              fmt::format("{}: label {}: colour must be three numbers from 0 to 1", file, v));
        for (std::size_t c = 0; c < 3; ++c) {
          const double part = (*colour)[c].value_or(0.8);
          if (!std::isfinite(part))
            return error(
                fmt::format("{}: label {}: colour must be three numbers from 0 to 1", file, v));
          tissue.colour[c] = static_cast<float>(std::clamp(part, 0.0, 1.0));
        }
      }
    }
  }
  return fine();
}

}  // namespace

Tissue tissue_by_name(const io::Label& label, bool named, const Materials& materials) {
  Tissue tissue;
  tissue.name = named ? label.name : fmt::format("label {}", label.value);
  tissue.colour = label.colour;
  tissue.label = label.value;
  if (!named) {
    apply_material(materials.of(""), tissue);
    return tissue;
  }
  const std::string name = plain(label.name);

  // empty spaces
  if (any_of(name, {"ear canal", "auditory canal ext", "external auditory", "air cell", "airway",
                    "trachea", "middle ear", "tympanic cavity", "background", "maxillary sinus",
                    "frontal sinus", "ethmoid", "sphenoid sinus"}) ||
      word_of(name, "eac") || word_of(name, "air") || name == "tympanum") {
    tissue.kind = TissueKind::air;
    return tissue;
  }
  // a name with a word for hard tissue is hard, whatever else it names
  const bool hard = any_of(
      name, {"bone",     "bony",     "ossicle",    "malleus",   "incus",   "stapes",   "tooth",
             "teeth",    "enamel",   "dentin",     "cement",    "skull",   "mandible", "maxilla",
             "vertebra", "cortical", "trabecular", "spongiosa", "implant", "screw",    "crown"});
  const auto is_soft = [](const std::string& text) {
    return any_of(text,
                  {"canal",   "nerve", "vein",     "artery",  "arteries",  "vessel", "carotid",
                   "jugular", "sinus", "dura",     "chorda",  "skin",      "muscle", "fat",
                   "brain",   "pulp",  "ligament", "tendon",  "cartilage", "disc",   "membrane",
                   "mucosa",  "gum",   "gingiva",  "soft",    "tissue",    "joint",  "bulb",
                   "cord",    "eye",   "tongue",   "aqueduct"}) ||
           word_of(text, "iac") || word_of(text, "tmj") || word_of(text, "ica");
  };
  // "vertebral artery": the last word names the thing itself
  const std::vector<std::string> parts = io::words(name);
  const bool soft = is_soft(name) && (!hard || (!parts.empty() && is_soft(parts.back())));
  tissue.spare = any_of(name, {"nerve", "artery", "vein", "carotid", "jugular", "sinus", "dura",
                               "chorda", "labyrinth", "cochlea", "vestib", "ossicle", "malleus",
                               "incus", "stapes", "cord", "brain", "aqueduct"}) ||
                 word_of(name, "iac") || word_of(name, "ica");
  if (soft) tissue.kind = TissueKind::soft;
  if (soft && (any_of(name, {"artery", "arteries", "vein", "vessel", "carotid", "jugular", "sinus",
                             "bulb"}) ||
               word_of(name, "ica")))
    tissue.bleeds = 1;
  else if (any_of(name, {"marrow", "pulp"}))
    tissue.bleeds = 0.3;
  else if (!soft && any_of(name, {"trabecular", "spongiosa", "cancellous"}))
    tissue.bleeds = kTrabecularBleeds;
  materials.apply_material(tissue);
  return tissue;
}

Result<LabelTissues> label_tissues(const io::Scan& scan, const std::array<bool, 256>& present,
                                   const std::string& table_path, const Materials& materials) {
  std::vector<Tissue> of_value(256);
  std::array<bool, 256> known{};
  int different = 0, unnamed = 0;
  for (std::size_t v = 1; v < 256; ++v) different += present[v] ? 1 : 0;
  for (std::size_t v = 1; v < 256; ++v) {
    if (!present[v]) continue;
    known[v] = true;
    io::Label label;
    label.value = static_cast<int>(v);
    label.colour = Tissue{}.colour;
    bool named = false;
    for (const io::Label& have : scan.label_names)
      if (have.value == label.value) {
        label = have;
        named = !have.name.empty();
      }
    std::int64_t number = 0;
    named = named && !io::to_number(label.name, number);  // "1" is not a name
    if (!named) ++unnamed;
    of_value[v] = tissue_by_name(label, named, materials);
    if (!named && different == 1) of_value[v].name = "bone";
  }
  LabelTissues out;
  out.table.tissues.resize(1);
  if (!table_path.empty()) {
    if (Status status = read_table(table_path, materials, of_value, known); !status)
      return status.error();
  } else if (unnamed > 0 && different > 1) {
    out.notices.push_back(
        fmt::format("{} of {} labels have no name and are treated as solid; use --tissues to mark "
                    "those that are not.",
                    unnamed, different));
  }
  for (std::size_t v = 1; v < 256; ++v) {
    if (!present[v] || of_value[v].kind == TissueKind::air) continue;
    of_value[v].label = static_cast<int>(v);
    if (out.table.tissues.size() > 255)
      return error(
          "there are more than 255 labels, and burr reads at most 255; merge some of them");
    out.of_label[v] = static_cast<volume::TissueId>(out.table.tissues.size());
    out.table.tissues.push_back(of_value[v]);
  }
  for (std::size_t v = 1; v < 256; ++v)
    if (present[v] && of_value[v].kind == TissueKind::air) {
      of_value[v].label = static_cast<int>(v);
      out.air.push_back(of_value[v]);
      out.notices.push_back(
          fmt::format("Label {} ({}) is air.", v, base::printable(of_value[v].name)));
    }
  return out;
}

volume::TissueTable hu_tissues(const Materials& materials) {
  volume::TissueTable table;
  table.tissues.resize(1);
  const auto add = [&table](Tissue tissue) {
    tissue.label = static_cast<int>(table.tissues.size());
    table.tissues.push_back(std::move(tissue));
  };
  for (int n = 0; n < kTrabecularClasses; ++n) {
    const double from = kTrabecularFromHu + n * kTrabecularStepHu, to = from + kTrabecularStepHu;
    Tissue tissue;
    tissue.name = fmt::format("trabecular bone {:.0f}-{:.0f} HU", from, to);
    tissue.colour = {0.86F, 0.76F, 0.62F};
    apply_material(materials.of("trabecular bone"), tissue);
    tissue.bleeds = kTrabecularBleeds;
    // strength, and so the energy of cutting, goes with the square of density (Carter & Hayes 1977)
    const double share = density_of(0.5 * (from + to)) / density_of(kTrabecularHu);
    const double harder = share * share;
    tissue.cutting_energy *= harder;
    tissue.force.chip_tangential *= harder;
    tissue.force.chip_radial *= harder;
    tissue.force.edge_tangential *= harder;
    tissue.force.edge_radial *= harder;
    add(std::move(tissue));
  }
  Tissue cortical{.name = "cortical bone or dentine"};
  apply_material(materials.of("cortical bone"), cortical);
  add(std::move(cortical));
  Tissue enamel{.name = "enamel or metal", .colour = {0.96F, 0.96F, 0.93F}};
  apply_material(materials.of("enamel"), enamel);
  add(std::move(enamel));
  return table;
}

}  // namespace burr::importing
