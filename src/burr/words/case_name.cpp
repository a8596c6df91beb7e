#include "burr/words/case_name.h"

#include <string_view>
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

std::string name_of_work(const std::string& what) {
  constexpr std::string_view kScan = " scan";
  if (what == "recording") return word(Word::start_recording);
  if (what.size() > kScan.size() && what.ends_with(kScan))
    return say(Word::work_scan, what.substr(0, what.size() - kScan.size()));
  const std::string base = what.substr(0, what.find('?')), named = name_of_case(base);
  return named == base ? what : named;
}

}  // namespace burr::words
