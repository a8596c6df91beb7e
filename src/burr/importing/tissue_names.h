// importing/tissue_names.h - what the name of a label says: bone, soft tissue or air. One table of
// words in English, Latin, German, Swedish, French and Spanish, and of SNOMED-CT codes
// (tissue_names.cpp). Internal to importing.
//
// Case, accents, ae/oe/ue for umlauts, _ - . and sides (left, rechts, sinister ...) do not matter.
// Thread: any.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "burr/volume/tissue.h"

namespace burr::importing {

struct NamedTissue {
  bool known = false;  // false: no word of the name is in the table; the rest is the default
  volume::TissueKind kind = volume::TissueKind::solid;
  bool spare = false;
  double bleeds = 0;  // volume::Tissue::bleeds
};

[[nodiscard]] NamedTissue tissue_named(std::string_view name);

// The words of a name in plain lower-case ASCII, as tissue_named() compares them: "Kieferhöhle_li"
// gives "kieferhohle", "li".
[[nodiscard]] std::vector<std::string> plain_words(std::string_view name);

}  // namespace burr::importing
