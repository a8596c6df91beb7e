#include "burr/words/case_name.h"

#include <utility>

#include "burr/words/words.h"

namespace burr::words {

std::string name_of_case(const std::string& name) {
  const std::pair<const char*, Word> known[] = {{"temporal-bone", Word::case_temporal_bone},
                                                {"jaw", Word::case_jaw},
                                                {"spine", Word::case_spine},
                                                {"tooth", Word::case_tooth},
                                                {"block", Word::case_block}};
  for (const auto& [key, says] : known)
    if (name == key) return word(says);
  return name;
}

}  // namespace burr::words
