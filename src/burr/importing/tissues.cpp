#include "burr/importing/tissues.h"

#include <fmt/core.h>

#include <safe_toml.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/importing/tissue_names.h"
#include "burr/io/read/label_lists.h"
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

// The number 1..255 of a label that the table gives by its value in the file; 0: out of range.
std::size_t number_of(std::int64_t value, const std::vector<io::Label>& names) {
  for (const io::Label& label : names)
    if (label.in_file != 0 && label.in_file == value) return static_cast<std::size_t>(label.value);
  return value >= 1 && value <= 255 ? static_cast<std::size_t>(value) : 0;
}

Status read_table(const std::string& text, const std::string& file,
                  const std::vector<io::Label>& names, const Materials& materials,
                  std::vector<Tissue>& of_value, std::array<bool, 256>& known,
                  std::array<bool, 256>& stated) {
  const auto read = parse_toml(text, file);
  if (!read) return read.error();
  const auto* list = (*read)["label"].as_array();
  if (list == nullptr)
    return error(fmt::format("{}: there is no [[label]]; see docs/use/labels.md", file));
  for (const auto& node : *list) {
    const auto* entry = node.as_table();
    if (entry == nullptr)
      return error(fmt::format("{}: label: must be a list of tables, [[label]]", file));
    const auto value = (*entry)["value"].value<std::int64_t>();
    const auto name = (*entry)["name"].value<std::string>();
    std::vector<std::size_t> hits;
    if (value) {
      const std::size_t number = number_of(*value, names);
      if (number == 0)
        return error(
            fmt::format("{}: label: value {} is out of range; use 1 to 255", file, *value));
      hits.push_back(number);
    } else if (name) {
      for (std::size_t v = 1; v < 256; ++v)
        if (known[v] && plain(of_value[v].name) == plain(*name)) hits.push_back(v);
    } else {
      return error(fmt::format("{}: label: value or name is missing; give one of them", file));
    }
    for (const std::size_t v : hits) {
      Tissue& tissue = of_value[v];
      known[v] = true;
      stated[v] = stated[v] || entry->contains("kind") || entry->contains("material");
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

// Whether the label's name, or else its code, says what it is. Adds a notice where the two differ.
bool understand(const io::Label& label, std::vector<std::string>& notices) {
  const NamedTissue name = tissue_named(label.name), code = tissue_named(label.meaning);
  if (name.known && code.known && name.kind != code.kind)
    notices.push_back(
        fmt::format("Label {} is named {}, but its code says {}: burr goes by the name; use "
                    "`labels` if that is wrong.",
                    label.value, base::printable(label.name), base::printable(label.meaning)));
  return name.known || code.known;
}

// The label of that colour, of 8 bit each; 0: there is none.
std::size_t number_of_colour(const std::array<float, 3>& colour,
                             const std::vector<io::Label>& names) {
  constexpr float kSame = 0.5F / 255;
  for (const io::Label& have : names) {
    bool same = true;
    for (std::size_t c = 0; c < 3; ++c) same = same && std::abs(have.colour[c] - colour[c]) < kSame;
    if (same) return static_cast<std::size_t>(have.value);
  }
  return 0;
}

// Names and colours from a list of ITK-SNAP or FreeSurfer; they come before those of the scan.
// by_colour: the scan's own numbers mean nothing, only its colours do.
Status take_list(const std::vector<io::Label>& list, const std::string& file, bool by_colour,
                 const std::array<bool, 256>& present, std::vector<io::Label>& names) {
  bool any = false;
  const std::vector<io::Label> own = names;
  for (const io::Label& one : list) {
    const std::size_t number =
        by_colour ? number_of_colour(one.colour, own) : number_of(one.value, names);
    if (number == 0 || !present[number]) continue;
    any = true;
    io::Label label = one;
    label.value = static_cast<int>(number);
    for (const io::Label& have : names)
      if (have.value == label.value) label.in_file = have.in_file;
    std::erase_if(names, [&](const io::Label& have) { return have.value == label.value; });
    names.push_back(std::move(label));
  }
  if (any) return fine();
  return error(fmt::format("{}: none of its {} occurs in the scan; check that it belongs to it",
                           file, by_colour ? "colours" : "labels"));
}

std::string not_understood(const std::vector<std::string>& labels) {
  constexpr std::size_t kShown = 6;
  std::string list;
  for (std::size_t n = 0; n < std::min(labels.size(), kShown); ++n)
    list += (n == 0 ? "" : ", ") + labels[n];
  if (labels.size() > kShown) list += fmt::format(" and {} more", labels.size() - kShown);
  return fmt::format(
      "burr does not understand the {} {} and treats {} as solid bone; use `labels` to mark what "
      "is soft, air or to be spared.",
      labels.size() == 1 ? "name of label" : "names of labels", list,
      labels.size() == 1 ? "it" : "them");
}

}  // namespace

Tissue tissue_by_name(const io::Label& label, bool named, const Materials& materials) {
  Tissue tissue;
  tissue.name = named ? label.name
                      : fmt::format("label {}", label.in_file != 0 ? label.in_file : label.value);
  tissue.colour = label.colour;
  tissue.label = label.value;
  if (!named) {
    apply_material(materials.of(""), tissue);
    return tissue;
  }
  NamedTissue says = tissue_named(label.name);
  if (!says.known) says = tissue_named(label.meaning);
  tissue.kind = says.kind;
  if (tissue.kind == TissueKind::air) return tissue;
  tissue.spare = says.spare;
  tissue.bleeds = says.bleeds;
  materials.apply_material(tissue);
  return tissue;
}

Result<LabelTissues> label_tissues(const io::Scan& scan, const std::array<bool, 256>& present,
                                   const std::string& table_path, const Materials& materials) {
  std::vector<Tissue> of_value(256);
  std::array<bool, 256> known{};
  std::array<bool, 256> stated{};      // the table states its kind or its material
  std::array<bool, 256> understood{};  // by its name
  LabelTissues out;
  std::vector<io::Label> names = scan.label_names;
  const std::string file = io::short_name(table_path);
  std::string table;  // in TOML; empty: there is none, or it was a list of another program
  if (std::error_code trouble; std::filesystem::is_directory(table_path, trouble))
    return error(Trouble::usage,
                 fmt::format("`labels`: {} is a folder and no table of labels; to use the masks in "
                             "it, give that folder in place of the scan",
                             file));
  if (!table_path.empty()) {
    auto text = base::text_of_file(table_path, std::uintmax_t{1} << 20,
                                   "a table of labels; check that this is the right file");
    if (!text) return text.error();
    const auto list = io::labels_in_lut(*text);
    if (list.empty()) table = std::move(*text);
    if (!list.empty())
      if (Status status = take_list(list, file, scan.format == io::kAdfFormat, present, names);
          !status)
        return status.error();
  }
  int different = 0, unnamed = 0;
  for (std::size_t v = 1; v < 256; ++v) different += present[v] ? 1 : 0;
  for (std::size_t v = 1; v < 256; ++v) {
    if (!present[v]) continue;
    known[v] = true;
    io::Label label;
    label.value = static_cast<int>(v);
    label.colour = Tissue{}.colour;
    bool named = false;
    for (const io::Label& have : names)
      if (have.value == label.value) {
        label = have;
        named = !have.name.empty();
      }
    std::int64_t number = 0;
    named = named && !io::to_number(label.name, number);  // "1" is not a name
    if (!named && !label.meaning.empty()) {
      label.name = label.meaning;
      named = true;
    }
    if (!named) ++unnamed;
    of_value[v] = tissue_by_name(label, named, materials);
    if (!named && different == 1) of_value[v].name = "bone";
    understood[v] = !named || understand(label, out.notices);
    out.assumed[v] = named ? !understood[v] : different > 1;
  }
  out.table.tissues.resize(1);
  if (!table.empty()) {
    if (Status status = read_table(table, file, names, materials, of_value, known, stated); !status)
      return status.error();
  } else if (unnamed > 0 && different > 1) {
    out.notices.push_back(
        fmt::format("{} of {} labels have no name and are treated as solid; use `labels` to mark "
                    "those that are not.",
                    unnamed, different));
  }
  std::vector<std::string> doubts;
  for (std::size_t v = 1; v < 256; ++v) out.assumed[v] = out.assumed[v] && !stated[v];
  for (std::size_t v = 1; v < 256; ++v)
    if (present[v] && !understood[v] && !stated[v])
      doubts.push_back(fmt::format("{} ({})", v, base::printable(of_value[v].name)));
  if (!doubts.empty()) out.notices.push_back(not_understood(doubts));
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
