#include "burr/record/private_text.h"

#include <algorithm>

namespace burr::record {

bool looks_private(std::string_view text) {
  if (text.find('/') != std::string_view::npos || text.find('\\') != std::string_view::npos)
    return true;
  return std::count(text.begin(), text.end(), '.') >= 3 &&
         text.find_first_not_of("0123456789.") == std::string_view::npos;
}

bool fit_for_a_note(std::string_view text, std::size_t longest) {
  return text.size() <= longest && !looks_private(text) &&
         std::none_of(text.begin(), text.end(), [](char c) {
           return c == '@' || c == '\x7f' || static_cast<unsigned char>(c) < 0x20;
         });
}

}  // namespace burr::record
