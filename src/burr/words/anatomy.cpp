#include "burr/words/anatomy.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "burr/base/printable.h"
#include "burr/words/words.h"

namespace burr::words {
namespace {

constexpr std::size_t kLongest = 40;  // name [letter]

struct Known {
  std::string_view name;
  Word word;
};

constexpr Known kKnown[] = {
    {"cortical bone", Word::at_cortical_bone},
    {"mastoid bone", Word::at_mastoid_bone},
    {"mastoid cells", Word::at_mastoid_bone},
    {"bony meatus wall", Word::at_canal_wall},
    {"canal wall", Word::at_canal_wall},
    {"bony dura plate (tegmen)", Word::at_dura_plate},
    {"dura plate", Word::at_dura_plate},
    {"bony sinus plate", Word::at_sinus_plate},
    {"sinus plate", Word::at_sinus_plate},
    {"labyrinth (otic capsule)", Word::at_labyrinth},
    {"labyrinth", Word::at_labyrinth},
    {"facial canal bone", Word::at_facial_canal},
    {"malleus", Word::at_malleus},
    {"incus", Word::at_incus},
    {"stapes", Word::at_stapes},
    {"facial nerve", Word::at_facial_nerve},
    {"chorda tympani", Word::at_chorda},
    {"sigmoid sinus", Word::at_sigmoid_sinus},
    {"dura", Word::at_dura},
    {"semicircular canals", Word::at_semicircular},
    {"cochlea (soft tissue)", Word::at_cochlea},
    {"eardrum (membrane)", Word::at_eardrum},
    {"internal carotid artery", Word::at_carotid},
    {"internal meatus nerves", Word::at_meatus_nerves},
    {"ear canal", Word::at_ear_canal},
    {"middle ear", Word::at_middle_ear},
    {"antrum air", Word::at_antrum},
    {"antrum", Word::at_antrum},
    {"mastoid air cells", Word::at_air_cells},
    {"trabecular bone", Word::at_trabecular},
    {"enamel", Word::at_enamel},
    {"dentine", Word::at_dentine},
    {"pulp", Word::at_pulp},
    {"inferior alveolar nerve", Word::at_alveolar_nerve},
    {"nerve canal bone", Word::at_nerve_canal},
    {"marrow (soft tissue)", Word::at_marrow},
    {"nerve sheath", Word::at_nerve_sheath},
    {"floor of the mouth (soft tissue)", Word::at_mouth_floor},
    {"vault", Word::at_vault},
    {"diploe", Word::at_diploe},
    {"teeth", Word::at_teeth},
    {"face and base", Word::at_face_base},
    {"dural sac", Word::at_dural_sac},
    {"nerve roots", Word::at_nerve_roots},
    {"caries", Word::at_caries},
    {"soft caries", Word::at_caries_soft},
    {"leathery caries", Word::at_caries_leathery},
    {"firm caries", Word::at_caries_firm},
    {"bone", Word::at_bone},
    {"cortical bone or dentine", Word::at_cortical_dentine},
    {"enamel or metal", Word::at_enamel_metal},
};

using Titles = std::map<std::string, scenario::Texts, std::less<>>;

// Of the case: of its structures, of the tissues that belong to them, of landmarks and regions.
struct OfCase {
  Titles structures, tissues, places;
};
OfCase& of_case() {
  static OfCase all;
  return all;
}

std::optional<std::string> title_in(const Titles& titles, std::string_view name) {
  const auto found = titles.find(name);
  if (found == titles.end()) return std::nullopt;
  return base::printable(found->second.in(spoken().code), kLongest);
}

}  // namespace

void take_titles_of(const scenario::CaseLesson* lesson) {
  of_case() = {};
  if (lesson == nullptr) return;
  for (const scenario::Structure& one : lesson->structures) {
    if (one.title.empty()) continue;
    of_case().structures.emplace(one.name, one.title);
    for (const std::string& tissue : one.names) of_case().tissues.emplace(tissue, one.title);
  }
  for (const scenario::CaseRegion& one : lesson->regions)
    if (!one.title.empty()) of_case().places.emplace(one.name, one.title);
  for (const scenario::Landmark& one : lesson->landmarks)
    if (!one.title.empty()) of_case().places.emplace(one.name, one.title);
}

std::string anatomy(std::string_view name) {
  if (auto title = title_in(of_case().structures, name)) return *std::move(title);
  const auto* found = std::find_if(std::begin(kKnown), std::end(kKnown),
                                   [&](const Known& one) { return one.name == name; });
  if (found != std::end(kKnown)) return word(found->word);
  // several tissues may belong to one structure: their own names tell more, where burr knows them
  if (auto title = title_in(of_case().tissues, name)) return *std::move(title);
  return base::printable(name, kLongest);
}

std::string place_name(std::string_view name) {
  if (auto title = title_in(of_case().places, name)) return *std::move(title);
  return anatomy(name);
}

std::string anatomy_list(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + place_name(name);
  return list;
}

}  // namespace burr::words
